#pragma once
// Jumps of contact forces along a path, forces without overlap and overlaps without force.

#include "support/contact_paths.h"

namespace talus::test {

struct JumpSearch {
  int steps = 1200;      // of the walk along the whole path
  double normal = 1e-4;  // least jump of normal forces that counts, as share of the path's load
  double whole = 1e-2;   // the same of all forces, friction included
};

/// A change of a block's resultant that does not become smaller when the steps do.
struct Jump {
  double size = 0;  // over the path's load; 0: there is none
  double at = 0;    // s
};

/// What stands out along one path.
struct PathFindings {
  double load = 0;  // mean over the walk of the largest load on a block [m2]; 0: nothing touched
  Jump normal, whole;
  int looked_at = 0;         // pairs of blocks, at every fourth step, that bear a force or overlap
  int without_overlap = 0;   // of these: force above 1e-2 of the load, overlap below 1e-3
  int without_force = 0;     // overlap above 5e-2 of the load, force below 1e-3
  double force_by_area = 0;  // median of force over area of those with overlaps above 5e-2 of the load
};

/// Walks a path from s = 0 to 1 and looks again, from memory as it was there, at the steps in which
/// resultants change most out of line with the steps beside: eight steps for one, five times or more, each
/// time within the worst of them. What then still changes as much as before is a jump. Where the path itself
/// jumps there is none. Cost: up to 64 such places, 40 to 72 calls each.
PathFindings walk(const ContactPath& path, const ContactForces& law, const JumpSearch& search = {});

}  // namespace talus::test
