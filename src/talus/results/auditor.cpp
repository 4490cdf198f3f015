#include "talus/results/auditor.h"

#include <algorithm>
#include <cmath>

#include "talus/audit/check_frame.h"
#include "talus/audit/read_results.h"
#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/blocks/in_situ.h"
#include "talus/model/joint_law.h"
#include "talus/results/joint_report.h"

namespace talus {

namespace {

// From the properties, not by JointLaw: what judges the rows shares no law with them. fmax: NaN is none.
// Of strength that scatters the largest that a face can have.
audit::Law law_of(const JointProperty& joint) {
  const auto larger = [](const StrengthScatter& s) { return s.given() ? s.largest() / s.mean : 1; };
  const StrengthScatter& angle = joint.friction_scatter;
  const double rougher = angle.given() ? std::tan(angle.largest()) / std::tan(angle.mean) : 1;
  return {.friction = rougher * std::tan(std::fmax(joint.friction_angle, joint.residual_friction_angle)),
          .cohesion = larger(joint.cohesion_scatter) * std::max(joint.cohesion, joint.residual_cohesion),
          .tension = larger(joint.tension_scatter) *
                     std::max(joint.tensile_strength, joint.residual_tensile_strength),
          .normal_stiffness = joint.normal_stiffness,
          .bonded = joint.bonded,
          .dilates = joint.dilation_angle > 0};
}

audit::Hold hold_of(const BlockSet& blocks, int i) {
  return blocks.removed(i)        ? audit::Hold::kRemoved
         : blocks.moves_freely(i) ? audit::Hold::kFree
                                  : audit::Hold::kPrescribed;
}

// What of a joint's closure the stress of the ground has made, so that no gap shows it [m].
double closed_by_ground(const Scene& scene, const ContactPair& pair, const Contact& c) {
  const Model& model = scene.model;
  if (!model.in_situ.given || c.joint < 0 || !(pair.shares_face || (pair.from_start && c.length > 0)))
    return 0;
  const int b = c.key.block_b;
  const int next = c.key.edge + 1 == scene.blocks.vertex_count(c.key.block_b) ? 0 : c.key.edge + 1;
  const Vec2 from = scene.blocks.corner({c.key.block_b, c.key.edge}),
             side = scene.blocks.corner({c.key.block_b, next}) - from;
  const Mat2 stress = in_situ_stress(model.in_situ, model.gravity, scene.blocks.centroid[b].y + from.y);
  const JointLaw law(model.joints[c.joint]);
  return std::abs(law.closure(stress, turn_right(side) / norm(side)).x);
}

}  // namespace

Auditor::Auditor(const Scene& scene) : scene_(scene), watch_(rules_) {
  rules_.names = scene.blocks.name;
  rules_.thickness = scene.model.thickness;
}

void Auditor::at(const Instant& i, bool frame) {
  if (fresh_ || i.stage_start) look_at_stage(i);
  ++steps_;
  if (i.report.loose) {
    if (loose_++ == 0) first_loose_ = i.state.time;
    loosest_ = std::max(loosest_, i.report.error.worst);
    rules_.tolerance = std::max(rules_.tolerance, loosest_);
  }
  watch(i);
  if (i.report.failed && failed_++ == 0) first_failed_ = i.state.time, worst_failed_ = i.report.worst;
  const Energy& e = i.report.energy;
  largest_energy_ = std::max(largest_energy_, e.largest());
  if (e.work[Cause::kContactClosing] > closing_)
    closing_ = e.work[Cause::kContactClosing], closing_friction_ = e.work[Cause::kFriction],
    closing_time_ = i.state.time;
  // of a blow dashpots and stiffness share the work to the first order in the step only: neither is judged alone
  if (const double joints = e.work[Cause::kJoints] + e.work[Cause::kDamping]; joints > joints_)
    joints_ = joints, joints_friction_ = e.work[Cause::kFriction], joints_time_ = i.state.time;

  const double interval = scene_.model.output.audit_interval;
  bool due = frame;
  if (interval > 0) {
    const bool reached = i.state.time >= next_ - 1e-6 * i.advance;
    if (reached) next_ = (std::floor((i.state.time + 1e-6 * i.advance) / interval) + 1) * interval;
    due = reached || i.stage_start || i.last;
  }
  if (due) audit::add_frame(rules_, frame_of(i), i.work.workers, report_);
}

audit::Report Auditor::report() const {
  audit::Report out = report_;
  audit::add_closing(closing_, closing_friction_, largest_energy_, lifting_, closing_time_, out);
  audit::add_joint_work(rules_, joints_, joints_friction_, largest_energy_, lifting_, joints_time_, out);
  audit::add_failed(failed_, first_failed_, worst_failed_, out);
  audit::add_loose(loose_, steps_, first_loose_, loosest_, out);
  return out;
}

void Auditor::look_at_stage(const Instant& i) {
  const BlockSet& b = scene_.blocks;
  rules_.laws.clear();
  for (const JointProperty& joint : scene_.model.joints) {
    rules_.laws.push_back(law_of(joint));
    lifting_ = lifting_ || joint.dilation_angle > 0;
  }
  rules_.joints_everywhere = scene_.layout.default_joint >= 0;
  rules_.in_situ = scene_.model.in_situ.given, rules_.changes = !scene_.model.changes.empty();
  rules_.slop = scene_.model.contact.slop;
  rules_.give = scene_.give.per_force(scene_.model.thickness);
  rules_.tolerance = std::max(scene_.model.solver.tolerance * tolerance_size(b), loosest_);
  blocks_.clear();
  for (int k = 0; k < b.count; ++k) {
    const double area = b.volume[k] / b.thickness;
    blocks_.push_back({b.size[k], b.radius[k], area / (2 * b.radius[k]), hold_of(b, k)});
  }
  if (i.stage_start) watch_.forget();
  fresh_ = false;
}

void Auditor::watch(const Instant& i) {
  const State& state = i.state;
  points_.clear();
  points_.reserve(state.contacts.size() + 2 * state.patches.size());
  for (size_t k = 0; k < state.patches.size(); ++k) {
    const Patch& c = state.patches[k];
    const bool hard = c.joint < 0 || scene_.model.joints[c.joint].normal_stiffness == 0;
    for (int end = 0; end < 2; ++end) {
      const auto [corner, edge] = patch_numbers(scene_, state.patches, k, end);
      points_.push_back(
          {c.block_a, corner, c.block_b, edge, c.force[end][0], c.gap[end], hard, place_of(state, c, end),
           c.normal,
           hard ? 0 : i.work.clock.dashpot_time(mixed_damping_time(scene_.blocks, scene_.laws, c, 0))});
    }
  }
  for (size_t k = 0; k < state.contacts.size(); ++k) {
    const Contact& c = state.contacts[k];
    const bool hard = c.joint < 0 || scene_.model.joints[c.joint].normal_stiffness == 0;
    points_.push_back(
        {c.key.block_a, c.key.vertex, c.key.block_b, c.key.edge, c.force[0], i.work.gaps[k], hard});
  }
  centroid_.resize(blocks_.size());
  for (size_t k = 0; k < centroid_.size(); ++k)
    centroid_[k] = scene_.blocks.centroid[k] + state.displacement[k];
  watch_.look(
      {state.time, i.work.clock.dt, points_, centroid_, blocks_, [&](int block) { return shape(i, block); }},
      report_);
}

Vec2 Auditor::place_of(const State& state, const Patch& c, int end) const {
  const int a = c.block_a;
  return scene_.blocks.centroid[a] + offset_now(state, a, c.arm_a[end]);
}

audit::Point Auditor::patch_point(const Instant& i, size_t patch, int end) const {
  const Patch& c = i.state.patches[patch];
  audit::Point p;
  const auto [corner, edge] = patch_numbers(scene_, i.state.patches, patch, end);
  p.block_a = c.block_a, p.block_b = c.block_b, p.corner = corner, p.edge = edge;
  p.place = place_of(i.state, c, end), p.normal = c.normal, p.gap = c.gap[end];
  p.normal_force = c.force[end][0], p.shear_force = c.force[end][1];
  p.joint = law_number(c);
  if (c.joint >= 0) {
    const JointProperty& joint = scene_.model.joints[c.joint];  // as law_of
    p.rise = std::tan(joint.dilation_angle) * std::min(c.slip[end], joint.dilation_slip);
  }
  p.in_situ = std::max(0.0, c.closure[end] + c.gap[end]);
  p.closing = closing_at(i, i.work.rows.range(Family::kContact).begin + 2 * patch + end);
  return p;
}

audit::Block Auditor::shape(const Instant& i, int block) const {
  const BlockSet& b = scene_.blocks;
  audit::Block out;
  out.hold = hold_of(b, block);
  if (out.hold == audit::Hold::kRemoved) return out;
  const BlockRate rate = rate_now(i.work, i.state, block);
  for (int v = 0; v < b.vertex_count(block); ++v) {
    const Vec2 X = b.corner({block, v});
    out.polygon.push_back(b.centroid[block] + offset_now(i.state, block, X));
    const Vec2 arm = acting_arm(b, i.state, block, X);
    out.velocity.push_back(velocity_at(rate, arm));
    out.next.push_back(velocity_at(i.state.rate[block], arm));
  }
  return out;
}

audit::Frame Auditor::frame_of(const Instant& i) const {
  audit::Frame frame;
  frame.time = i.state.time, frame.step = i.work.clock.dt;
  for (int k = 0; k < scene_.blocks.count; ++k) frame.blocks.push_back(shape(i, k));
  const size_t bonds = i.work.rows.range(Family::kFace).end;
  for (size_t r = 0; r < bonds; ++r) {  // the first family
    const PointRows& row = i.work.rows.points[r];
    const BondFace& face = scene_.bonds.faces[i.work.rows.owner[r].at() / 2];
    audit::Point p;
    p.block_a = face.block_a, p.block_b = face.block_b, p.joint = face.joint;
    p.place = point_now(scene_, i.state, row);
    p.normal_force = i.work.rows.impulse[r][0] / i.work.clock.dt_kick;
    p.shear_force = i.work.rows.impulse[r][1] / i.work.clock.dt_kick;
    p.partner = static_cast<int>(r % 2 == 0 ? r + 1 : r - 1);
    frame.points.push_back(p);
  }
  for (size_t k = 0; k < i.state.patches.size(); ++k)
    for (int end = 0; end < 2; ++end) {
      frame.points.push_back(patch_point(i, k, end));
      frame.points.back().partner = count_of(frame.points) - (end == 0 ? 0 : 2);
    }
  for (const ContactPair& pair : i.state.pairs) {
    for (int n = 0; n < pair.count && i.state.patches.empty(); ++n) {
      const int k = pair.begin + n;
      const Contact& c = i.state.contacts[k];
      audit::Point p;
      p.block_a = c.key.block_a, p.corner = c.key.vertex, p.block_b = c.key.block_b, p.edge = c.key.edge;
      p.gap = i.work.gaps[k];
      p.normal_force = c.force[0], p.shear_force = c.force[1];
      p.joint = c.joint < 0 ? audit::kNoJoint : c.joint;
      if (c.joint >= 0) {
        const JointProperty& joint = scene_.model.joints[c.joint];  // as law_of
        p.rise = std::tan(joint.dilation_angle) * std::min(c.slip, joint.dilation_slip);
      }
      p.in_situ = closed_by_ground(scene_, pair, c);
      if (c.partner >= 0) p.partner = static_cast<int>(bonds) + pair.begin + c.partner;
      frame.points.push_back(p);
    }
  }
  return frame;
}

template <class X, class Self>
void Auditor::exchange(X& x, Self& self) {
  x("audit.next", self.next_), x("audit.failed", self.failed_);
  x("audit.first_failed", self.first_failed_), x("audit.worst_failed", self.worst_failed_);
  x("audit.steps", self.steps_), x("audit.loose", self.loose_);
  x("audit.first_loose", self.first_loose_), x("audit.loosest", self.loosest_);
  x("audit.lifting", self.lifting_), x("audit.closing", self.closing_);
  x("audit.closing_friction", self.closing_friction_), x("audit.closing_time", self.closing_time_);
  x("audit.joints", self.joints_), x("audit.joints_friction", self.joints_friction_);
  x("audit.joints_time", self.joints_time_);
  x("audit.largest_energy", self.largest_energy_);
}

void Auditor::save(Saver& to) const {
  report_.save(to, "audit.report");
  watch_.save(to, "audit.watch");
  exchange(to, *this);
}

void Auditor::load(Loader& from) {
  report_.load(from, "audit.report");
  watch_.load(from, "audit.watch");
  exchange(from, *this);
  std::vector<int> corners;
  for (int i = 0; i < scene_.blocks.count; ++i) corners.push_back(scene_.blocks.vertex_count(i));
  if (!report_.fits(scene_.blocks.count) || !watch_.fits(corners))
    throw FileError("the audit of the saved state speaks of blocks or corners that there are not");
}

}  // namespace talus
