#pragma once
// Where the files lie that come with the program: beside a build, and where an installation puts them.

#include <filesystem>
#include <string>

namespace talus::app {

/// The file `name` of share/talus; it may be missing.
std::filesystem::path data_file(const std::string& name);

}  // namespace talus::app
