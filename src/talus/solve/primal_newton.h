#pragma once
// Semismooth Newton's method in the velocities of the blocks: impulses are an explicit function of them where
// rows give, so that the matrix has a tile for each block and pair, whatever the number of points. For large
// compressed masses with joint stiffness. Theory: docs/theory.md 5.8.

#include <memory>

#include "talus/solve/solver.h"

namespace talus {

class PrimalNewton : public Solver {
 public:
  PrimalNewton();
  ~PrimalNewton() override;
  /// Begins with some sweeps; the best impulses stay. Ends as well when three iterations in a row do not halve the
  /// residual.
  SolveReport solve(const StepProblem& problem, const SolverGoal& goal, const SolverInput& limits,
                    const Workers& workers) override;

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;  // memory of the factor
};

}  // namespace talus
