#include "talus/contact/unpaid.h"

namespace talus {

namespace {

class HeldByJoints {
 public:
  explicit HeldByJoints(const PatchWorld& world) : w_(world) {}

  // By the forces of a step (eq. 3.4) [J].
  double by_forces(const Patch& p) const {
    if (!stores(p) || !(p.length > 0)) return 0;
    const double f = p.force[0][0], g = p.force[1][0];
    return (f * f - f * g + g * g) / stiffness(p, 0.5 * p.length);
  }

  // By its closures [J].
  double by_closures(const Patch& p) const {
    if (!stores(p) || !p.overlaps) return 0;
    const double c = p.closure[0], d = p.closure[1];
    return (c * c + c * d + d * d) * stiffness(p, p.length / 6);
  }

 private:
  // What dilates gets energy along the tangent, too.
  bool stores(const Patch& p) const {
    const auto keeps = [this](int joint) {
      if (joint < 0) return false;
      const JointLaw& law = w_.laws[joint];
      return law.is_soft(0) && !law.dilates();
    };
    return keeps(p.joint) && (p.other_share == 0 || keeps(p.other_joint));
  }

  double stiffness(const Patch& p, double length) const {
    return mixed_stiffness(w_.laws, p, 0, length * w_.blocks.thickness);
  }

  const PatchWorld& w_;
};

}  // namespace

double unpaid_energy(const PatchWorld& world, const State& then, const State& end) {
  const HeldByJoints held(world);
  double more = 0;
  for (const Patch& p : end.patches) more += held.by_closures(p);
  for (const Patch& p : then.patches) more -= held.by_forces(p);
  return more;
}

}  // namespace talus
