#pragma once
// The joints that have slipped, greatest first: slips.csv and the closing lines of a run. Theory:
// docs/theory.md section 4.19.

#include <map>
#include <vector>

#include "talus/results/joint_report.h"

namespace talus {

/// The contact of two blocks along one joint, which has slipped.
struct SlippedJoint {
  JointPoint most;     // its point of the largest residual slip
  double opening = 0;  // the largest of its points [m]
  int points = 0;      // of it that have slipped
};

/// Collects points; points of the same two blocks and the same set make one joint.
class SlipList {
 public:
  /// Takes the point in, unless it has not slipped (by less than noticeable()).
  void add(const Scene& scene, const JointPoint& point);
  /// By falling residual slip; equal ones by the numbers of their blocks.
  std::vector<SlippedJoint> sorted() const;

 private:
  struct Key {
    int low, high;
    std::string set;
    auto operator<=>(const Key&) const = default;
  };
  std::map<Key, SlippedJoint> joints_;
};

/// A row of slips.csv.
struct SlipRow {
  const Scene& scene;
  const SlippedJoint& joint;
  const std::string& stage;
  double time;  // [s]
};
const Columns<SlipRow, Cell>& slip_columns();

/// "wall[0,1] - wall[0,0], set "bed", at (2, 1.5)" of a point.
std::string place_text(const Scene& scene, const JointPoint& point);

}  // namespace talus
