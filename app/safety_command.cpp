#include "safety_command.h"

#include <fmt/format.h>

#include <cstdio>

#include "talus/talus.h"

namespace talus::app {

int safety_command(const ModelArguments& args, const std::string& folder, bool force, int threads) {
  check_result_folder(folder, force, ResultKind::kSafety);
  const PreparedRun prepared = prepare_model(args).run;
  check_safety(prepared);
  // before anything is touched: the system may refuse them
  const Workers workers(threads > 0 ? threads : threads_for(prepared.scene.blocks.count));
  ResultFolder out(folder, force, ResultKind::kSafety);
  out.write("model.toml", prepared.scene.model.text);
  fmt::print("  {:>9}  {:<6}  {:<18}  {:>9}  {:>8}  {:>10}  {:>10}  {}\n", "factor", "", "ended by",
             "time [s]", "steps", "unbalanced", "moved [m]", "block");
  const SafetyResult result = seek_safety(prepared, workers, [](const SafetyTrial& t) {
    fmt::print("{}", safety_line(t));
    std::fflush(stdout);
  });
  out.write("safety.csv", safety_csv(result));
  out.write("safety.json", safety_json(prepared.scene.model, result));
  fmt::print("{}written to {}: safety.csv, safety.json\n", safety_text(result), folder);
  return kExitOk;
}

}  // namespace talus::app
