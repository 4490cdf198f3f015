#include "talus/contact/patch_memory.h"

#include <algorithm>
#include <cmath>

#include "talus/base/index.h"

namespace talus {

// A piece [u, v] of a linear field that is e0 at s0 and e1 at s1.
void PatchMemory::Field::add(double u, double v, const OldChord& old, const std::array<double, 2>& e) {
  if (!(v > u)) return;
  const double slope = (e[1] - e[0]) * old.per, eu = e[0] + (u - old.s0) * slope,
               ev = e[0] + (v - old.s0) * slope;
  m0 += (v - u) * 0.5 * (eu + ev), m1 += (v - u) * (u * (2 * eu + ev) + v * (eu + 2 * ev)) / 6;
}

// All of it within the chord that no field before it has.
void PatchMemory::Field::take(const OldChord& old, const std::array<double, 2>& reach,
                              const std::array<double, 2>& e) {
  const double u = std::max(old.s0 - reach[0], 0.0), v = std::min(old.s1 + reach[1], 1.0);
  if (!(v > u)) return;
  if (!(to > from)) return from = u, to = v, add(u, v, old, e);
  add(u, std::min(v, from), old, e), add(std::max(u, to), v, old, e);
  from = std::min(from, u), to = std::max(to, v);
}

void PatchMemory::recall(const Patch* own, Patch& patch) const {
  const int a = patch.block_a;
  const Vec2 t = turn_right(patch.normal);
  const Vec2 x0 = patch.arm_a[0] + state_.strain_part[a] * patch.arm_a[0];
  Field field;
  double nearest = -1;
  const double share = 1 / patch.length;
  const auto take = [&](const Patch& old) {
    if (dot(old.normal, patch.normal) < kSameWay) return;
    const Carried one = carried(old, 0), two = carried(old, 1);
    const OldChord at(share * dot(t, one.place() - x0), share * dot(t, two.place() - x0));
    patch.touched = patch.touched || old.touched;
    if (const double common = std::min(at.s1, 1.0) - std::max(at.s0, 0.0); &old == own || common > nearest)
      nearest = &old == own ? 1 : common, take_slip(old, at, patch);
    const auto slid = [&](const Carried& c) { return 0.5 * share * std::abs(dot(t, c.by_a - c.by_b)); };
    field.take(at, {slid(one), slid(two)}, old.stretch);
  };
  if (own) take(*own);
  for (const Patch& old : known_)
    if (&old != own && ((old.part_a == patch.part_a && old.part_b == patch.part_b) ||
                        (old.side_a == patch.side_a && old.side_b == patch.side_b)))
      take(old);
  if (pair_->face >= 0) take_from_faces(t, x0, nearest, field, patch);
  patch.stretch = field.ends();
  if (own) {
    patch.force = own->force, patch.root_kept = own->root_kept;
    // what has come out of an overlap does not go in again, be it by a turn
    for (size_t end = 0; end < 2; ++end)
      patch.allowed[end] = std::max(0.0, std::min(own->allowed[end], patch.closure[end]));
  }
}

// Slip is of all of a joint: beyond the ends of the old chord it is that of the end.
void PatchMemory::take_slip(const Patch& old, const OldChord& at, Patch& patch) {
  for (size_t end = 0; end < 2; ++end) {
    const double z = std::min(std::max((static_cast<double>(end) - at.s0) * at.per, 0.0), 1.0);
    patch.slip[end] = (1 - z) * old.slip[0] + z * old.slip[1];
    patch.slip_signed[end] = (1 - z) * old.slip_signed[0] + z * old.slip_signed[1];
  }
}

// A face on the same sides that broke in the step before hands over what it has slipped, and the shear of an elastic
// one, at the places that no patch before has had.
void PatchMemory::take_from_faces(Vec2 t, Vec2 x0, double nearest, Field& field, Patch& patch) const {
  for (int f = pair_->face; f < count_of(w_.bonds.faces); ++f) {
    const BondFace& face = w_.bonds.faces[f];
    if (face.block_a != pair_->a || face.block_b != pair_->b) break;
    const FaceState& broken = state_.face[f];
    if (!broken.broken || face.edge_a != patch.side_a || face.edge_b != patch.side_b) continue;
    patch.touched = true;
    if (broken.broken_step + 1 != state_.step) continue;
    Patch as_patch = patch;
    // along the tangent: from b's normal turned clockwise the face runs the other way
    const bool forward = dot(t, place_on(face, 1) - place_on(face, 0)) > 0;
    for (size_t end = 0; end < 2; ++end) {
      const size_t from = forward ? end : 1 - end;
      const double gone = face.elastic_shear ? broken.slip[from] : broken.offset[from];
      as_patch.stretch[end] = face.elastic_shear ? broken.offset[from] : 0;
      as_patch.slip[end] = std::abs(gone), as_patch.slip_signed[end] = gone;
    }
    const OldChord at(dot(t, place_on(face, forward ? 0 : 1) - x0) / patch.length,
                      dot(t, place_on(face, forward ? 1 : 0) - x0) / patch.length);
    if (nearest <= 0) take_slip(as_patch, at, patch);
    if (face.elastic_shear) field.take(at, {0, 0}, as_patch.stretch);
  }
}

Vec2 PatchMemory::place_on(const BondFace& face, int end) const {
  return face.arm_a[end] + state_.strain_part[face.block_a] * face.arm_a[end];
}

}  // namespace talus
