#pragma once
// One step of gravity on a scene at rest, as a bare contact problem: points, Jacobians and one 6 x 6 inverse
// per block, with nothing left of the geometry. Any solver can be given the same problem and its answer
// judged by the same error. Blocks deform affinely; their elasticity is implicit: (M + h^2 K) v = M v_0 + J^T
// r.

#include <Eigen/Core>
#include <vector>

#include "measures.h"
#include "scenes.h"

namespace talus::bench {

using Jacobian26 = Eigen::Matrix<double, 2, 6>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// A place where a corner meets an edge, or an end of the stretch that two edges share.
struct OneStepPoint {
  int a = 0, b = 0;    // indices into BenchScene::blocks; a owns the edge
  Vec2 point, normal;  // [m]; unit, from a to b
  Jacobian26
      jacobian_a;  // relative velocity of b against a along normal (row 0) and turn_left(normal) (row 1)
  Jacobian26 jacobian_b;  // is jacobian_a v_a + jacobian_b v_b; zero for a fixed block
};

struct OneStepProblem {
  double friction = 0;
  double dt = 0;            // [s]
  double impulse_unit = 0;  // [kg] mean mass of a moving block; the error is taken on impulses divided by it
  std::vector<OneStepPoint> points;
  std::vector<Matrix6> inverse;   // [n_blocks] (M + h^2 K)^-1, zero for fixed blocks
  std::vector<Vector6> velocity;  // [n_blocks] without contact: u, v [m/s], spin, ex, ey, gxy [1/s]
};

/// @param dt    [s] step
/// @param young [Pa] and `poisson`: elasticity of the blocks, in plane stress
OneStepProblem one_step_problem(const BenchScene& scene, double dt = 1e-3, double young = 5e9,
                                double poisson = 0.29);

/// Relative velocities [m/s] at the points, along the normal (x) and the tangent (y).
/// @param impulse [N s] on block b at each point, along the normal (x) and turn_left(normal) (y)
std::vector<Vec2> point_velocities(const OneStepProblem& problem, const std::vector<Vec2>& impulse);

/// The error by which Siconos 4.4 ends its 2D solvers (fc2d_compute_error), so that both sides of a
/// comparison stop at the same place. With z an impulse over impulse_unit and w the velocity all impulses
/// lead to, it is the norm over all points of
///   z - P(z - w - (mu |w_t|, 0)),   P the nearest point of the cone |z_t| <= mu z_n,
/// divided by the largest of the norms of z, of w and of the velocities without contact. Zero exactly where
/// the laws of contact and friction hold.
/// @note  in other units than impulse_unit the same impulses give another number
double natural_map_error(const OneStepProblem& problem, const std::vector<Vec2>& impulse);

/// The line of results of a solver that found `impulse`, all but its name, sweeps and time filled in.
BenchRow one_step_row(const BenchScene& scene, const OneStepProblem& problem,
                      const std::vector<Vec2>& impulse);

}  // namespace talus::bench
