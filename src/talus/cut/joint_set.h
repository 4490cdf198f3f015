#pragma once
// Lines of one joint set: parallel, scattered, through-going or in traces with gaps. Theory:
// docs/theory.md 10.1.

#include <string>
#include <utility>
#include <vector>

#include "talus/model/model.h"

namespace talus {

/// What became of a joint set, for the report.
struct JointSetNote {
  std::string name;
  double angle = 0;  // mean, of the traces in the section [rad]
  bool in_space = false;
  double apparent_dip = 0;  // [rad] > 0: down towards +x
  double widening = 1;      // spacing of the traces over that of the planes
  double spacing = 0;       // mean, of the traces in the section [m]
  int traces = 0;
  double length = 0;  // in the regions [m]
};

/// Direction of a joint plane's trace in the section [rad], counter-clockwise from +x, and how much wider
/// than the plane's the spacing of its traces is: angle = -atan(tan dip cos(dip_direction -
/// section_azimuth)).
struct ApparentDip {
  double angle = 0;
  double widening = 1;  // infinite when the plane is parallel to the section
};
ApparentDip apparent_dip(double dip, double dip_direction, double section_azimuth);

/// Mean direction and spacing of the set in the section.
JointSetNote describe(const JointSetInput& set, double section_azimuth);

/// Why the set cannot be drawn over `box`, and where the reason stands in the file; no text when it can.
struct JointSetDefect {
  std::string key, text;
  Where where;
};
JointSetDefect joint_set_defect(const JointSetInput& set, const JointSetNote& note, const Box& box);

/// The lines that may cross `box`, ends and all. A line keeps its place when the box grows.
/// @pre joint_set_defect() has no text
std::vector<std::pair<Vec2, Vec2>> joint_set_lines(const JointSetInput& set, const JointSetNote& note,
                                                   const CutInput& cut, const Box& box);

}  // namespace talus
