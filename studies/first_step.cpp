// The first step of a model, solved again and again: the error that is left over the time it took, by sweeps and by
// Newton's method in velocities, each with as many of them as the list says. From the same state each time, the least of
// three times.
//
// Usage: first_step OUT_STEM THREADS NAME=MODEL[,KEY=VALUE ...] ...
// Writes OUT_STEM.csv (name, solver, sweeps or iterations, seconds, error in metres) and the chart as .svg and .png.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "talus/base/text_file.h"
#include "talus/plot/figure.h"
#include "talus/run/run.h"
#include "talus/step/step.h"

namespace {

using namespace talus;

constexpr int kTimes = 3;

struct Result {
  std::string name, solver;
  int count = 0;
  double seconds = 0, error = 0;
};

// One kick from `start`, and how long all of it took.
Result solved(Scene& scene, const StagePlan& plan, const State& start, SolverKind kind, int count,
              const Workers& workers) {
  SolverInput& solver = scene.model.solver;
  solver.method = kind, solver.second_solver = false;
  // no iterations: what sweeps leave that Newton's method begins from
  solver.max_sweeps = kind == SolverKind::kGaussSeidel ? count : 40;
  solver.max_iterations = count;
  const StageInput& stage = scene.model.stages[0];
  StepSettings settings;
  settings.damping_local = stage.damping_local;
  // never reached: all that is asked for is done
  settings.tolerance = 1e-15 * tolerance_size(scene.blocks);
  settings.dynamic = false, settings.implicit = stage.implicit, settings.from_rest = stage.from_rest;
  Result row;
  row.count = count, row.seconds = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTimes; ++i) {
    StepWork work;
    work.workers = workers;
    State state = start;
    const auto begin = std::chrono::steady_clock::now();
    const StepReport report = kick(scene, settings, plan.dt, work, state);
    const double all = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    row.error = report.error.worst;
    row.seconds = std::min(row.seconds, all);
    if (all > 20) break;
  }
  return row;
}

std::vector<Result> rows_of(const std::string& what, const Workers& workers) {
  std::vector<std::string> parts;
  std::stringstream list(what);
  for (std::string part; std::getline(list, part, ',');) parts.push_back(part);
  const size_t at = parts.at(0).find('=');
  const std::string name = parts[0].substr(0, at), file = parts[0].substr(at + 1);
  const std::string text = read_text_file(file);
  Findings findings(file, text);
  PreparedRun run = prepare_run(file, text, {parts.begin() + 1, parts.end()}, findings);
  const State start = start_state(run.scene);
  std::vector<Result> rows;
  const auto add = [&](SolverKind kind, const std::vector<int>& counts) {
    for (const int count : counts) {
      Result row = solved(run.scene, run.plans[0], start, kind, count, workers);
      row.name = name, row.solver = name_of(kind);
      fmt::print("{}, {}, {}: {:.3g} s, {:.3g} m\n", row.name, row.solver, row.count, row.seconds, row.error);
      std::fflush(stdout);
      rows.push_back(row);
    }
  };
  add(SolverKind::kGaussSeidel, {10, 20, 40, 80, 160, 320, 640, 1280, 2560});
  add(SolverKind::kPrimalNewton, {1, 2, 3, 4, 6, 8, 12, 16});
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    fmt::print(stderr, "usage: first_step OUT_STEM THREADS NAME=MODEL[,KEY=VALUE ...] ...\n");
    return 2;
  }
  try {
    const Workers workers(std::atoi(argv[2]));
    std::string csv = "name,solver,sweeps or iterations,seconds,error [m]\n";
    plot::Figure figure;
    figure.title = "First step: error over time";
    figure.x_label = "lg (time [s])", figure.y_label = "lg (error [m])";
    for (int i = 3; i < argc; ++i) {
      for (const Result& row : rows_of(argv[i], workers)) {
        csv +=
            fmt::format("{},{},{},{:.6g},{:.6g}\n", row.name, row.solver, row.count, row.seconds, row.error);
        const std::string label = row.name + ", " + row.solver;
        if (figure.curves.empty() || figure.curves.back().label != label) {
          plot::Curve curve;
          curve.label = label, curve.color = i - 3;
          curve.style = row.solver == "gauss_seidel" ? plot::Style::kDashed : plot::Style::kSolid;
          figure.curves.push_back(curve);
        }
        figure.curves.back().x.push_back(std::log10(row.seconds));
        figure.curves.back().y.push_back(std::log10(row.error));
      }
    }
    std::ofstream(std::string(argv[1]) + ".csv") << csv;
    plot::write_figure(figure, argv[1]);
  } catch (const std::exception& e) {
    fmt::print(stderr, "first_step: {}\n", e.what());
    return 1;
  }
  return 0;
}
