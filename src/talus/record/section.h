#pragma once
// Two horizontal components to the motion along a section.

#include <vector>

namespace talus::record {

/// Acceleration along a section [m/s2]: a1 cos(A1 - S) + a2 cos(A2 - S), of two components at right angles. Longer by
/// what one of them has more is left out.
/// @param azimuth_1, azimuth_2  of the components, clockwise from north [deg]
/// @param section               azimuth of x [deg]
/// Throws InputError when the components are not at right angles to 1 deg.
std::vector<double> along_section(const std::vector<double>& a1, double azimuth_1,
                                  const std::vector<double>& a2, double azimuth_2, double section);

}  // namespace talus::record
