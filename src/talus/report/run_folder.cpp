#include "talus/report/run_folder.h"

#include <fmt/format.h>

#include "talus/base/error.h"
#include "talus/base/text_file.h"

namespace talus::report {

namespace fs = std::filesystem;

RunFolder read_run_folder(const fs::path& folder) {
  std::error_code ec;
  if (!fs::is_directory(folder, ec))
    throw FileError(fmt::format("{}: there is no such folder", folder.string()));
  if (!fs::exists(folder / "summary.json", ec))
    throw FileError(
        fmt::format("{}: holds no results of talus run: summary.json is missing", folder.string()));
  RunFolder run;
  run.path = folder;
  run.name = fs::absolute(folder).lexically_normal().filename().string();
  if (run.name.empty()) run.name = fs::absolute(folder).lexically_normal().parent_path().filename().string();
  try {
    run.summary = nlohmann::ordered_json::parse(read_text_file(folder / "summary.json"));
  } catch (const nlohmann::json::exception& e) {
    throw FileError(fmt::format("{}: cannot be read: {}", (folder / "summary.json").string(), e.what()));
  }
  if (!run.summary.is_object() || !run.summary.contains("status"))
    throw FileError(fmt::format("{}: is no summary of a run", (folder / "summary.json").string()));
  const auto there = [&](const char* name) { return fs::exists(folder / name, ec); };
  if (there("model.toml")) run.model = read_text_file(folder / "model.toml");
  if (there("histories.csv")) run.histories = read_csv(folder / "histories.csv");
  if (there("steps.csv")) run.steps = read_csv(folder / "steps.csv");
  if (there("slips.csv")) run.slips = read_text_table(folder / "slips.csv");
  if (there("bolts.csv")) run.bolts = read_text_table(folder / "bolts.csv");
  if (there("blocks.csv")) run.blocks = read_text_table(folder / "blocks.csv");
  run.block_frames = read_series(folder / "fields" / "blocks.pvd");
  run.contact_frames = read_series(folder / "fields" / "contacts.pvd");
  run.bolt_frames = read_series(folder / "fields" / "bolts.pvd");
  return run;
}

}  // namespace talus::report
