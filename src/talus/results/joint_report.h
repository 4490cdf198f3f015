#pragma once
// The condition of joints, point by point: for joints.csv, for the contact frames and for the summary of a
// run. Theory: docs/theory.md section 4.19.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "talus/base/index.h"
#include "talus/contact/joint_state.h"
#include "talus/output/archive.h"
#include "talus/output/contact_points.h"
#include "talus/run/instant.h"

namespace talus {

struct RunResult;

/// One point of a joint: an end of a glued face that may break, or a contact point.
struct JointPoint : FramePoint {
  bool face = false;
  std::string id;  // "face 3 end 0", "0:2 on 1:4": corner 2 of block 0 on edge 4 of block 1
  int joint = -1;
  std::string set;  // what the edge was cut along (a joint set, a fault ...); "": a block that was not cut

  double residual_slip() const { return std::abs(slip_signed); }  // what is left of it [m]
  /// What of it the two went while they were apart, which accumulated slip does not count: residual slip beyond that [m].
  double slip_while_open() const { return std::max(0.0, residual_slip() - slip); }
  bool is(JointState s) const { return state == place_of(s); }
};

/// The point of row `row`; none for supports, boundaries and bonds that never break.
std::optional<JointPoint> joint_point(const Scene& scene, const Instant& instant, size_t row);

/// Numbers by which an end of a patch is known from frame to frame: of its part of block a, with its end, and of
/// its part of block b, < -1. Of several patches of two parts each further one counts on by the parts of block a.
/// @param k  which patch
std::pair<int, int> patch_numbers(const Scene& scene, const std::vector<Patch>& patches, size_t k, int end);

/// Joint of a patch in frames: -2 where two share it.
int law_number(const Patch& patch);

/// How much further two blocks close at row `row` of an end of a patch, from this instant to where its force belongs: by the
/// weights of theory 4.6 where the joint is elastic, else the most that they come together by within the step [m].
double closing_at(const Instant& instant, size_t row);

/// Where a point of rows is now [m].
Vec2 point_now(const Scene& scene, const State& state, const PointRows& p);

/// Every point of rows at the instant, in their order: what a frame of contact points holds.
std::vector<FramePoint> frame_points(const Scene& scene, const Instant& instant);

/// Rows of the two ends of everything that two blocks share: of glued faces, and of contacts that know their
/// other end.
std::vector<std::pair<size_t, size_t>> joint_ends(const Instant& instant);

struct JointSummary {
  double time = 0;
  int points = 0, intact = 0, slipped = 0, open = 0;
  JointPoint largest;        // of the largest slip
  double widest = 0;         // [m]
  int slipped_joints = 0;    // between two blocks each, as in slips.csv
  JointPoint most_residual;  // the point with the largest slip left
  double slip_area = 0;      // sum of slip x length over points [m2]
  double broken = 0;         // length of faces that have broken [m]
  std::vector<std::pair<std::string, double>>
      broken_by_set;  // by what they were cut along, "" where by nothing [m]
  std::vector<std::pair<std::string, double>> slip_by_set,
      residual_by_set;    // the largest, accumulated and residual [m]
  double moved_area = 0;  // of blocks that have moved by a tenth of their size or more since the start [m2]
  int moved_blocks = 0;
  int moved_most = -1;     // block that has gone furthest, as share of its size; -1: none goes
  double moved_share = 0;  // that share
  int moved_far = -1;      // block that has gone furthest, in metres
  double moved_way = 0;    // that way [m]

  /// What of the instant is no matter of points: broken faces, blocks that have moved.
  void look(const Scene& scene, const State& state);
  void add(const JointPoint& p);
  /// Under names that begin with `name`.
  void save(Saver& to, const std::string& name) const;
  /// Throws FileError when it speaks of blocks or joints that the scene does not have.
  void load(Loader& from, const std::string& name, const Scene& scene);
};

/// A row of joints.csv.
struct JointRow {
  const Scene& scene;
  const JointPoint& point;
  const std::string& stage;
  double time;  // [s]
};
const Columns<JointRow, Cell>& joint_columns();

/// Name of the free-field side at which the joint with the largest slip ends; "" when it ends at none.
std::string free_field_side(const Scene& scene, const JointSummary& joints);

/// What a joint has pushed a block with that is above ten times what the model is shaken with; "" when nothing.
std::string jolt_text(const Scene& scene, const RunResult& result);

}  // namespace talus
