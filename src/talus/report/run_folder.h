#pragma once
// A result folder as `talus run` left it. Whatever an older talus did not write stays empty.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "talus/output/csv.h"
#include "talus/output/read_vtk.h"
#include "talus/output/text_table.h"

namespace talus::report {

struct RunFolder {
  std::filesystem::path path;
  std::string name;  // last part of the path
  nlohmann::ordered_json summary;
  std::string model;          // model.toml
  CsvTable histories, steps;  // no columns: the file is missing or has no row
  TextTable slips, bolts;     // the same
  TextTable blocks;           // blocks.csv
  std::vector<SeriesEntry> block_frames, contact_frames, bolt_frames;
  std::vector<std::string> notes;  // what was left out, of a run that was killed
};

/// The content of a summary.json. Throws FileError when it is none.
nlohmann::ordered_json parse_summary(const std::string& name, const std::string& text);

/// Reads what there is, also of a run that goes on or was killed. Throws FileError when the folder is missing or
/// holds no run, or a file in it cannot be read.
RunFolder read_run_folder(const std::filesystem::path& folder);

}  // namespace talus::report
