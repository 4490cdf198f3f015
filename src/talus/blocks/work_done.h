#pragma once
// Who does work on the blocks, and how much: the ledger's list of causes. Theory: docs/theory.md section 8.

#include <array>
#include <cstddef>
#include <string_view>

#include "talus/base/index.h"

namespace talus {

/// `joints`: elastic joints, stored and lost. `boundary`: dashpots, what waves bring in, reactions that stand
/// in for static ones, ties of sides. `bolts`: of rock bolts, stored and lost. `implicit`: what
/// block-implicit elasticity adds to the elastic force of the step's beginning. Files and sums have them in
/// this order.
enum class Cause {
  kLoads,
  kSupports,
  kBoundary,
  kBonds,
  kJoints,
  kContactClosing,
  kFriction,
  kDamping,
  kBolts,
  kImplicit
};

/// Names of their work in files: "load work [J]".
inline constexpr size_t kCauses = place_of(Cause::kImplicit) + 1;
inline constexpr std::array<std::string_view, kCauses> kCauseName{
    "load",     "support", "boundary", "bond",    "joint", "contact closing",
    "friction", "damping", "bolt",     "implicit"};

/// Work done since the start, or in a kick [J]; > 0: energy given to the blocks.
struct WorkDone {
  std::array<double, kCauses> by{};

  double& operator[](Cause c) { return by[place_of(c)]; }
  double operator[](Cause c) const { return by[place_of(c)]; }
  WorkDone& operator+=(const WorkDone& o) {
    for (size_t i = 0; i < kCauses; ++i) by[i] += o.by[i];
    return *this;
  }
  double total() const {
    double sum = by[0];
    for (size_t i = 1; i < kCauses; ++i) sum += by[i];
    return sum;
  }
};

}  // namespace talus
