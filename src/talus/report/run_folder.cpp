#include "talus/report/run_folder.h"

#include <fmt/format.h>

#include "talus/base/error.h"
#include "talus/base/json_depth.h"
#include "talus/base/text_file.h"

namespace talus::report {

namespace fs = std::filesystem;

nlohmann::ordered_json parse_summary(const std::string& name, const std::string& text) {
  nlohmann::ordered_json summary;
  try {
    summary = nlohmann::ordered_json::parse(checked_json(name, text));
  } catch (const nlohmann::json::exception& e) {
    throw FileError(fmt::format("{}: cannot be read: {}", name, e.what()));
  }
  if (!summary.is_object() || !summary.contains("status"))
    throw FileError(fmt::format("{}: is no summary of a run", name));
  return summary;
}

RunFolder read_run_folder(const fs::path& folder) {
  std::error_code ec;
  if (is_there(folder) && !fs::is_directory(folder, ec))
    throw FileError(fmt::format("{}: is a file, not a folder of results", folder.string()));
  if (!is_there(folder)) throw FileError(fmt::format("{}: there is no such folder", folder.string()));
  if (!is_there(folder / "summary.json"))
    throw FileError(
        fmt::format("{}: holds no results of talus run: summary.json is missing", folder.string()));
  RunFolder run;
  run.path = folder;
  run.name = fs::absolute(folder).lexically_normal().filename().string();
  if (run.name.empty()) run.name = fs::absolute(folder).lexically_normal().parent_path().filename().string();
  run.summary = parse_summary((folder / "summary.json").string(), read_text_file(folder / "summary.json"));
  const auto there = [&](const char* name) { return is_there(folder / name); };
  const auto unless_missing = [&](const char* name) {
    if (!there(name)) return CsvTable();
    CsvTable table = read_csv(folder / name, LastLine::kMustEnd);
    if (table.cut_short)
      run.notes.push_back(fmt::format("{}: its last row is not whole, and left out", name));
    return table;
  };
  const auto series = [&](const std::string& name) {
    bool cut_short = false;
    std::vector<SeriesEntry> frames = read_series(folder / "fields" / name, &cut_short);
    if (cut_short && !frames.empty())
      run.notes.push_back(
          fmt::format("fields/{}: its end is missing; read up to {} frames", name, frames.size()));
    return frames;
  };
  if (there("model.toml")) run.model = read_text_file(folder / "model.toml");
  run.histories = unless_missing("histories.csv");
  run.steps = unless_missing("steps.csv");
  if (there("slips.csv")) run.slips = read_text_table(folder / "slips.csv");
  if (there("bolts.csv")) run.bolts = read_text_table(folder / "bolts.csv");
  if (there("blocks.csv")) run.blocks = read_text_table(folder / "blocks.csv");
  run.block_frames = series("blocks.pvd");
  run.contact_frames = series("contacts.pvd");
  run.bolt_frames = series("bolts.pvd");
  const auto frames = run.summary.find("frames");
  if (run.block_frames.empty() && frames != run.summary.end() && frames->is_number() && *frames > 0)
    run.notes.push_back("fields/blocks.pvd is missing: there is no motion to show");
  return run;
}

}  // namespace talus::report
