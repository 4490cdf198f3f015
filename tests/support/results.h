#pragma once
// What a run has left in its folder, to be compared with what another has.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include "support/folder.h"
#include "talus/output/csv.h"
#include "talus/output/read_vtk.h"
#include "talus/output/text_table.h"

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
    if (name == "summary.json")  // its own digest, of the clock among all else
      if (const size_t at = text.rfind("\n  \"digest\":"); at != std::string::npos) text.erase(at);
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

/// Whether what a killed run has left so far is the beginning of what the whole one has: its frames, and its
/// tables as far as readers take them. A kill may cut a row in two (a write can end between two pages of a
/// file): of such a row readers take nothing.
inline void check_begins_as(const std::filesystem::path& folder,
                            const std::map<std::string, std::string>& whole) {
  namespace fs = std::filesystem;
  for (const char* name : {"histories.csv", "steps.csv", "joints.csv", "slips.csv"}) {
    INFO(name);
    if (!fs::exists(folder / name)) continue;  // not begun yet
    const std::string text = content(folder / name);
    CHECK((whole.at(name).compare(0, text.size(), text) == 0));
    const auto ended = static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
    const bool numbers = std::string(name) == "histories.csv" || std::string(name) == "steps.csv";
    const size_t taken =
        numbers ? parse_csv(name, text, LastLine::kMustEnd).rows() : parse_text_table(name, text).rows.size();
    CHECK(taken == (ended == 0 ? 0 : ended - 1));
  }
  if (!fs::exists(folder / "fields/blocks.pvd")) return;
  for (const SeriesEntry& frame : read_series(folder / "fields/blocks.pvd")) {
    const std::string name = "fields/" + frame.file.filename().string();
    INFO(name);
    CHECK((content(frame.file) == whole.at(name)));
  }
}

}  // namespace talus::test
