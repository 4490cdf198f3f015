#pragma once
// One island of rows as the system H(p) = 0 of the exact contact law, with its Jacobian.
// Theory: docs/theory.md section 5; the paper's eqs 22-30 with friction and units corrected.

#include <Eigen/Sparse>
#include <vector>

#include "talus/rows/mobility.h"
#include "talus/rows/rows.h"
#include "talus/solve/smoothing.h"

namespace talus {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Rows 2 i and 2 i + 1 are the normal and tangential row of point `point[i]` of the row set.
struct ContactProblem {
  std::vector<int> point;         // [n] indices into the row set
  std::vector<PointRows> rows;    // [n] copies, in that order
  SparseMatrix influence;         // W = H M^-1 H^T, plus the compliance on the diagonal [2n x 2n] [1/kg]
  Eigen::VectorXd velocity_free;  // e at p = 0: H v* + bias [2n] [m/s]
  Eigen::VectorXd diagonal;       // of `influence` [2n] [1/kg]

  Smoothing smoothing;

  int size() const { return static_cast<int>(2 * rows.size()); }
};

/// @param points  the island: indices into `set`
/// @param rate    v*, the rates before the rows act
ContactProblem build_problem(const std::vector<Mobility>& mobility, const RowSet& set,
                             const std::vector<int>& points, const std::vector<BlockRate>& rate);

/// H(p), in velocities: Wii (p - Proj(p - e / Wii)); equals e where p is inside its bounds. [2n] [m/s]
Eigen::VectorXd residual(const ContactProblem& problem, const Eigen::VectorXd& p);

/// What the law makes of a row at p: free inside its bounds (e = 0 is asked of it), or held at a bound.
struct RowState {
  bool free = true;
  double held_at = 0;  // the bound [N s], when not free
  double slope = 0;    // d(bound)/d(p_n): not zero for a sliding row with friction
};

std::vector<RowState> row_states(const ContactProblem& problem, const Eigen::VectorXd& p);

/// Analytic Jacobian of `residual` (one of its generalised Jacobians where it has a kink).
SparseMatrix jacobian(const ContactProblem& problem, const std::vector<RowState>& states);

/// Jacobian of `residual` of the smoothed law.
SparseMatrix jacobian_smoothed(const ContactProblem& problem, const Eigen::VectorXd& p);

/// The same by forward differences, column by column (eq. 30 of the paper). Dense; cost 2n residuals.
/// @param h  increment [N s]
Eigen::MatrixXd jacobian_by_differences(const ContactProblem& problem, const Eigen::VectorXd& p, double h);

}  // namespace talus
