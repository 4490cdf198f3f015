#pragma once
// Smooth motions of two to four rigid blocks that touch, in six families, and what a contact law answers
// along them. Whatever the law is, its forces have to follow the blocks without jumps (contact_jumps.h).

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "talus/geometry/polygon.h"

namespace talus::test {

/// How a block lies against where it was drawn.
struct PathPose {
  Vec2 displacement;  // of the centroid [m]
  double turn = 0;    // about it [rad], > 0 counter-clockwise
};

struct ContactPath {
  char family = 'a';
  std::vector<Polygon> blocks;                        // at pose zero, counter-clockwise [m]
  std::vector<Vec2> centroid;                         // [blocks]
  std::function<std::vector<PathPose>(double)> pose;  // of each block at s in [0, 1]
  double size = 1;                                    // root of the smallest block's area [m]

  /// The blocks as they lie at s.
  std::vector<Polygon> placed(double s) const;
};

inline constexpr char kPathFamilies[] = {'a', 'b', 'c', 'd', 'e', 'f'};

/// Closures are drawn log-uniformly from 1e-5 m to this [m]; blocks are of about 1 m.
inline constexpr double kDeepestClosure = 1e-2;

/// One path of a family, the same for the same seed on every machine:
///   a  a corner slides over the joint between two blocks, which rises at 15 to 90 degrees to either hand;
///      half of them with a fourth block beside the corner
///   b  the crossing of two joint sets (15 to 90 degrees) sheared along one of them
///   c  a block rocks by 0.2 rad to both sides while the area by which it overlaps its bed stays: a floor, a
///      pedestal of its own width or two blocks and their joint
///   d  sides that pass level: a block rises past another below a third, or the third slides over a step
///   e  corner on corner and tips in notches, overlapping by 1e-4 to 1e-2 m
///   f  random polygons, convex or with a notch, one perhaps cut in two, overlapping by 1e-4 to 1e-2 m
/// @param deepest  largest closure of families a, b and d [m]
ContactPath contact_path(char family, uint64_t seed, double deepest = kDeepestClosure);

// --- forces along a path. All are over the normal stiffness and per metre of thickness, [m2]: to be compared
// with areas of overlap.

struct Resultant {
  Vec2 force;
  double moment = 0;  // about the centroid, over the size of the path
};

struct PairForce {
  int a = -1, b = -1;  // a < b
  double normal = 0;   // sum of the sizes of normal forces, > 0
};

struct PathForces {
  std::vector<Resultant> normal, whole;  // [blocks] without friction and with it
  std::vector<double> load;              // [blocks] sum of the sizes of normal forces on it
  std::vector<PairForce> pairs;          // a pair may stand there more than once

  explicit PathForces(size_t blocks = 0) : normal(blocks), whole(blocks), load(blocks) {}
};

/// A contact law under test, with whatever it remembers from place to place.
class ContactForces {
 public:
  virtual ~ContactForces() = default;
  /// With the memory that this one has now: what is asked of the copy leaves this one as it is.
  virtual std::unique_ptr<ContactForces> copy() const = 0;
  /// Forces at place s of the path; they are remembered as after a step of a run.
  /// @param ds  by which the path goes on from one call to the next
  virtual PathForces at(double s, double ds) = 0;
};

}  // namespace talus::test
