#include "talus/corners/hand_over.h"

#include <cmath>

#include "talus/base/error.h"
#include "talus/base/index.h"

namespace talus {

namespace {

// Corners closer to the end of a face than this share of its length stand in its place.
constexpr double kAtEnd = 0.01;

// Theory 13.6.
void take_from_face(const BlockSet& blocks, const BondFace& face, const FaceState& broken, Contact& c) {
  const Vec2 corner = blocks.corner(c.key.corner());
  for (size_t end = 0; end < 2; ++end) {
    const Vec2 arm = c.key.block_a == face.block_a ? face.arm_a[end] : face.arm_b[end];
    if (norm(corner - arm) > kAtEnd * face.length) continue;
    // the same number from either block: normal, tangent and motion all change their sign
    if (face.elastic_shear) {
      c.stretch = broken.offset[end];
      c.slip = std::abs(broken.slip[end]), c.slip_signed = broken.slip[end];
      c.memory = Contact::kPassed;
    } else {
      c.slip = std::abs(broken.offset[end]);
      c.slip_signed = broken.offset[end];
    }
  }
}

}  // namespace

void hand_over(const BlockSet& blocks, const BondSet& bonds, const State& state, const ContactPair& pair,
               Contact* points, size_t count) {
  TALUS_ASSERT(pair.face < 0 || state.face.size() == bonds.faces.size());
  for (size_t i = 0; i < count; ++i) {
    Contact& c = points[i];
    if (c.memory != Contact::kNone || c.touched) continue;
    if (c.partner >= 0 && points[c.partner].touched) {
      const Contact& other = points[c.partner];
      if (other.joint == c.joint) c.slip = other.slip, c.slip_signed = other.slip_signed;
    }
    if (pair.face < 0) continue;
    c.touched = true;
    for (int f = pair.face; f < count_of(bonds.faces); ++f) {
      const BondFace& face = bonds.faces[f];
      if (face.block_a != pair.a || face.block_b != pair.b) break;
      if (face.joint == c.joint && state.face[f].broken_step + 1 == state.step)
        take_from_face(blocks, face, state.face[f], c);
    }
  }
}

}  // namespace talus
