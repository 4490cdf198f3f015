#include "talus/results/slip_report.h"

#include <fmt/format.h>

#include <algorithm>

namespace talus {

namespace {

const std::string& block_name(const Scene& scene, int block) {
  return scene.blocks.name[static_cast<size_t>(block)];
}

}  // namespace

void SlipList::add(const Scene& scene, const JointPoint& p) {
  const double least =
      noticeable(scene.blocks, static_cast<size_t>(p.block_a), static_cast<size_t>(p.block_b));
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

std::string slips_header() {
  return "stage,time [s],block_a,block_b,set,joint,x [m],y [m],residual_slip [m],slip [m],opening [m],points,"
         "state\n";
}

std::string slips_row(const Scene& scene, const SlippedJoint& joint, const std::string& stage, double time) {
  const JointPoint& p = joint.most;
  const std::string property = p.joint < 0 ? "" : scene.model.joints[static_cast<size_t>(p.joint)].name;
  return fmt::format(
      "\"{}\",{:.17g},\"{}\",\"{}\",\"{}\",\"{}\",{:.17g},{:.17g},{:.9g},{:.9g},{:.9g},{},{}\n", stage, time,
      block_name(scene, p.block_a), block_name(scene, p.block_b), p.set, property, p.point.x, p.point.y,
      p.residual_slip(), p.slip, joint.opening, joint.points, state_name(p.state));
}

std::string place_text(const Scene& scene, const JointPoint& p) {
  return fmt::format("{} - {}{}, at ({:.6g}, {:.6g})", block_name(scene, p.block_a),
                     block_name(scene, p.block_b), p.set.empty() ? "" : fmt::format(", set \"{}\"", p.set),
                     p.point.x, p.point.y);
}

}  // namespace talus
