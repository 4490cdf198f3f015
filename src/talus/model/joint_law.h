#pragma once
// The law of a joint, the only place where properties become what it bears, how it gives and how it rises:
// who makes rows, breaks faces, reports or weakens joints asks here. Theory:
// docs/theory.md 3.4, 3.5, 4.6, 4.19.

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "talus/base/vec2.h"
#include "talus/model/model.h"
#include "talus/schema/schema.h"

namespace talus {

/// What a joint bears: a pull of `tension`, a shear of limit().
struct JointStrength {
  double friction_angle = 0;         // [rad]
  double friction = 0;               // its tangent
  double cohesion = 0, tension = 0;  // [Pa]

  /// The same over an area: forces [N]; these over a time: impulses [N s]. Friction is a ratio and stays.
  JointStrength over(double x) const { return {friction_angle, friction, cohesion * x, tension * x}; }
  /// The most shear under `normal`, > 0 pressing, in the unit of `cohesion`.
  double limit(double normal) const { return std::max(0.0, cohesion + friction * normal); }
};

/// Why properties are no law.
struct JointDefect {
  const char* key = "";    // of the joint, to be mended
  const char* bound = "";  // the key whose value is too small for it; "": none
  double least = std::numeric_limits<double>::quiet_NaN();  // what that would have to be at least [SI]
  std::string text, hint;                                   // what is wrong with `key`, and what to do
};

class JointLaw {
 public:
  JointLaw() = default;  // no joint: neither strength nor stiffness
  explicit JointLaw(const JointProperty& joint);

  /// Everything that keeps properties from being a law, none: empty. A joint loses by breaking, its rise
  /// costs no less than friction takes, and restitution goes with nothing else.
  static std::vector<JointDefect> defects(const JointProperty& joint);

  bool bonded() const { return bonded_; }
  const JointStrength& peak() const { return peak_; }          // of a face that is whole
  const JointStrength& residual() const { return residual_; }  // once it has slipped or opened
  /// Of a place where two blocks touch that are no face held together, after a slip, both ways added up
  /// [m]; of most kinds the residual one.
  JointStrength worn(double slip) const { return worn_ ? worn_(*this, slip) : residual_; }
  /// The same between blocks `a` and `b`, where strength scatters from face to face.
  JointStrength between(int a, int b, const JointStrength& mean) const {
    return scatters_ ? scattered(a, b, mean) : mean;
  }
  /// Value of key `k` of those that its kind alone has [SI].
  double own(size_t k) const { return own_.at(k); }
  /// Whether a face that touches at the start has anything to lose.
  bool can_break() const { return can_break_; }
  /// Whether it holds such a face together until then, or for good.
  bool holds() const { return bonded_ || can_break_; }

  bool dilates() const { return dilation_ != 0; }
  /// Rise after a slip of `slip`, both ways added up [m] (eq. 4.8).
  double rise(double slip) const { return dilates() ? dilation_ * std::min(slip, dilation_slip_) : 0; }

  /// Whether it has a stiffness: k = 0 normal, 1 tangential.
  bool is_soft(int k) const { return stiffness_[k] > 0; }
  bool is_soft() const { return is_soft(0) || is_soft(1); }
  /// Stiffness of an area [N/m], 0: hard. [Pa/m] without one.
  double stiffness(int k, double area = 1) const { return stiffness_[k] * area; }
  /// Time by which the force of its dashpots is that of its stiffness over the velocity [s]: they bear
  /// stiffness x damping_time x velocity.
  double damping_time() const { return damping_time_; }
  /// How far an area gives under a force [m], 0 where it is hard.
  double give(int k, double force, double area = 1) const {
    return is_soft(k) ? force / stiffness(k, area) : 0;
  }
  /// Closure and elastic slip that make it carry this stress in the reference shape [m].
  /// @param stress  tension > 0 [Pa]
  /// @param normal  of the joint, unit
  Vec2 closure(const Mat2& stress, Vec2 normal) const {
    const Vec2 traction = stress * normal;
    return {give(0, dot(normal, traction)), give(1, dot(turn_right(normal), traction))};
  }

  /// Ratio of normal velocities after and before a blow, < 0: as the scheme gives (7.1).
  double restitution() const { return restitution_; }

 private:
  bool bonded_ = false, can_break_ = false;
  JointStrength peak_, residual_;
  double dilation_ = 0, dilation_slip_ = 0;  // rise per slip; [m]
  double stiffness_[2] = {0, 0};             // [Pa/m]
  double damping_time_ = 0;                  // [s]
  double restitution_ = -1;
  JointStrength (*worn_)(const JointLaw&, double) = nullptr;
  std::vector<double> own_;
  bool scatters_ = false;
  StrengthScatter friction_scatter_, cohesion_scatter_, tension_scatter_;

  JointStrength scattered(int a, int b, const JointStrength& mean) const;
};

/// What a kind adds to the properties that all joints have.
struct JointKind {
  std::string_view name, doc;
  bool bonded = false;             // never opens or slips
  std::vector<KeySpec> keys = {};  // of its own, numbers; in the order of JointProperty::own
  /// Adds what keeps them from being a law; none: nothing does.
  void (*check)(const JointProperty& joint, std::vector<JointDefect>& out) = nullptr;
  /// JointLaw::worn; none: the residual strength.
  JointStrength (*worn)(const JointLaw& law, double slip) = nullptr;
};

/// All kinds; JointProperty::kind is an index. The first is that of joints that name none, the second is
/// bonded.
const std::vector<JointKind>& joint_kinds();
inline constexpr int kBondedJoint = 1;

/// Laws of all joints, in their order.
std::vector<JointLaw> joint_laws(const std::vector<JointProperty>& joints);

/// Whether some of them give.
bool joints_give(const std::vector<JointLaw>& laws);

/// The joint as a [[change]] leaves it.
JointProperty changed(JointProperty joint, const ChangeInput& change);

/// The joint with its strength divided by `factor`, residual strength too; dilation is not reduced, but
/// lowered to the reduced residual friction angle where it would exceed it.
JointProperty reduced(const JointProperty& joint, double factor);

}  // namespace talus
