#pragma once
// What every solver of the contact equations is asked, and owes. Theory: docs/theory.md section 5.

#include <span>
#include <vector>

#include "talus/base/parallel.h"
#include "talus/model/model.h"
#include "talus/rows/mobility.h"
#include "talus/rows/profile.h"
#include "talus/rows/rows.h"
#include "talus/solve/report.h"
#include "talus/solve/smoothing.h"

namespace talus {

/// The rows of one step.
struct StepProblem {
  const std::vector<Mobility>& mobility;
  const std::vector<BlockRate>& rate_free;  // v*, without the rows
  double dt = 0;                            // over which the velocities act [s]
  Smoothing smoothing;                      // of the law; off: the exact one
  RowSet& rows;                             // in: first guess; out: impulses
  std::vector<BlockRate>& rate;             // out: with these impulses
  Profile& profile;                         // where the time goes
  std::span<const int> tile = {};           // of each block (BlockSet::tile); empty: all in one
  bool from_rest = false;                   // of backward Euler: v* is far off, what does not move is near
  const std::vector<BlockRate>* near = nullptr;  // of such a step: rates that may be nearer; null: none
};

/// Contact errors at which to stop [m]: `wanted`, which is given up, once `enough` is reached, after as many
/// sweeps again.
struct SolverGoal {
  double wanted = 0, enough = 0;
  bool early = false;  // just reached will do: ask the judge as soon as it is likely
  int worth = 0;       // sweeps give up where more than so many are still to be expected; 0: never
  double solved = 0;   // above `enough`: what counts as solved where no more can be had
  int turns = 0;       // factors that turns of friction may take (theory 5.8); 0: none
  double limit = 0;    // what is less may stay where it would be dear to mend [m]
  SolverGoal(double both) : wanted(both), enough(both) {}
  SolverGoal(double wanted_, double enough_, bool early_ = false)
      : wanted(wanted_), enough(enough_), early(early_) {}
};

class Solver {
 public:
  Solver() = default;
  Solver(const Solver&) = default;
  Solver(Solver&&) = default;
  Solver& operator=(const Solver&) = default;
  Solver& operator=(Solver&&) = default;
  virtual ~Solver() = default;

  /// Solves for the impulses and lets them act: same bits for any number of threads, whatever was solved
  /// before.
  /// @pre  the blocks that move are those of the call before, or this is the first (SolverSet::forget)
  /// @param limits  most iterations and sweeps, kind of the Jacobian
  virtual SolveReport solve(const StepProblem& problem, const SolverGoal& goal, const SolverInput& limits,
                            const Workers& workers) = 0;
};

}  // namespace talus
