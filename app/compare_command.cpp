#include "compare_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "study_command.h"
#include "talus/base/error.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"
#include "talus/report/compare.h"
#include "tell.h"

namespace talus::app {

namespace {

// A folder that is there and cannot be read is a side that is not whole. Throws FileError where there is none.
std::optional<report::RunFolder> side(const std::string& folder, std::string& why) {
  if (!is_there(folder)) throw FileError(fmt::format("{}: there is no such folder", folder));
  if (!std::filesystem::is_directory(folder))
    throw FileError(fmt::format("{}: is a file, not a folder of results", folder));
  if (is_study_folder(folder))
    throw FileError(
        fmt::format("{0}: is a folder of talus study: compare its runs, {0}/runs/000000", folder));
  try {
    return report::read_run_folder(folder);
  } catch (const FileError& e) {
    why = e.what();
  } catch (const nlohmann::json::exception& e) {
    why = fmt::format("{}/summary.json: cannot be read: {}", folder, e.what());
  }
  return std::nullopt;
}

size_t show_table(const report::Comparison& found, const report::Tolerances& tolerances) {
  size_t widest = 4, stage = 5, beyond = 0;
  for (const report::Difference& d : found.list)
    widest = std::max(widest, d.what.size()), stage = std::max(stage, d.stage.size());
  show("{:<8} {:<{}} {:<{}} {:>12} {:>10} {:>12} {:>12} {:>9}\n", "of", "stage", stage, "what", widest,
       "difference", "at t [s]", "rms", "largest of A", "share");
  for (const report::Difference& d : found.list) {
    const bool is_beyond = tolerances.given() && report::beyond(d, tolerances.of(d));
    beyond += is_beyond;
    show("{:<8} {:<{}} {:<{}} {:>12.4g} {:>10.4g} {:>12} {:>12.4g} {:>8.2g}%{}\n", d.kind, d.stage, stage,
         d.what, widest, d.most, d.at, d.kind == "history" ? fmt::format("{:.4g}", d.rms) : "", d.scale,
         100 * d.share(), is_beyond ? "  BEYOND" : "");
  }
  return beyond;
}

}  // namespace

void add_compare_arguments(CLI::App& verb, CompareArguments& args) {
  verb.add_option("A", args.a, "result folder")->required();
  verb.add_option("B", args.b, "the one beside it")->required();
  verb.add_option(
          "--rtol", args.rtol,
          "what they may differ by, as share of the largest value of A; above it the exit code is 9. "
          "QUANTITY=NUMBER: of a quantity (displacement), a unit (m/s), joints or ledger alone; what none names is held to 0")
      ->expected(1)
      ->take_all();
  verb.add_option("--atol", args.atol, "the same, in the unit of each quantity, added to it")
      ->expected(1)
      ->take_all();
  verb.add_flag("--other-model", args.other_model, "with a tolerance: they may be runs of two models");
  verb.footer("Example: talus compare out/by_forces out/by_penalty --rtol 0.01 --atol displacement=1e-6");
}

int compare_command(const CompareArguments& args) {
  report::Tolerances tolerances;
  for (const std::string& text : args.rtol) tolerances.add(text, &report::Tolerance::rtol);
  for (const std::string& text : args.atol) tolerances.add(text, &report::Tolerance::atol);
  std::string why;
  const auto a = side(args.a, why), b = side(args.b, why);
  if (!a || !b) {
    show("NOT WHOLE: {}\n", why);
    return kExitDiffers;
  }
  report::Comparison found;
  try {
    found = report::compare_runs(*a, *b);
  } catch (const FileError& e) {
    show("NOT WHOLE: {}\n", e.what());
    return kExitDiffers;
  } catch (const nlohmann::json::exception& e) {
    show("NOT WHOLE: a summary is not what a run writes: {}\n", e.what());
    return kExitDiffers;
  }
  if (const auto unused = tolerances.unused(found.list); !unused.empty() && found.faults.empty())
    throw Error(
        kExitUsage,
        fmt::format("nothing that is compared is called {}: give a quantity, a unit, joints or ledger",
                    join_or(unused)));
  const size_t beyond = show_table(found, tolerances);
  for (const std::string& note : found.notes) show("note: {}\n", note);
  const bool models_count = tolerances.given() && !args.other_model;
  for (const std::string& text : found.models)
    show("{}: {}\n", models_count ? "ANOTHER MODEL" : "note: another model", text);
  for (const std::string& fault : found.faults) show("NOT COMPARABLE: {}\n", fault);
  if (tolerances.given()) show("{} of {} beyond what they may differ by\n", beyond, found.list.size());
  const bool same = found.faults.empty() && (!models_count || found.models.empty()) && beyond == 0;
  return same ? kExitOk : kExitDiffers;
}

}  // namespace talus::app
