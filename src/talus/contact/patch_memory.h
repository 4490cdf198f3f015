#pragma once
// What a patch takes over from the patches and faces before: memory goes by place. Theory: docs/theory.md 3.7.

#include <array>
#include <span>

#include "talus/contact/patch_world.h"

namespace talus {

/// The fields of two normals are one field while these turn by less than 60 deg.
inline constexpr double kSameWay = 0.5;

/// Memory of one pair of blocks after the other.
class PatchMemory {
 public:
  PatchMemory(const PatchWorld& world, const State& state) : w_(world), state_(state) {}

  /// @param known  its patches of the step before
  /// @param shift  of the centroid of block b, seen from that of a [m]
  void look_at(const ContactPair& pair, std::span<const Patch> known, Vec2 shift) {
    pair_ = &pair, known_ = known, shift_ = shift;
  }

  /// What the patches before remember at the place of this one: its own first, then what others of its parts and on the same
  /// sides say of places that this one has not.
  /// @param own  the one that this one continues; nullptr: none
  void recall(const Patch* own, Patch& patch) const;

  /// The middle of a known chord, seen from the centroid of block a [m].
  Vec2 middle_of(const Patch& known) const {
    return 0.5 * (carried(known, 0).place() + carried(known, 1).place());
  }

 private:
  // Where the two blocks have carried an end of a known chord: its place is half way between, somewhere between at least.
  struct Carried {
    Vec2 by_a, by_b;
    Vec2 place() const { return 0.5 * (by_a + by_b); }
  };
  // Where the ends of a chord before lie on a new one, as shares of its length, and how often it goes into that.
  struct OldChord {
    double s0, s1, per;
    OldChord(double begin, double end) : s0(begin), s1(end), per(end > begin ? 1 / (end - begin) : 0) {}
  };
  // The field of elastic slip on a new chord as it is added up: moments over the chord, and which span of it has its own
  // already, as shares of its length.
  struct Field {
    double m0 = 0, m1 = 0;
    double from = 0, to = 0;

    void add(double u, double v, const OldChord& old, const std::array<double, 2>& e);
    void take(const OldChord& old, const std::array<double, 2>& reach, const std::array<double, 2>& e);
    std::array<double, 2> ends() const { return {4 * m0 - 6 * m1, 6 * m1 - 2 * m0}; }
  };

  Carried carried(const Patch& p, size_t end) const {
    const int a = p.block_a, b = p.block_b;
    return {p.arm_a[end] + state_.strain_part[a] * p.arm_a[end],
            p.arm_b[end] + state_.strain_part[b] * p.arm_b[end] + shift_};
  }
  static void take_slip(const Patch& old, const OldChord& at, Patch& patch);
  void take_from_faces(Vec2 t, Vec2 x0, double nearest, Field& field, Patch& patch) const;
  Vec2 place_on(const BondFace& face, int end) const;

  const PatchWorld& w_;
  const State& state_;
  const ContactPair* pair_ = nullptr;
  std::span<const Patch> known_;
  Vec2 shift_;
};

}  // namespace talus
