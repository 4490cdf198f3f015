// Finds limit states by bisection, where tests/verification/test_limit_states.cpp only brackets them: the
// least thickness of semicircular arches, the horizontal push that arches bear, the friction angle below
// which columns on a slope topple (Goodman and Bray). Prints each limit, its reference and what the runs
// took.
//
// Usage: limit_states [newton|gauss_seidel] [thickness|push|ramp|toppling ...]
// Default: gauss_seidel, all groups; half a minute to three minutes. Newton finds the same limits of
// arches at some ten times the cost, and none for toppling: its runs fail or stray.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "support/limit_models.h"
#include "talus/talus.h"

namespace {

using talus::Vec2;
using namespace talus::test;
using namespace talus::test::limit;

// Ends a run when something has moved further than what stands.
class MotionWatch : public talus::Observer {
 public:
  explicit MotionWatch(double allowed) : allowed_(allowed) {}
  void at(const talus::Instant& now) override {
    if (stands()) stood_until = now.state.time;
    for (const Vec2 d : now.state.displacement) moved = std::max(moved, norm(d));
  }
  bool stop() override { return !stands(); }
  bool stands() const { return moved <= allowed_; }

  double moved = 0;        // [m] most of all blocks so far
  double stood_until = 0;  // [s]

 private:
  double allowed_;  // [m]
};

// Runs of one case, and what they took.
class Runs {
 public:
  /// @param allowed  motion [m] of what stands
  explicit Runs(std::vector<std::string> overrides, double allowed = 1e-4)
      : overrides_(std::move(overrides)), allowed_(allowed) {}

  MotionWatch run(const std::string& text) {
    talus::Findings findings("limit_states", text);
    talus::PreparedRun prepared = talus::prepare_run("limit_states", text, overrides_, findings);
    talus::State state = talus::start_state(prepared.scene);
    MotionWatch watch(allowed_);
    const talus::RunResult result = talus::run_stages(prepared.scene, prepared.plans, state, watch);
    ++count_;
    steps_ += result.steps, second_ += result.second_solver_steps, seconds_ += result.cpu_seconds;
    if (!result.failure.empty()) throw talus::NumericalError(result.failure);
    if (watch.stands()) trembling_ = std::max(trembling_, watch.moved);
    return watch;
  }

  void print(const std::string& name, double found, double width, double reference, const char* unit) const {
    const double off = *unit == '%' ? 100 * (found / reference - 1) : found - reference;
    fmt::print("{:<42} {:>9.6g} {:<10} {:>9.6g} {:+8.3f} {:<3} {:>3} runs {:>6} steps {:>5.1f} s", name,
               found, width > 0 ? fmt::format("+- {:.2g}", width / 2) : "", reference, off, unit, count_,
               steps_, seconds_);
    fmt::print(", {:.0f} % by the second solver",
               100.0 * static_cast<double>(second_) / static_cast<double>(steps_));
    fmt::print("{}\n", trembling_ > 0 ? fmt::format(", stands within {:.1e} m", trembling_) : "");
    std::fflush(stdout);
  }

