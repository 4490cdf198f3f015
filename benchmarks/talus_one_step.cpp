// talus on the one-step problem that Siconos is given too: cold start, to --tolerance of Siconos's own error.
// The number of sweeps that reaches it is found first; one solution with that many is then timed.
// Usage: talus-one-step SCENE [--dt S] [--tolerance E] [--threads N]

#include <fmt/format.h>

#include "command_line.h"
#include "one_step_problem.h"
#include "talus/solve/gauss_seidel.h"
#include "talus_engine.h"

namespace talus::bench {
namespace {

// The problem as talus's solver has it: mobilities of implicit blocks in plane stress, one row pair per
// point.
struct Solvable {
  std::vector<Mobility> mobility;
  std::vector<BlockRate> rate;
  RowSet rows;
  int free_blocks = 0;
};

Solvable solvable(const BenchScene& scene, const OneStepProblem& problem) {
  Scene talus = talus_scene(scene, {});
  const PlaneModuli moduli = plane_moduli(5e9, 0.29, Plane::kStress);
  Solvable s;
  for (int i = 0; i < talus.blocks.count; ++i) {
    const bool moves = talus.blocks.moves_freely(i);
    talus.blocks.moduli[i] = moduli;
    s.mobility.push_back(moves ? mobility_implicit(talus.blocks, i, {1, 0}, 1, problem.dt * problem.dt)
                               : Mobility{});
    s.rate.push_back({{0, moves ? -kGravity * problem.dt : 0}, {}});
  }
  for (const OneStepPoint& point : problem.points) {
    PointRows p;
    // impulses act on talus's block a, which is b of the problem
    p.block_a = point.b, p.block_b = point.a;
    p.arm_a = point.point - talus.blocks.centroid[point.b];
    p.arm_b = point.point - talus.blocks.centroid[point.a];
    p.normal = point.normal;
    p.lower = 0, p.cohesion = 0;
    p.friction = problem.friction;
    s.rows.add(p, {0, 0});
  }
  return s;
}

struct Answer {
  std::vector<Vec2> impulse;
  double wall = 0, cpu = 0;
};

Answer solve(const Solvable& start, double dt, int sweeps, const Workers& workers) {
  Solvable s = start;
  SolverInput options;
  options.max_sweeps = sweeps;
  const double wall = wall_seconds(), cpu = cpu_seconds();
  Profile profile;
  workers.together([&] {
    GaussSeidel().solve({start.mobility, start.rate, dt, {}, s.rows, s.rate, profile}, 0, options, workers);
  });
  Answer answer{{}, wall_seconds() - wall, cpu_seconds() - cpu};
  for (const Impulse& p : s.rows.impulse) answer.impulse.push_back({p[0], -p[1]});
  return answer;
}

int run(int argc, char** argv) {
  const BenchOptions options = read_options(argc, argv);
  const BenchScene scene = named_scene(options.scene);
  const OneStepProblem problem = one_step_problem(scene, options.dt);
  const double before = resident_bytes();
  const Solvable start = solvable(scene, problem);
  const Workers workers(options.threads);
  int sweeps = 8;
  while (natural_map_error(problem, solve(start, options.dt, sweeps, workers).impulse) > options.tolerance) {
    if (sweeps > 200000) throw std::runtime_error("the error is not reached in 200000 sweeps");
    sweeps = sweeps + std::max(1, sweeps / 20);
  }
  const Answer answer = solve(start, options.dt, sweeps, workers);
  BenchRow row = one_step_row(scene, problem, answer.impulse);
  row.engine = "talus";
  row.scene = options.scene;
  row.threads = options.threads;
  row.sweeps = sweeps;
  row.ms_step = {1e3 * answer.wall, 1e3 * answer.wall, 1e3 * answer.wall};
  row.rss_bytes = resident_bytes();
  row.bytes_per_block = (row.rss_bytes - before) / row.blocks;
  row.cpu_per_simulated = answer.cpu / options.dt;
  fmt::print("{}\n{}\n", csv_header(), csv_line(row));
  return 0;
}

}  // namespace
}  // namespace talus::bench

int main(int argc, char** argv) {
  return talus::bench::run_program("talus-one-step", talus::bench::run, argc, argv);
}
