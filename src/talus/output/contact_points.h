#pragma once
// Points at which forces act between two blocks, or on a block by what holds it: what is told of each, once.
// The frames of ParaView, joints.csv, and the report with its charts all go by the list below; a new column is
// a member and a line here, and its value in results/joint_report.cpp.

#include <array>
#include <cmath>

#include "talus/base/vec2.h"
#include "talus/output/columns.h"

namespace talus {

struct FramePoint {
  Vec2 point;                                         // [m]
  Vec2 force;                                         // on the first block [N]
  double normal_force = 0, shear_force = 0, gap = 0;  // [N] normal > 0 pressing, [N], [m]
  double length = 0;                                  // that the point stands for, 0: a corner alone [m]
  double slip = 0;                                    // of a joint, all of it to and fro [m]
  double slip_signed = 0;                             // what is left of it [m]
  double opening = 0, rise = 0;                       // of a joint [m]
  double closure = 0;  // of an end of a patch: what it bears by, the ground's part included; < 0: a gap [m]
  double closing = 0;  // how much more it is where the force belongs to (theory 4.6) [m]
  int law = -1;        // of the model's joints; -1: none, -2: two share the patch
  int kind = 0;        // index in kPointKinds
  int state = -1;      // of a joint: index in kJointStates; -1: no joint
  int block_a = -1, block_b = -1;  // -1: the ground
  // of a patch twice the part of block_a, one more for its second end, and -2 less the part of block_b; of a corner
  // on an edge the corner of block_a and the edge of block_b; else the index of the point and 0: the same
  // point has the same numbers in every frame
  int corner = 0, edge = 0;
  int partner = -1;  // index in the frame of the other end of what the two blocks share, -1: none
};

inline constexpr std::array<const char*, 5> kPointKinds{"contact", "glued face", "support", "boundary",
                                                        "bolt"};
inline constexpr std::array<const char*, 4> kJointStates{"intact", "slipped", "open", "apart"};

/// How the page of the report has a column.
enum class InPage : char { kNot, kByte, kWhole, kHalf };

struct ContactColumn : Column<FramePoint> {
  InPage page = InPage::kNot;
  bool shown = false;  // in the numbers of a point, with its history
  bool in_joints_csv = false;
  const char* older = "";               // title in frames of an older talus
  std::vector<const char*> names = {};  // of its values, where these are choices

  bool whole() const { return page == InPage::kByte || page == InPage::kWhole; }
  /// Of the array in a frame: "normal force [N]".
  std::string array() const;
};

/// In the order in which files have them; `point` and `force` come before them.
inline const std::vector<ContactColumn>& contact_columns() {
  constexpr bool kShown = true, kInJoints = true;
  using P = FramePoint;
  const auto number = [](const char* name, const char* unit, double P::*member, InPage page, bool shown,
                         bool in_joints, const char* older = "") {
    return ContactColumn{{name, unit, [member](const P& p) { return p.*member; }, Over::kLast, 9},
                         page,
                         shown,
                         in_joints,
                         older,
                         {}};
  };
  const auto whole = [](const char* name, int P::*member, InPage page, std::vector<const char*> names = {}) {
    return ContactColumn{{name, "", [member](const P& p) { return static_cast<double>(p.*member); }},
                         page,
                         false,
                         false,
                         "",
                         std::move(names)};
  };
  static const std::vector<ContactColumn> columns{
      number("length", "m", &P::length, InPage::kNot, false, kInJoints),
      number("normal_force", "N", &P::normal_force, InPage::kHalf, kShown, kInJoints),
      number("shear_force", "N", &P::shear_force, InPage::kHalf, kShown, kInJoints),
      number("gap", "m", &P::gap, InPage::kNot, false, false),
      number("accumulated_slip", "m", &P::slip, InPage::kHalf, kShown, kInJoints, "slip [m]"),
      number("residual_slip", "m", &P::slip_signed, InPage::kHalf, kShown, kInJoints),
      number("opening", "m", &P::opening, InPage::kHalf, kShown, kInJoints),
      number("dilation", "m", &P::rise, InPage::kNot, false, kInJoints),
      number("closure", "m", &P::closure, InPage::kNot, false, false),
      number("closing", "m", &P::closing, InPage::kNot, false, false),
      {{"joint", "", [](const P& p) { return static_cast<double>(p.law); }}},
      whole("kind", &P::kind, InPage::kByte, {kPointKinds.begin(), kPointKinds.end()}),
      whole("state", &P::state, InPage::kByte, {kJointStates.begin(), kJointStates.end()}),
      whole("block_a", &P::block_a, InPage::kWhole),
      whole("block_b", &P::block_b, InPage::kWhole),
      whole("corner", &P::corner, InPage::kWhole),
      whole("edge", &P::edge, InPage::kWhole),
      whole("partner", &P::partner, InPage::kWhole)};
  return columns;
}

/// A frame of points for ParaView.
std::string contacts_vtp(const std::vector<FramePoint>& points, double time);

}  // namespace talus
