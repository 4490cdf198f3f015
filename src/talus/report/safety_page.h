#pragma once
// What `talus safety` found, as one page: the answer, what acts, the mechanism, how far blocks move, the trials.

#include <filesystem>
#include <string>

namespace talus::report {

/// Whether a folder is one of `talus safety`, be it of a search that was broken off.
bool is_safety_folder(const std::filesystem::path& folder);

/// The page of such a folder, in HTML, with its pictures in it.
/// Throws FileError naming the file that cannot be read, or is none of a search that has ended.
std::string safety_page(const std::filesystem::path& folder);

}  // namespace talus::report
