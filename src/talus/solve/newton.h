#pragma once
// Newton's method for the contact constraint equations, island by island.
// Semismooth: the Jacobian of the exact law, with a line search. Theory: docs/theory.md section 5.

#include <memory>
#include <vector>

#include "talus/solve/solver.h"

namespace talus {

/// Points that share a freely moving block, directly or through others. Each list rises; lists in order of
/// their first point.
std::vector<std::vector<int>> find_islands(const std::vector<Mobility>& mobility, const RowSet& set);

/// Keeps orderings of its factors from step to step, for islands whose pattern stays.
class Newton : public Solver {
 public:
  Newton();
  ~Newton() override;
  SolveReport solve(const StepProblem& problem, const SolverGoal& goal, const SolverInput& limits,
                    const Workers& workers) override;

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

/// The same of bare rows, for tests: solves for the impulses of `set` (first guess in, solution out),
/// which do not act.
/// @param rate       v*, rates without the rows
/// @param tolerance  residual at which to stop [m/s]
/// @param smoothing  of the law, off by default
SolveReport solve_newton(const std::vector<Mobility>& mobility, const std::vector<BlockRate>& rate,
                         const SolverInput& options, double tolerance, RowSet& set,
                         const Smoothing& smoothing = {});

}  // namespace talus
