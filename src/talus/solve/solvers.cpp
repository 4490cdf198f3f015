#include "talus/solve/solvers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/solve/gauss_seidel.h"
#include "talus/solve/newton.h"
#include "talus/solve/pivoting.h"
#include "talus/solve/primal_newton.h"

namespace talus {

namespace {

template <class T>
std::unique_ptr<Solver> make() {
  return std::make_unique<T>();
}

// Newton is asked to mend up to so many points: beyond, its factors would fill the memory.
constexpr size_t kMostNewtonPoints = 8000, kAny = std::numeric_limits<size_t>::max();

// Pivoting looks at each island by itself and leaves the large ones; beyond so many points in all a step is too dear
// to be asked about.
constexpr size_t kMostPivotedPoints = 20000;

// In the order of SolverKind. A new solver is a file of its own, a name in model/solver_kind.h and a line
// here.
constexpr std::array kSolvers{SolverEntry{.kind = SolverKind::kNewton,
                                          .make = make<Newton>,
                                          .smoothed = true,
                                          .mended = SolverKind::kGaussSeidel,
                                          .far_off = true,
                                          .goes_on = false,
                                          .last = false,
                                          .most_points = kMostNewtonPoints},
                              SolverEntry{.kind = SolverKind::kGaussSeidel,
                                          .make = make<GaussSeidel>,
                                          .smoothed = false,
                                          .mended = SolverKind::kNewton,
                                          .far_off = false,
                                          .goes_on = true,
                                          .last = false,
                                          .most_points = kAny},
                              SolverEntry{.kind = SolverKind::kPrimalNewton,
                                          .make = make<PrimalNewton>,
                                          .smoothed = false,
                                          .mended = SolverKind::kGaussSeidel,
                                          .far_off = false,
                                          .goes_on = false,
                                          .last = false,
                                          .most_points = kAny},
                              SolverEntry{.kind = SolverKind::kPivoting,
                                          .make = make<Pivoting>,
                                          .smoothed = false,
                                          .mended = SolverKind::kGaussSeidel,
                                          .far_off = false,
                                          .goes_on = false,
                                          .last = true,
                                          .most_points = kMostPivotedPoints}};
static_assert(kSolvers.size() + 1 == kSolverName.size());
static_assert(std::ranges::all_of(kSolvers, [](const SolverEntry& e) {
  return place_of(e.kind) == &e - kSolvers.data() + 1;
}));

// Up to so many points `auto` takes Newton: it is as fast there and reaches round-off. Where bodies are tied
// together the equations are nearly linear, and sweeps are slow along them.
constexpr size_t kNewtonFaster = 12, kNewtonFasterTied = 2000;

// Sweeps after which a step that another solver can mend is given to it.
constexpr int kSweepsBeforeSecond = 500;

// Where joints give and sweeps are slow, Newton's method in velocities ends a step in one to three factors, each as
// dear as some 140 sweeps whatever the size; it is asked where more than so many sweeps are still to be expected
// (theory 5.8), of at least so many points: a thousand sweeps of fewer are over in no time.
constexpr int kWorthOfFactors = 300;
constexpr size_t kFewestPrimal = 2000;

// Factors that friction in turns may take, of as many points as a factor costs little; of more it is in proportion, and where
// a step cannot be shortened sweeps are the better use of time.
constexpr int kMostInTurns = 1000;

int worth_of_turns(const RowKinds& kinds, size_t points) {
  if (points <= kFewestPrimal) return kMostInTurns;
  return kinds.from_rest ? static_cast<int>(kMostInTurns * kFewestPrimal / points) : 0;
}

// Solvers stop earlier than the judge. Errors left in hard rows are pushed back in the next step, which is
// work out of nothing, and those in redundant ties add up, until no motion satisfies them all; Newton goes so
// far at no cost.
constexpr double kStop = 0.1;

// Rows that give have forces that follow from where the blocks are: an error is there once.
constexpr double kStopGiving = 0.5;

// Where a solver stops (theory 5.7).
SolverGoal goal_of(SolverKind kind, const RowKinds& kinds, double tolerance, double sharper) {
  const bool giving =
      kind == SolverKind::kGaussSeidel && kinds.give && !kinds.at_rest && kinds.hard_ties == 0;
  const double enough = (giving ? kStopGiving : kStop) * tolerance;
  return {sharper * enough, enough, giving};
}

// Sweeps after which they are given up for another solver; 0: none is any better.
int worth_of_sweeps(SolverKind kind, const RowKinds& kinds, size_t points) {
  return kind == SolverKind::kGaussSeidel && kinds.give && points >= kFewestPrimal ? kWorthOfFactors : 0;
}

// Whether what a solver found of itself is what is measured apart from it; they differ by the round-off of
// velocities, of the biases and compliances that cancel in a row at rest, and of impulses, from whose
// difference the separate measure is made.
[[maybe_unused]] bool same_error(const ContactError& error, const StepProblem& problem,
                                 const Workers& workers) {
  const double apart = contact_error(problem.mobility, problem.rows, problem.rate, problem.dt, workers).worst;
  double speed = 0;
  for (const BlockRate& v : problem.rate) speed = std::max({speed, norm(v.a), std::sqrt(contract(v.G, v.G))});
  double yield = 0, terms = 0;
  for (const Mobility& m : problem.mobility) yield = std::max(yield, 10 * m.mass);
  for (size_t r = 0; r < problem.rows.points.size(); ++r)
    for (size_t k = 0; k < 2; ++k) {
      const Row& row = problem.rows.points[r].row[k];
      terms = std::max(terms,
                       std::abs(row.bias) + (row.compliance + yield) * std::abs(problem.rows.impulse[r][k]));
    }
  if (std::isnan(apart) || std::isnan(error.worst)) return std::isnan(apart) == std::isnan(error.worst);
  return std::abs(apart - error.worst) <= 1e-6 * apart + (1e-9 * speed + 1e-12 * terms) * problem.dt;
}

}  // namespace

const SolverEntry& entry(SolverKind kind) { return kSolvers.at(place_of(kind) - 1); }

Solver& SolverSet::of(SolverKind kind) {
  std::unique_ptr<Solver>& made = made_[place_of(kind)];
  if (!made) made = entry(kind).make();
  return *made;
}

SolverKind chosen_solver(const Model& model, size_t points, const RowKinds& kinds) {
  if (model.solver.method != SolverKind::kAuto) return model.solver.method;
  if (model.contact.law == ContactLaw::kSmoothed || model.solver.jacobian == JacobianKind::kDifference)
    return SolverKind::kNewton;
  if (kinds.from_rest) return SolverKind::kPrimalNewton;
  return points <= (2 * kinds.hard_ties > points ? kNewtonFasterTied : kNewtonFaster)
             ? SolverKind::kNewton
             : SolverKind::kGaussSeidel;
}

// Theory 5.7.
Solved solve_step(const Model& model, const RowKinds& kinds, double tolerance, double limit, double sharper,
                  bool keep_guess, const Workers& workers, SolverSet& solvers, const StepProblem& problem,
                  std::vector<Impulse>& guess) {
  TALUS_ASSERT(tolerance > 0 && sharper > 0 && sharper <= 1);
  TALUS_ASSERT(problem.dt > 0 && problem.mobility.size() == problem.rate_free.size());
  TALUS_ASSERT(problem.rows.impulse.size() == problem.rows.points.size());
  const SolverInput& options = model.solver;
  const bool smoothed = model.contact.law == ContactLaw::kSmoothed;
  const SolverKind first = chosen_solver(model, problem.rows.points.size(), kinds),
                   second = entry(first).mended;
  // a shorter step from rest costs less than thousands of sweeps
  const bool shorter = kinds.from_rest && !kinds.by_all && first == SolverKind::kPrimalNewton;
  const bool again = options.second_solver && !smoothed && !shorter &&
                     problem.rows.points.size() <= entry(second).most_points;
  const SolverEntry& last = *std::ranges::find_if(kSolvers, &SolverEntry::last);
  const bool to_the_last = options.second_solver && !smoothed && (!kinds.from_rest || kinds.by_all) &&
                           first != last.kind && problem.rows.points.size() <= last.most_points;
  TALUS_ASSERT(!smoothed || entry(first).smoothed);
  guess.clear();
  if (again || to_the_last || keep_guess) guess = problem.rows.impulse;

  Solved now;
  Attempts attempts;
  const auto judge = [&] {
    const InPart part(problem.profile, Profile::kJudge);
    return contact_error(problem.mobility, problem.rows, problem.rate, problem.dt, workers);
  };
  const auto take = [&](const ContactError& error) {
    now.error = error;
    // the smoothed law misses the exact one by design: there the solver's own residual is the judge
    now.failed = smoothed ? !now.report.converged : !(now.error.worst <= tolerance);
  };
  const auto solve_by = [&](SolverKind kind, int sweeps, int worth = 0) {
    SolverInput limits = options;
    limits.max_sweeps = sweeps;
    SolverGoal goal = goal_of(kind, kinds, tolerance, sharper);
    goal.worth = worth, goal.limit = limit, goal.solved = tolerance;
    goal.turns = smoothed ? 0 : worth_of_turns(kinds, problem.rows.points.size());
    now.method = kind;
    now.report = solvers.of(kind).solve(problem, goal, limits, workers);
    attempts.add(kind, now.report.iterations);
    take(now.report.judged ? *now.report.judged : judge());
    TALUS_ASSERT(!now.report.judged || same_error(now.error, problem, workers));
  };
  const int few = again ? std::min(options.max_sweeps, kSweepsBeforeSecond) : options.max_sweeps;
  const int worth =
      options.second_solver && !smoothed ? worth_of_sweeps(first, kinds, problem.rows.points.size()) : 0;
  solve_by(first, few, worth);
  const bool gave_up = now.report.gave_up;
  now.attempts = attempts;
  if (!gave_up && (!now.failed || !(again || to_the_last))) return now;

  struct Attempt {
    Solved solved;
    std::vector<Impulse> impulse;
    std::vector<BlockRate> rate;
  };
  Attempt best{now, problem.rows.impulse, problem.rate};
  bool best_stands = true;
  const auto attempt = [&](SolverKind kind, int sweeps, bool from_guess) {
    problem.rows.impulse = from_guess || std::isnan(best.solved.error.worst) ? guess : best.impulse;
    solve_by(kind, sweeps);
    best_stands = std::isnan(best.solved.error.worst) || now.error.worst <= best.solved.error.worst;
    if (best_stands) best = {now, problem.rows.impulse, problem.rate};
  };
  if (gave_up && !std::isnan(now.error.worst)) attempt(SolverKind::kPrimalNewton, few, false);
  if (best.solved.failed && again) attempt(second, few, entry(first).far_off);
  // friction that goes in circles comes to an end where its bounds are held
  if (best.solved.failed && again && !gave_up && first != SolverKind::kPrimalNewton)
    attempt(SolverKind::kPrimalNewton, few, false);
  if (best.solved.failed && (gave_up || few < options.max_sweeps))
    for (const SolverEntry& e : kSolvers)
      if (e.goes_on && best.solved.failed) attempt(e.kind, options.max_sweeps, false);
  // what sweeps leave may lie where the way turns in circles, and the forces of the step before do not
  if (best.solved.failed && to_the_last) attempt(last.kind, few, false);
  if (best.solved.failed && to_the_last) attempt(last.kind, few, true);
  if (!best_stands) {
    problem.rows.impulse = std::move(best.impulse);
    problem.rate = best.rate;  // not moved: views of it (Python) stay where they are
    now = best.solved;
    take(judge());
  }
  now.attempts = attempts;
  solvers.drop(second);  // what it keeps is for steps that are all its own
  return now;
}

}  // namespace talus
