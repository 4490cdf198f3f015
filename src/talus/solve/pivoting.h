#pragma once
// Lemke's method in the rows of an island: the solution of a neighbouring problem is followed, from one set of
// open, sticking and sliding points to the next, to that of the step. Dense; for the few steps that nothing else
// solves. Theory: docs/theory.md 5.10.

#include "talus/solve/solver.h"

namespace talus {

/// Rows of one island that may reach a bound, two of a contact with friction: three dense matrices of them squared are
/// kept (25 MB), and a change of one row passes over them (some 3 ms; hundreds of changes are usual).
inline constexpr size_t kMostPivotRows = 1000;

/// The same where what is left may stay as it is (SolverGoal::limit): some 20 ms.
inline constexpr size_t kMostPivotRowsLoose = 200;

class Pivoting : public Solver {
 public:
  /// Solves the islands whose error is more than enough; those with more rows than kMostPivotRows stay as they are, as do
  /// those that it does not bring nearer.
  SolveReport solve(const StepProblem& problem, const SolverGoal& goal, const SolverInput& limits,
                    const Workers& workers) override;
};

}  // namespace talus