 private:
  std::vector<std::string> overrides_;
  double allowed_;
  int count_ = 0;
  int64_t steps_ = 0, second_ = 0;
  double seconds_ = 0, trembling_ = 0;
};

// Halves the interval between a value that stands and one that collapses down to `width`.
void bisect(Runs& runs, const std::string& name, double stands, double collapses, double width,
            double reference, const char* unit, const std::function<std::string(double)>& text_of) {
  double tried = stands;
  const auto goes_at = [&](double value) { return !runs.run(text_of(tried = value)).stands(); };
  try {
    const bool goes_when_safe = goes_at(stands);
    if (goes_when_safe || !goes_at(collapses)) {
      fmt::print("{:<36} no bracket: {} at {:.6g}\n", name, goes_when_safe ? "collapses" : "stands", tried);
      return;
    }
    while (std::abs(stands - collapses) > width) {
      const double middle = 0.5 * (stands + collapses);
      (goes_at(middle) ? collapses : stands) = middle;
    }
    runs.print(name, 0.5 * (stands + collapses), std::abs(stands - collapses), reference, unit);
  } catch (const talus::NumericalError& e) {
    fmt::print("{:<36} no answer: a run failed at {:.6g} ({:.6g} the reference): {}\n", name, tried,
               tried / reference, e.what());
  }
}

constexpr double kWidth = 3e-3;  // of the last interval, as share of the reference

void study_thickness(const std::string& solver) {
  const std::pair<int, double> cases[] = {{9, 0.101525}, {15, 0.106068}, {27, 0.106721}, {60, 0.107448}};
  for (const auto& [voussoirs, reference] : cases) {
    Runs runs({solver, "solver.max_sweeps=200000"});
    bisect(runs, fmt::format("arch, {} voussoirs: least t/R", voussoirs), 1.12 * reference, 0.91 * reference,
           kWidth * reference, reference, "%", [n = voussoirs](double t) {
             return arch_text({180, t, n}, 0, 45) + stage_text(2, 2e-3);
           });
  }
}

struct PushCase {
  Arch arch;
  double friction, reference;
};

// With friction 0.4 the reference is that of associated sliding, an upper bound for Coulomb's.
const PushCase kPushed[] = {{{157.5, 0.15, 7}, 0.7, 0.373612}, {{157.5, 0.15, 28}, 0.7, 0.354868},
                            {{180, 0.125, 27}, 0.7, 0.065505}, {{180, 0.15, 27}, 0.7, 0.145338},
                            {{180, 0.2, 27}, 0.7, 0.284337},   {{157.5, 0.15, 7}, 0.4, 0.257},
                            {{180, 0.15, 27}, 0.4, 0.052352}};

std::string name_of(const PushCase& c) {
  return fmt::format("{:g} deg, t/R {:g}, n {}, mu {:g}: k", c.arch.embrace, c.arch.thickness,
                     c.arch.voussoirs, c.friction);
}

void study_push(const std::string& solver) {
  for (const PushCase& c : kPushed) {
    Runs runs({solver});
    bisect(runs, name_of(c), c.friction < 0.5 ? 0 : 0.88 * c.reference, 1.09 * c.reference,
           kWidth * c.reference, c.reference, "%", [&c](double push) {
             return arch_text(c.arch, push, std::atan(c.friction) * 180 / std::numbers::pi) +
                    stage_text(2, 2e-3);
           });
  }
}

// The push grows from nothing to 1.1 of the reference in 40 s, forty times sqrt(R/g). Read late: beyond the
// limit the motion is about g k' (t - t0)^3/6, visible (1e-4 m) after 0.15 to 0.3 s, 0.5 to 0.9 % of the
// limit.
void study_ramp(const std::string& solver) {
  for (const PushCase& c : kPushed) {
    const double end = 40;
    Runs runs({solver});
    const MotionWatch watch = runs.run(arch_text(c.arch, 0, std::atan(c.friction) * 180 / std::numbers::pi) +
                                       stage_text(end, 2e-3) + ramp_text(end, 1.1 * c.reference));
    runs.print(name_of(c) + ", ramp", 1.1 * c.reference * watch.stood_until / end, 0, c.reference, "%");
  }
}

// What stands may slip by a few millimetres before its forces are found: they are not unique. The contact
// error allowed must be small against g dt^2.
void study_toppling(const std::string& solver) {
  for (const double step : {1e-2, 5e-3, 2e-3}) {
    Runs runs({solver}, 1e-2);
    bisect(runs, fmt::format("toppling, dt {:g} s: friction angle", step), 39.7, 36, 0.02, 38.134, "deg",
           [step](double angle) { return columns_text(angle) + stage_text(4, step); });
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::set<std::string> groups(argv + 1, argv + argc);
  std::string solver = "gauss_seidel";
  for (const char* name : {"newton", "gauss_seidel"})
    if (groups.erase(name) > 0) solver = name;
  solver = "solver.method=" + solver;
  const std::pair<const char*, void (*)(const std::string&)> studies[] = {{"thickness", study_thickness},
                                                                          {"push", study_push},
                                                                          {"ramp", study_ramp},
                                                                          {"toppling", study_toppling}};
  const auto known = [&studies](const std::string& group) {
    return std::any_of(std::begin(studies), std::end(studies),
                       [&](const auto& s) { return group == s.first; });
  };
  if (!std::all_of(groups.begin(), groups.end(), known)) {
    fmt::print(stderr, "usage: limit_states [newton|gauss_seidel] [thickness|push|ramp|toppling ...]\n");
    return 2;
  }
  try {
    for (const auto& [name, study] : studies)
      if (groups.empty() || groups.count(name) > 0) study(solver);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
