#pragma once
// What a run has left in its folder, to be compared with what another has.

#include <filesystem>
#include <map>
#include <string>

#include "support/folder.h"

namespace talus::test {

/// Every file of results by its name; not the states, what other verbs made, and the manifest, which notes files
/// again that were written again. Of the summary what does not depend on the clock.
inline std::map<std::string, std::string> results_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (!entry.is_regular_file() || name.rfind("saved/", 0) == 0 || name.rfind("plots/", 0) == 0) continue;
    if (name == "talus_manifest.txt" || name == "report.html" || entry.path().extension() == ".part")
      continue;
    std::string text = content(entry.path());
    if (name == "summary.json")
      for (const char* key : {"\"wall_time", "\"cpu_time"})
        if (const size_t at = text.find(key); at != std::string::npos)
          text.erase(at, text.find('\n', at) - at);
    all[name] = text;
  }
  return all;
}

/// The state that was saved last, by its name in saved/; "" when there is none.
inline std::string newest_state(const std::filesystem::path& folder) {
  std::string newest;
  std::filesystem::file_time_type when;
  std::error_code ec;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "saved", ec)) {
    if (entry.path().extension() != ".h5") continue;
    const auto written = std::filesystem::last_write_time(entry.path());
    if (newest.empty() || written > when) newest = entry.path().filename().string(), when = written;
  }
  return newest;
}

}  // namespace talus::test
