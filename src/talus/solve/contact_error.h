#pragma once
// How far impulses are from the contact law, measured apart from any solver. Theory: docs/theory.md 5.3.

#include <array>
#include <cmath>

#include "talus/base/parallel.h"
#include "talus/rows/mobility.h"
#include "talus/rows/rows.h"

namespace talus {

struct ContactError {
  double worst = 0;  // [m]
  int point = -1;    // where, index in the row set

  /// The worse of the two: the first of equals, NaN before all else.
  ContactError& operator+=(const ContactError& o) {
    if (!std::isnan(worst) && (std::isnan(o.worst) || o.worst > worst)) *this = o;
    return *this;
  }
};

/// |p - Proj(p - e / Wii)| Wii of the worse row of point i [m/s], or, when that is not more than `known`,
/// some number that is not more either: most points are passed over without their Wii. NaN when a number is
/// not finite.
/// @param u  relative velocity of the point after the impulses have acted
double point_error(const std::vector<Mobility>& mobility, const RowSet& set, size_t i,
                   const std::array<double, 2>& u, double known);

/// Largest |p - Proj(p - e / Wii)| Wii dt over all rows (eq. 5.2); NaN, with its point, when a number is not
/// finite.
/// @param rate  rates after the impulses have acted
/// @param dt    over which the velocities act [s]
ContactError contact_error(const std::vector<Mobility>& mobility, const RowSet& set,
                           const std::vector<BlockRate>& rate, double dt, const Workers& workers = Workers());

}  // namespace talus
