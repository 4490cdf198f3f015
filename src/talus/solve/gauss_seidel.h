#pragma once
// Projected Gauss-Seidel on the rows, point by point, normal before tangential. Plain and scalar: the second
// opinion beside Newton, and the way for models too large for a factorisation. Theory: docs/theory.md 5.5.

#include "talus/model/model.h"
#include "talus/rows/rows.h"
#include "talus/solve/newton.h"

namespace talus {

/// Solves for the impulses of `set` (first guess in, solution out); arguments as solve_newton.
/// @param tolerance  contact error at which to stop [m]
/// @param dt         over which the velocities act [s]
SolveReport solve_gauss_seidel(const BlockSet& blocks, const std::vector<BlockRate>& rate, double scale,
                               const SolverInput& options, double tolerance, double dt, RowSet& set);

}  // namespace talus
