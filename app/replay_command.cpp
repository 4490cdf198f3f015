#include "replay_command.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "talus/base/error.h"
#include "talus/results/problem_file.h"

namespace talus::app {

void add_replay_arguments(CLI::App& verb, ReplayArguments& args) {
  verb.add_option("FILE", args.file, "step_N.json from a result folder")->required();
  verb.add_option("--method", args.method, "solver")
      ->check(CLI::IsMember(std::vector<std::string>(kSolverName.begin(), kSolverName.end())))
      ->capture_default_str();
  verb.add_option("--tolerance", args.tolerance, "largest contact error [m]")
      ->check([](const std::string& text) { return std::atof(text.c_str()) > 0 ? "" : "must be > 0"; })
      ->capture_default_str();
  verb.footer(
      "Example: talus run model.toml -o out/m --dump-step 100 && talus replay out/m/step_100.json --method "
      "gauss_seidel");
}

int replay_command(const ReplayArguments& args) {
  SolverInput options;
  options.method = solver_called(args.method);
  options.second_solver = options.method == SolverKind::kAuto;  // one that is named is seen alone
  const Replay r = replay_problem(args.file, options, args.tolerance);
  fmt::print("{}: {} points on {} blocks, {} islands (largest {})\n", args.file, r.points, r.blocks,
             r.solved.report.islands, r.solved.report.largest_island);
  fmt::print("  {:<14} {} iterations, contact error {:.3e} m{}\n", name_of(r.solved.method),
             r.solved.report.iterations, r.solved.error.worst,
             r.solved.attempts.several() ? "; the first solver failed" : "");
  double normal = 0, shear = 0;
  for (const Impulse& p : r.rows.impulse) normal += p[0], shear += std::abs(p[1]);
  fmt::print("  impulses       normal {:.12g} N s in all, tangential {:.12g} N s in magnitude\n", normal,
             shear);
  return r.solved.error.worst <= args.tolerance ? kExitOk : kExitNumerical;
}

}  // namespace talus::app
