#pragma once
// What the mains of all engines share: errors told under the name of the program, and the course of a run by
// an engine that has no threads.

#include <fmt/format.h>

#include <exception>

#include "measures.h"

namespace talus::bench {

/// Calls `run`; what it throws is printed to the error stream after the name of the program.
/// @return the exit code: what `run` returns, 2 when it throws
inline int run_program(const char* name, int (*run)(int, char**), int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return 2;
  }
}

/// run_scene() of the scene and options of the command line by an engine that has no threads; --threads is
/// read, and 1 is what the results say.
/// @param make_engine (scene, options) -> the engine, a BenchEngine; the memory that it takes is measured
/// @return 0
/// @throws as read_options() and named_scene()
template <class MakeEngine>
int run_on_one_thread(int argc, char** argv, MakeEngine make_engine) {
  BenchOptions options = read_options(argc, argv);
  options.threads = 1;
  const BenchScene scene = named_scene(options.scene);
  const double resident_before = resident_bytes();
  auto engine = make_engine(scene, options);
  run_scene(engine, scene, options, resident_before);
  return 0;
}

/// The main of an engine that is made of a scene and a number of sweeps, kSweeps where the command line names
/// none. @return as run_program()
template <class Engine, int kSweeps>
int run_rival(const char* name, int argc, char** argv) {
  const auto run = [](int count, char** values) {
    return run_on_one_thread(count, values, [](const BenchScene& scene, const BenchOptions& options) {
      return Engine(scene, options.sweeps > 0 ? options.sweeps : kSweeps);
    });
  };
  return run_program(name, run, argc, argv);
}

}  // namespace talus::bench
