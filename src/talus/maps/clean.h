#pragma once
// Mends the lines of a map before they cut anything: doubles, crumbs, ends that stop short of a line or
// cross it by a little. Every change is counted. Theory: docs/theory.md section 10.6.

#include <vector>

#include "talus/geometry/polygon.h"

namespace talus::maps {

/// A line to be cleaned.
struct MapLine {
  Polyline points;     // [m]
  int source = 0;      // index of the [[map]] it came by
  int rank = 0;        // of two that lie along each other the higher stays
  bool fixed = false;  // others are joined to it, itself it stays (openings)
};

/// One thing that cleaning did.
struct Mend {
  enum Kind {
    kPoint,      // a point left out, nearer than `shortest` to the one before
    kCrumb,      // a line left out, shorter than `shortest`
    kDouble,     // a line left out, it lies along another
    kGap,        // an end brought to a line that it stopped short of
    kOvershoot,  // an end cut back to a line that it crossed
  };
  Kind kind = kPoint;
  int source = 0;
  Vec2 at;  // [m]
};

struct CleanLimits {
  double snap = 0;      // [m]
  double shortest = 0;  // [m]
  double round = 1e-6;  // [m] distance below which two points are one
};

/// Cleans `lines` in place, in their order: of two doubles the longer stays, of equal ones the first. Ends
/// are joined to the nearest line, to a point of it where one lies within `snap`; a line that another is
/// joined to gets a point there. Cost N log N for lines of similar size.
/// @return what was done, in the order in which it was
std::vector<Mend> clean_lines(std::vector<MapLine>& lines, const CleanLimits& limits);

}  // namespace talus::maps
