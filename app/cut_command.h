#pragma once
// `talus cut`: blocks, statistics and picture of a model's regions.

#include <string>
#include <vector>

namespace talus::app {

int cut_command(const std::string& file, const std::vector<std::string>& overrides, const std::string& folder,
                bool force, bool open);

}  // namespace talus::app
