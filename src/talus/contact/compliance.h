#pragma once
// Joints as rows: strength as bounds, stiffness as compliance by the alpha family of theory 4.6.

#include <algorithm>
#include <array>

#include "talus/model/joint_law.h"
#include "talus/rows/rows.h"
#include "talus/rows/step_clock.h"

namespace talus {

/// Bounds of a point that bears these impulses [N s].
inline void bound(const JointStrength& impulses, PointRows& p) {
  p.friction = impulses.friction;
  p.cohesion = impulses.cohesion;
  p.lower = -impulses.tension;
}

/// Turns a row whose bias is still position / dt into a compliant one (theory 4.6, eq. 4.1b).
/// @param stiffness     of the area that the point stands for [N/m]
/// @param damping_time  of its dashpots [s]
inline void make_compliant(double stiffness, double damping_time, bool in_face, const StepClock& clock,
                           double u_before, Row& row) {
  const StepClock::ElasticWeights w = clock.elastic_weights(damping_time);
  const double one = w.position / (stiffness * clock.dt * clock.dt_kick);
  row.compliance = in_face ? 2 * one : one;
  row.bias = w.position * row.bias - w.old * u_before;
}

/// Turns rows of a point, whose biases are still position / dt, into compliant ones where a stiffness is
/// given.
/// @param half_area  area of joint that the point stands for [m2]
/// @param in_face    the point ends a face whose other end is its partner: the two share the 2 x 2 compliance
///                   2/(k l t) [[2, -1], [-1, 2]] of a linear closure
/// @param u_before   relative velocity of the point half a step ago [m/s]
inline void add_compliance(const JointLaw& law, double half_area, bool in_face, const StepClock& clock,
                           const std::array<double, 2>& u_before, PointRows& p) {
  for (int i = 0; i < 2; ++i)
    if (law.is_soft(i)) make_compliant(law.stiffness(i, half_area), 0, in_face, clock, u_before[i], p.row[i]);
}

/// First guess of a compliant row (k = 0 normal, 1 tangential) of the two ends of a face: the impulses that
/// satisfy both as long as the blocks move as before the kick. What is left to the solver is the change of
/// velocities, where the impulses of the last step leave it the velocities too: less by the time step over
/// the time in which motions change.
/// @param p  the rows of the two ends, or twice those of a point alone
/// @param u  relative velocities of the ends half a step ago [m/s]
inline std::array<double, 2> guess_compliant(const std::array<const PointRows*, 2>& p, int k,
                                             const std::array<double, 2>& u) {
  const double c = p[0]->row[k].compliance, first = -(u[0] + p[0]->row[k].bias) / c,
               second = -(u[1] + p[1]->row[k].bias) / c;
  if (p[0]->partner < 0) return {first, second};
  return {4.0 / 3 * (first + 0.5 * second), 4.0 / 3 * (second + 0.5 * first)};  // cross compliance: -c / 2
}

/// The guess for both rows of the two ends (or of a point alone, given twice), within their bounds. Rows
/// without compliance keep theirs.
inline void guess_compliant(const std::array<const PointRows*, 2>& p,
                            const std::array<std::array<double, 2>, 2>& u,
                            const std::array<Impulse*, 2>& guess) {
  for (int k = 0; k < 2; ++k) {
    if (!p[0]->is_soft(k)) continue;
    const auto impulse = guess_compliant(p, k, {u[0][k], u[1][k]});
    for (size_t end = 0; end < 2; ++end) {
      const Bounds bounds = bounds_of(*p[end], k, (*guess[end])[0]);
      (*guess[end])[k] = std::clamp(impulse[end], bounds.lower, bounds.upper);
    }
  }
}

/// Elastic slip of point r of a compliant joint under the impulses of a step, along the tangent; with dashpots what their
/// velocity adds to it [m].
inline double elastic_slip(const RowSet& rows, size_t r, const StepClock& clock, double damping_time = 0) {
  const PointRows& p = rows.points[r];
  double rate = p.row[1].compliance * rows.impulse[r][1];
  if (p.partner >= 0) rate += p.cross(1) * rows.impulse[p.partner][1];
  return -rate * (p.is_soft(1) ? clock.dt / clock.elastic_weights(damping_time).position : clock.dt);
}

}  // namespace talus
