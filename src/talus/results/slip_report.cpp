#include "talus/results/slip_report.h"

#include <fmt/format.h>

#include <algorithm>

namespace talus {

namespace {

const std::string& block_name(const Scene& scene, int block) { return scene.blocks.name[block]; }

}  // namespace

void SlipList::add(const Scene& scene, const JointPoint& p) {
  const double least = noticeable(scene.blocks, p.block_a, p.block_b);
  if (p.face || p.slip < least) return;
  const auto [low, high] = std::minmax(p.block_a, p.block_b);
  SlippedJoint& joint = joints_[{low, high, p.set}];
  if (joint.points == 0 || p.residual_slip() > joint.most.residual_slip()) joint.most = p;
  joint.opening = std::max(joint.opening, p.opening);
  ++joint.points;
}

std::vector<SlippedJoint> SlipList::sorted() const {
  std::vector<SlippedJoint> out;
  for (const auto& [key, joint] : joints_) out.push_back(joint);
  std::stable_sort(out.begin(), out.end(), [](const SlippedJoint& a, const SlippedJoint& b) {
    return a.most.residual_slip() > b.most.residual_slip();
  });
  return out;
}

const Columns<SlipRow, Cell>& slip_columns() {
  using R = SlipRow;
  static const Columns<SlipRow, Cell> columns{
      {"stage", "", [](const R& r) { return r.stage; }},
      {"time", "s", [](const R& r) { return r.time; }},
      {"block_a", "", [](const R& r) { return block_name(r.scene, r.joint.most.block_a); }},
      {"block_b", "", [](const R& r) { return block_name(r.scene, r.joint.most.block_b); }},
      {"set", "", [](const R& r) { return r.joint.most.set; }},
      {"joint", "",
       [](const R& r) {
         const int joint = r.joint.most.joint;
         return joint < 0 ? "" : r.scene.model.joints[joint].name;
       }},
      {"x", "m", [](const R& r) { return r.joint.most.point.x; }},
      {"y", "m", [](const R& r) { return r.joint.most.point.y; }},
      {"residual_slip", "m", [](const R& r) { return r.joint.most.residual_slip(); }, Over::kLast, 9},
      {"accumulated_slip", "m", [](const R& r) { return r.joint.most.slip; }, Over::kLast, 9},
      {"slip_while_open", "m", [](const R& r) { return r.joint.most.slip_while_open(); }, Over::kLast, 9},
      {"opening", "m", [](const R& r) { return r.joint.opening; }, Over::kLast, 9},
      {"points", "", [](const R& r) { return int64_t{r.joint.points}; }},
      {"state", "", [](const R& r) { return kJointStates.at(r.joint.most.state); }}};
  return columns;
}

std::string place_text(const Scene& scene, const JointPoint& p) {
  return fmt::format("{} - {}{}, at ({:.6g}, {:.6g})", block_name(scene, p.block_a),
                     block_name(scene, p.block_b), p.set.empty() ? "" : fmt::format(", set \"{}\"", p.set),
                     p.point.x, p.point.y);
}

}  // namespace talus
