#include "compare_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/report/compare.h"
#include "tell.h"

namespace talus::app {

void add_compare_arguments(CLI::App& verb, CompareArguments& args) {
  verb.add_option("A", args.a, "result folder")->required();
  verb.add_option("B", args.b, "the one beside it")->required();
  verb.add_option("--rtol", args.rtol,
                  "what they may differ by, as share of the largest value of A; above it the exit code is 9")
      ->check(CLI::Range(0.0, 1e9));
  verb.add_option("--atol", args.atol, "the same, in the unit of each quantity, added to it")
      ->check(CLI::Range(0.0, 1e300));
  verb.footer("Example: talus compare out/by_forces out/by_penalty --rtol 0.01");
}

int compare_command(const CompareArguments& args) {
  const report::RunFolder a = report::read_run_folder(args.a), b = report::read_run_folder(args.b);
  const report::Comparison found = report::compare_runs(a, b);
  const bool judged = args.rtol >= 0 || args.atol >= 0;
  const double rtol = std::max(0.0, args.rtol), atol = std::max(0.0, args.atol);
  size_t widest = 4, stage = 5;
  for (const report::Difference& d : found.list)
    widest = std::max(widest, d.what.size()), stage = std::max(stage, d.stage.size());
  show("{:<8} {:<{}} {:<{}} {:>12} {:>10} {:>12} {:>12} {:>9}\n", "of", "stage", stage, "what", widest,
       "difference", "at t [s]", "rms", "largest of A", "share");
  size_t beyond = 0;
  for (const report::Difference& d : found.list) {
    const bool is_beyond = judged && report::beyond(d, rtol, atol);
    beyond += is_beyond;
    show("{:<8} {:<{}} {:<{}} {:>12.4g} {:>10.4g} {:>12} {:>12.4g} {:>8.2g}%{}\n", d.kind, d.stage, stage,
         d.what, widest, d.most, d.at, d.kind == "history" ? fmt::format("{:.4g}", d.rms) : "", d.scale,
         100 * d.share(), is_beyond ? "  BEYOND" : "");
  }
  for (const std::string& note : found.notes) show("note: {}\n", note);
  if (!judged) return kExitOk;
  show("{} of {} beyond {:g} of the largest of A + {:g}\n", beyond, found.list.size(), rtol, atol);
  return beyond == 0 ? kExitOk : kExitDiffers;
}

}  // namespace talus::app
