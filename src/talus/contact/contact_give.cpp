#include "talus/contact/contact_give.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/blocks/given_motion.h"
#include "talus/blocks/in_situ.h"

namespace talus {

namespace {

// Strain of rock under a stress that is foreseen whatever the loads: arches and beams of blocks press on their corners with
// many times what weighs on a level joint, and there contacts give a hundredth of what the blocks do.
constexpr double kRockStrain = 2e-3;

double largest(const Signal& s, const Model& model) {
  if (s.history < 0) return std::abs(s.factor);
  double most = 0;
  for (const double v : model.histories[s.history].value) most = std::max(most, std::abs(s.factor * v));
  return most;
}

double largest(int history, const Model& model) {
  return history < 0 ? 0 : largest(Signal{history, 1}, model);
}

// Larger principal stress, of either sign.
double principal(const Mat2& s) {
  return std::abs(0.5 * (s.xx + s.yy)) + std::hypot(0.5 * (s.xx - s.yy), 0.5 * (s.xy + s.yx));
}

// Of what is there from the start: densest and fastest rock, extent of the blocks, their middle size.
struct Extent {
  double density = 0;        // largest [kg/m3]
  double impedance = 0;      // largest rho cp, of deformable blocks [Pa s/m]
  double stiffness = 0;      // largest modulus of those in uniaxial strain [Pa]
  double along_gravity = 0;  // [m]
  double widest = 0;         // diagonal of the box around the blocks [m]
  double size = 0;           // of the median block [m]
};

Extent extent_of(const Model& model, const BlockSet& blocks) {
  Extent e;
  const double g = norm(model.gravity), all = std::numeric_limits<double>::infinity();
  const Vec2 down = g > 0 ? model.gravity / g : Vec2{0, 1};
  double highest = all, deepest = -all;
  Vec2 low{all, all}, high{-all, -all};
  std::vector<double> sizes;
  for (int i = 0; i < blocks.count; ++i) {
    if (!blocks.moves_freely(i)) continue;
    const double density = blocks.mass[i] / blocks.volume[i];
    e.density = std::max(e.density, density);
    if (blocks.kind[i] == BlockKind::kDeformable) {
      e.impedance = std::max(e.impedance, std::sqrt(density * blocks.moduli[i].c11));
      e.stiffness = std::max(e.stiffness, blocks.moduli[i].c11);
    }
    sizes.push_back(blocks.size[i]);
    for (int v = 0; v < blocks.vertex_count(i); ++v) {
      const Vec2 x = blocks.centroid[i] + blocks.corner({i, v});
      highest = std::min(highest, dot(x, down)), deepest = std::max(deepest, dot(x, down));
      low = {std::min(low.x, x.x), std::min(low.y, x.y)};
      high = {std::max(high.x, x.x), std::max(high.y, x.y)};
    }
  }
  if (sizes.empty()) return e;
  e.along_gravity = deepest - highest, e.widest = norm(high - low);
  const auto middle = sizes.begin() + (sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  e.size = *middle;
  return e;
}

}  // namespace

// Eq. 4.11.
double ContactGive::per_force(double thickness) const {
  // kn = ks = stress / (kGiveClosure length) on half of that length: no length is left
  return stress > 0 ? 2 * kGiveClosure / (stress * thickness) : 0;
}

RowGive::RowGive(const ContactGive& give, const BlockSet& blocks, const StepClock& clock) : blocks_(blocks) {
  const double one = clock.dt * clock.dt_kick;
  const double shortest =
      give.shortest_step > 0 ? give.shortest_step * give.shortest_step : clock.dt * clock.dt;
  give_ = give.per_force(blocks.thickness) / one, per_yield_ = shortest / one / kLeastYield;
}

double RowGive::between(int a, int b) const {
  if (give_ == 0) return 0;
  double yield = 0;  // about what two blocks yield at a corner, together [1/kg]
  for (const int block : {a, b})
    if (blocks_.moves_freely(block)) yield += kYield / blocks_.mass[block];
  return std::min(give_, per_yield_ * yield);
}

ContactGive contact_give(const Model& model, const Layout& layout, const BlockSet& blocks) {
  ContactGive give;
  if (model.contact.law != ContactLaw::kExact || !model.contact.give) return give;
  const auto take = [&give](double stress, const char* cause) {
    if (stress > give.stress) give = {stress, cause};
  };
  const Extent e = extent_of(model, blocks);
  take(e.density * norm(model.gravity) * e.along_gravity, "weight of the blocks");
  take(kRockStrain * e.stiffness, "stiffness of the blocks");
  for (const Mat2& stress : initial_stresses(model, blocks)) take(principal(stress), "stress of the ground");
  for (const LoadInput& load : model.loads) {
    const double along_axes = std::hypot(largest(load.x, model), largest(load.y, model));
    if (load.kind == LoadKind::kAcceleration)
      take(e.density * along_axes * e.widest, "accelerations given");
    else if (load.kind == LoadKind::kForce)
      take(e.size > 0 ? along_axes / (e.size * blocks.thickness) : 0, "forces given");
    else
      take(std::max(along_axes, largest(load.pressure, model)), "pressures and tractions given");
  }
  double fastest = fastest_given(model, layout, blocks);
  for (const BoundaryInput& b : model.boundaries)
    fastest = std::max(fastest, std::hypot(largest(b.history_x, model), largest(b.history_y, model)));
  take(e.impedance * fastest, "velocities given");
  return give;
}

bool meets_hard(const Layout& layout, const std::vector<JointLaw>& laws) {
  const auto hard = [&](int joint) {
    return joint < 0 || (!laws[joint].bonded() && !(laws[joint].is_soft(0) && laws[joint].is_soft(1)));
  };
  if (layout.blocks.size() < 2) return false;
  if (hard(layout.default_joint)) return true;
  for (const auto& [pair, joint] : layout.pair_joint)
    if (hard(joint)) return true;
  return std::ranges::any_of(layout.blocks, [&](const BlockShape& b) {
    return std::ranges::any_of(b.edge_joint, [&](int joint) { return joint >= 0 && hard(joint); });
  });
}

}  // namespace talus
