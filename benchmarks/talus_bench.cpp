// talus on one scene: settles it, shakes or holds it, and prints one CSV line per phase like the rivals do.
// Usage: talus-bench SCENE [--dt S] [--settle S] [--shake S] [--shake_g G] [--sweeps N] [--threads N]
//        [--tolerance SHARE] [--stiffness PA_PER_M] [--explicit 1] [--profile 1]

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "command_line.h"
#include "talus_engine.h"

#include "talus/base/index.h"

namespace {

using namespace talus;
using namespace talus::bench;

// Takes an option of talus alone out of the list.
double take(std::vector<char*>& arguments, const std::string& name, double otherwise) {
  for (size_t i = 1; i + 1 < arguments.size(); ++i) {
    if (name != arguments[i]) continue;
    otherwise = std::strtod(arguments[i + 1], nullptr);
    arguments.erase(arguments.begin() + i, arguments.begin() + i + 2);
    break;
  }
  return otherwise;
}

int run(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  EngineOptions own;
  own.stiffness = take(arguments, "--stiffness", 0);
  own.implicit = take(arguments, "--explicit", 0) == 0;
  own.tolerance = take(arguments, "--tolerance", own.tolerance);
  const bool profile = take(arguments, "--profile", 0) != 0;
  const BenchOptions options = read_options(count_of(arguments), arguments.data());
  if (options.sweeps > 0) own.sweeps = options.sweeps;
  own.threads = options.threads;
  const BenchScene scene = named_scene(options.scene);
  const double before = resident_bytes();
  TalusEngine engine(scene, own);
  run_scene(engine, scene, options, before);
  if (!profile) return 0;
  Profile& spent = engine.work().profile;
  spent.shared = engine.work().workers.shared_seconds(), spent.wall = engine.wall();
  std::fputs(profile_text(spent, options.threads).c_str(), stderr);
  std::fprintf(stderr, "sweeps %d, searched %d, contacts %d, colours %d, error %.3g m at %s\n",
               engine.report().solve.iterations, engine.report().searched, engine.report().contacts,
               engine.report().solve.colours, engine.report().error.worst, engine.report().worst.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_program("talus-bench", run, argc, argv); }
