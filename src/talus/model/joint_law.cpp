#include "talus/model/joint_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/schema/units.h"

namespace talus {

namespace {

// Friction angle once a face has slipped or opened [rad].
double friction_after(const JointProperty& joint) {
  return std::isnan(joint.residual_friction_angle) ? joint.friction_angle : joint.residual_friction_angle;
}

JointStrength strength_of(double friction_angle, double cohesion, double tension) {
  return {friction_angle, std::tan(friction_angle), cohesion, tension};
}

}  // namespace

JointLaw::JointLaw(const JointProperty& joint)
    : bonded_(joint.bonded),
      peak_(strength_of(joint.friction_angle, joint.cohesion, joint.tensile_strength)),
      residual_(strength_of(friction_after(joint), joint.residual_cohesion, joint.residual_tensile_strength)),
      dilation_(std::tan(joint.dilation_angle)),
      dilation_slip_(joint.dilation_slip),
      stiffness_{joint.normal_stiffness, joint.shear_stiffness},
      damping_time_(joint.damping_time),
      restitution_(joint.restitution),
      worn_(joint_kinds().at(joint.kind).worn),
      own_(joint.own),
      scatters_(joint.friction_scatter.given() || joint.cohesion_scatter.given() ||
                joint.tension_scatter.given()),
      friction_scatter_(joint.friction_scatter),
      cohesion_scatter_(joint.cohesion_scatter),
      tension_scatter_(joint.tension_scatter) {
  can_break_ = !bonded_ &&
               (peak_.cohesion > 0 || peak_.tension > 0 || residual_.friction_angle < peak_.friction_angle);
}

// In proportion to the mean that the file gives: what changes and reductions leave scatters with it.
JointStrength JointLaw::scattered(int a, int b, const JointStrength& mean) const {
  JointStrength s = mean;
  if (friction_scatter_.given()) {
    s.friction *= std::tan(friction_scatter_.draw(a, b)) / std::tan(friction_scatter_.mean);
    s.friction_angle = std::atan(s.friction);
  }
  if (cohesion_scatter_.given()) s.cohesion *= cohesion_scatter_.draw(a, b) / cohesion_scatter_.mean;
  if (tension_scatter_.given()) s.tension *= tension_scatter_.draw(a, b) / tension_scatter_.mean;
  return s;
}

std::vector<JointDefect> JointLaw::defects(const JointProperty& joint) {
  std::vector<JointDefect> out;
  const JointLaw law(joint);
  if (joint.restitution >= 0 && (law.is_soft(0) || law.can_break() || joint.dilation_angle > 0))
    out.push_back({.key = "restitution",
                   .bound = "",
                   .text = "is only for hard joints without strength, weakening and dilation",
                   .hint = "leave out the stiffness, the strengths and the dilation"});
  if (joint.bonded) return out;
  if (joint.damping_time > 0 && !law.is_soft())
    out.push_back({.key = "damping_time",  // what they leave of a blow: eq. 4.1c
                   .bound = "",
                   .text = "has no meaning without a stiffness, which its dashpots stand beside",
                   .hint = "give normal_stiffness and shear_stiffness, or leave it out"});
  if (joint.friction_scatter.given() && joint.dilation_angle > 0)
    out.push_back(
        {.key = "dilation_angle",
         .bound = "",
         .text = "does not go with a friction angle that scatters: where it is low, slip would give energy",
         .hint = "leave out one of them"});

  const auto keeps = [&out](const char* key, const char* peak, double residual, double most) {
    if (residual > most)
      out.push_back({key, peak, residual, fmt::format("is larger than {}", peak),
                     fmt::format("give at most {}, or leave it out", peak)});
  };
  keeps("residual_friction_angle", "friction_angle", joint.residual_friction_angle, joint.friction_angle);
  keeps("residual_cohesion", "cohesion", joint.residual_cohesion, joint.cohesion);
  keeps("residual_tensile_strength", "tensile_strength", joint.residual_tensile_strength,
        joint.tensile_strength);

  if (joint.dilation_angle > friction_after(joint)) {
    const char* bound =
        std::isnan(joint.residual_friction_angle) ? "friction_angle" : "residual_friction_angle";
    out.push_back({"dilation_angle", bound, joint.dilation_angle,
                   fmt::format("is {}, larger than the {} of {}: slip would give energy",
                               with_unit(joint.dilation_angle, Dimension::kAngle), bound,
                               with_unit(friction_after(joint), Dimension::kAngle)),
                   "give at most that"});
  }
  if (std::isfinite(joint.dilation_slip) && joint.dilation_angle == 0)
    out.push_back({.key = "dilation_slip",
                   .bound = "",
                   .text = "has no meaning without dilation_angle",
                   .hint = "give dilation_angle, or leave it out"});
  if (const JointKind& kind = joint_kinds().at(joint.kind); kind.check) kind.check(joint, out);
  return out;
}

std::vector<JointLaw> joint_laws(const std::vector<JointProperty>& joints) {
  return {joints.begin(), joints.end()};
}

bool joints_give(const std::vector<JointLaw>& laws) {
  return std::ranges::any_of(laws, [](const JointLaw& j) { return j.is_soft(); });
}

JointProperty changed(JointProperty joint, const ChangeInput& change) {
  const auto set = [](double& value, double to) {
    if (!std::isnan(to)) value = to;
  };
  set(joint.friction_angle, change.friction_angle);
  set(joint.cohesion, change.cohesion);
  set(joint.tensile_strength, change.tensile_strength);
  return joint;
}

JointProperty reduced(const JointProperty& joint, double factor) {
  JointProperty j = joint;
  if (j.bonded) return j;
  const auto reduce = [factor](double& angle) { angle = std::atan(std::tan(angle) / factor); };
  reduce(j.friction_angle);
  if (!std::isnan(joint.residual_friction_angle)) reduce(j.residual_friction_angle);
  for (double* strength :
       {&j.cohesion, &j.tensile_strength, &j.residual_cohesion, &j.residual_tensile_strength})
    *strength /= factor;
  j.dilation_angle = std::min(joint.dilation_angle, friction_after(j));
  return j;
}

}  // namespace talus
