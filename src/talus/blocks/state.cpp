#include "talus/blocks/state.h"

#include "talus/base/error.h"
#include "talus/base/index.h"

namespace talus {

State::State() = default;
State::State(const State&) = default;
State::State(State&&) noexcept = default;
State& State::operator=(const State&) = default;
State& State::operator=(State&&) noexcept = default;
State::~State() = default;

namespace {

// Rotated-frame strain U - I of F = I + H with F = R U, and the rotation (cos, sin) of R. Everything is
// formed from H, so that strains far below round-off of 1 keep their digits.
struct Polar {
  double c, s;           // rotation
  double exx, eyy, exy;  // U - I
};

// Theory 1.5.
Polar polar_strain(const Mat2& H) {
  const double a = 2 + H.xx + H.yy, b = H.yx - H.xy;
  const double r = std::sqrt(a * a + b * b);
  const double c = a / r, s = b / r;
  // c - 1, each way without cancellation: small turns here, turns near half a circle there
  const double c1 = a > 0 ? -b * b / (r * (r + a)) : (a - r) / r;
  return {c, s, c1 + c * H.xx + s * H.yx, c1 + c * H.yy - s * H.xy,
          0.5 * (c * (H.xy + H.yx) + s * (H.yy - H.xx))};
}

}  // namespace

State initial_state(const BlockSet& blocks, const Layout& layout) {
  TALUS_ASSERT(count_of(layout.blocks) == blocks.count);
  State s;
  const int n = blocks.count;
  s.displacement.resize(n);
  s.strain_part.resize(n);
  s.angle.resize(n);
  s.rate.resize(n);
  s.row_force.resize(n);
  for (int i = 0; i < n; ++i) {
    if (!blocks.moves_freely(i)) continue;
    s.rate[i] = {layout.blocks[i].velocity, spin_matrix(layout.blocks[i].spin)};
  }
  return s;
}

// Eq. 1.4, 1.5.
ElasticState elastic_state(const PlaneModuli& k, const Mat2& H, const Mat2& T0) {
  const Polar p = polar_strain(H);
  const double exx = k.c11 * p.exx + k.c12 * p.eyy, eyy = k.c12 * p.exx + k.c11 * p.eyy,
               exy = 2 * k.c33 * p.exy;
  // C : (U - I) is coaxial with U, T0 need not be: without the skew part q J / tr U the stress would be no
  // derivative of an energy and P F^T no symmetric one, a torque out of nothing
  const double skew = (T0.xy * (p.exx - p.eyy) - (T0.xx - T0.yy) * p.exy) / (2 + p.exx + p.eyy);
  const double txx = T0.xx + exx, tyy = T0.yy + eyy, txy = T0.xy + exy + skew, tyx = T0.xy + exy - skew;
  ElasticState e;
  e.stress = {p.c * txx - p.s * tyx, p.c * txy - p.s * tyy, p.s * txx + p.c * tyx, p.s * txy + p.c * tyy};
  e.density =
      0.5 * (p.exx * exx + p.eyy * eyy) + p.exy * exy + T0.xx * p.exx + T0.yy * p.eyy + 2 * T0.xy * p.exy;
  e.rotation = {p.c, p.s};
  return e;
}

// Theory 2.7.
Mat2 initial_stress_for(const PlaneModuli& before, const PlaneModuli& now, const Mat2& H, const Mat2& T0) {
  const Polar p = polar_strain(H);
  const double c11 = before.c11 - now.c11, c12 = before.c12 - now.c12,
               xy = T0.xy + 2 * (before.c33 - now.c33) * p.exy;
  return {T0.xx + c11 * p.exx + c12 * p.eyy, xy, xy, T0.yy + c12 * p.exx + c11 * p.eyy};
}

Mat2 piola_stress(const PlaneModuli& k, const Mat2& H) { return elastic_state(k, H).stress; }

double strain_energy_density(const PlaneModuli& k, const Mat2& H) { return elastic_state(k, H).density; }

// Theory 1.5.
Mat2 cauchy_stress(const BlockSet& blocks, const State& state, int i) {
  if (blocks.kind[i] != BlockKind::kDeformable) return {};
  if (!state.carried_stress.empty()) return state.carried_stress[i];
  const Mat2& H = state.strain_part[i];
  const Mat2 T0 = initial_stress_of(state, i), F = kIdentity + H;
  return (1 / det(F)) * (elastic_state(blocks.moduli[i], H, T0).stress * transpose(F));
}

Mat2 rotation_minus_identity(double angle) {
  const double h = std::sin(0.5 * angle), s = std::sin(angle), c1 = -2 * h * h;
  return {c1, -s, s, c1};
}

}  // namespace talus
