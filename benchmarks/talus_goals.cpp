// Measures of talus alone, beside those that need a rival: what exactness costs (P11), equilibrium of the
// damped wall or joint mass (Q2), lasting drift after an earthquake (Q3), a long run of settling rock. Usage:
// talus-goals exact|rest|drift|settle|large SCENE [THREADS]

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "command_line.h"
#include "talus_engine.h"

namespace talus::bench {
namespace {

constexpr double kDt = 1e-3;

Vec2 shaking(double t) { return {-0.3 * kGravity * std::sin(2 * 3.14159265358979323846 * 2 * t), -kGravity}; }

void run_for(TalusEngine& engine, double seconds, bool shake) {
  for (int64_t n = 0; n < std::llround(seconds / kDt); ++n) {
    engine.set_gravity(shake ? shaking((static_cast<double>(n) + 0.5) * kDt) : Vec2{0, -kGravity});
    engine.step(kDt);
  }
}

// Stiff joints in jointed rock, hard ones in walls. (drift_after() and large() take hard ones in any scene.)
EngineOptions options_for(const std::string& name, int threads) {
  EngineOptions options;
  options.threads = threads;
  options.stiffness = name.starts_with("joint") ? 2e10 : 0;
  return options;
}

// The same step solved with 20 sweeps and to an error of so much of the block size, from states of a run in which
// every step is solved so.
void exact(const std::string& name, int threads, double error_share) {
  const BenchScene scene = named_scene(name);
  EngineOptions options = options_for(name, threads);
  options.sweeps = 2000;
  // the solver itself stops at a tenth of its tolerance
  options.tolerance = 10 * error_share;
  TalusEngine engine(scene, options);
  engine.settings().damping_local = 0.8;
  run_for(engine, 0.3, false);
  engine.settings().damping_local = 0;
  const double smallest =
      *std::min_element(engine.scene().blocks.size.begin(), engine.scene().blocks.size.end());
  std::vector<double> plain, full, sweeps, error, plain_error;
  int64_t missed = 0;
  for (int n = 0; n < 300; ++n) {
    engine.set_gravity(shaking((n + 0.5) * kDt));
    if (n % 20 == 10) {
      const State before = engine.state();
      for (const bool to_the_end : {false, true}) {
        engine.state() = before;
        engine.scene().model.solver.max_sweeps = to_the_end ? 2000 : 20;
        engine.settings().tolerance = to_the_end ? options.tolerance * smallest : 1e-12 * smallest;
        const double start = wall_seconds();
        engine.step(kDt);
        (to_the_end ? full : plain).push_back(wall_seconds() - start);
        (to_the_end ? error : plain_error).push_back(engine.report().error.worst / smallest);
        if (to_the_end) sweeps.push_back(engine.report().solve.iterations);
      }
      continue;
    }
    engine.step(kDt);
    missed += engine.report().error.worst > error_share * smallest;
  }
  std::vector<double> ratio;
  for (size_t i = 0; i < full.size(); ++i) ratio.push_back(full[i] / plain[i]);
  const Spread r = spread(ratio), k = spread(sweeps), e = spread(error), p = spread(plain_error);
  fmt::print(
      "exact {}: step to {:.0e} / step of 20 sweeps = {:.3g} ({:.3g} to {:.3g}); sweeps {:.0f} ({:.0f} to "
      "{:.0f}); error {:.2g} (at most {:.2g}) of the smallest block against {:.2g} ({:.2g}) with 20 sweeps; "
      "{} of 285 steps above it\n",
      name, error_share, r.median, r.min, r.max, k.median, k.min, k.max, e.median, e.max, p.median, p.max,
      missed);
}

// Local damping until the unbalanced force is below 1e-7 of the mean.
void rest(const std::string& name, int threads) {
  const BenchScene scene = named_scene(name);
  EngineOptions options = options_for(name, threads);
  options.damping_local = 0.8;
  options.sweeps = 2000;
  options.tolerance = 1e-9;
  TalusEngine engine(scene, options);
  int64_t n = 0;
  for (; n < 60000 && (n < 10 || engine.report().unbalanced > 1e-7); ++n) engine.step(kDt);
  const LawError law = measure_law(scene, engine.contacts(), kDt, {0, -kGravity});
  // overlap of hard contacts beyond the stated slop, of compliant ones beyond their elastic closure
  double beyond = 0;
  const Scene& s = engine.scene();
  const StepWork& w = engine.work();
  for (size_t i = 0; i < engine.state().contacts.size(); ++i) {
    const PointRows& p = w.rows.points[w.rows.range(Family::kContact).begin + i];
    const Impulse& impulse = w.rows.impulse[w.rows.range(Family::kContact).begin + i];
    const double size = std::min(s.blocks.size[p.block_a], s.blocks.size[p.block_b]);
    double closure = p.row[0].compliance * impulse[0];
    if (p.partner >= 0) closure += p.cross(0) * w.rows.impulse[p.partner][0];
    closure *= kDt / StepClock{.alpha = s.model.contact.alpha}.position_factor();
    const double slop = p.row[0].compliance > 0 ? 0 : s.model.contact.slop * size;
    beyond = std::max(beyond, (-w.gaps[i] - closure - slop) / size);
  }
  fmt::print(
      "rest {}: unbalanced {:.2g} after {} steps, {:.1f} sweeps in the last; balance max {:.2g}, coulomb "
      "{:.2g}, overlap beyond slop or closure {:.2g} of the block\n",
      name, engine.report().unbalanced, n, static_cast<double>(engine.report().solve.iterations),
      law.balance_max, law.coulomb_max, beyond);
}

// Settled with damping, shaken for 2 s, quiet with damping for 1 s: what stays.
void drift_after(const std::string& name, int threads, int sweeps) {
  const BenchScene scene = named_scene(name);
  TalusEngine engine(scene, {.threads = threads, .sweeps = sweeps});
  engine.settings().damping_local = 0.8;
  run_for(engine, 2, false);
  const std::vector<BenchBlock> before = engine.blocks();
  engine.settings().damping_local = 0;
  run_for(engine, 2, true);
  engine.settings().damping_local = 0.8;
  run_for(engine, 1, false);
  const Displacement d = measure_displacement(before, engine.blocks());
  fmt::print(
      "drift {}: {:.3g} mm sideways at most, {:.3g} mm down, after 2 s at 0.3 g and 1 s of damped quiet; {} "
      "sweeps a step\n",
      name, 1e3 * d.drift_max, 1e3 * d.sink_max, sweeps);
}

// Jointed rock under sudden gravity for a second, and the deepest overlap on the way.
void settle(const std::string& name, int threads) {
  const BenchScene scene = named_scene(name);
  TalusEngine engine(scene, options_for(name, threads));
  const double start = wall_seconds();
  double deepest = 0, error = 0;
  for (int tenth = 0; tenth < 10; ++tenth) {
    for (int n = 0; n < 100; ++n) {
      engine.step(kDt);
      error = std::max(error, engine.report().error.worst);
    }
    deepest = std::max(deepest, measure_overlap(engine.blocks()).relative_max);
  }
  fmt::print(
      "settle {}: 1 s in {:.0f} s; deepest overlap {:.3g} of the smaller block; worst error {:.2g} m; {} "
      "contacts\n",
      name, wall_seconds() - start, deepest, error, engine.report().contacts);
}

void large(const std::string& name, int threads) {
  const BenchScene scene = named_scene(name);
  TalusEngine engine(scene, {.threads = threads});
  const double start = wall_seconds();
  for (int n = 0; n < 100; ++n) engine.step(kDt);
  fmt::print("large {}: {} blocks, {} contacts, 100 steps in {:.0f} s, peak memory {:.2f} GB\n", name,
             scene.moving(), engine.report().contacts, wall_seconds() - start, resident_peak_bytes() / 1e9);
}

int run(int argc, char** argv) {
  const std::string what = argc > 2 ? argv[1] : "", scene = argc > 2 ? argv[2] : "";
  const int threads = argc > 3 ? std::stoi(argv[3]) : 1;
  if (what == "exact") return exact(scene, threads, argc > 4 ? std::stod(argv[4]) : 1e-8), 0;
  if (what == "rest") return rest(scene, threads), 0;
  if (what == "drift") return drift_after(scene, threads, argc > 4 ? std::stoi(argv[4]) : 20), 0;
  if (what == "settle") return settle(scene, threads), 0;
  if (what == "large") return large(scene, threads), 0;
  fmt::print(stderr, "usage: talus-goals exact|rest|drift|settle|large SCENE [THREADS [SWEEPS|ERROR]]\n");
  return 2;
}

}  // namespace
}  // namespace talus::bench

int main(int argc, char** argv) {
  return talus::bench::run_program("talus-goals", talus::bench::run, argc, argv);
}
