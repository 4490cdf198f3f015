#pragma once
// Whose rows they are: all that step, observers and messages ask a row for. Solvers never do.

#include <array>
#include <cstddef>

#include "talus/base/index.h"
#include "talus/blocks/work_done.h"

namespace talus {

/// Families of rows, in the order in which they stand in a set.
enum class Family { kFace, kContact, kSupport, kBoundary, kTie, kBolt };
inline constexpr std::array kAllFamilies{Family::kFace,     Family::kContact, Family::kSupport,
                                         Family::kBoundary, Family::kTie,     Family::kBolt};

struct FamilyEntry {
  Family family;
  const char* name;            // as messages begin
  std::array<Cause, 2> cause;  // of the work of rows that do not give: normal, tangential
};

/// A new family is a line here.
inline constexpr std::array<FamilyEntry, kAllFamilies.size()> kFamilies{
    {{Family::kFace, "joint", {Cause::kBonds, Cause::kBonds}},
     {Family::kContact, "contact", {Cause::kContactClosing, Cause::kFriction}},
     {Family::kSupport, "support", {Cause::kSupports, Cause::kSupports}},
     {Family::kBoundary, "boundary", {Cause::kBoundary, Cause::kBoundary}},
     {Family::kTie, "boundary", {Cause::kBoundary, Cause::kBoundary}},
     {Family::kBolt, "bolt", {Cause::kBolts, Cause::kBolts}}}};

inline constexpr const FamilyEntry& entry(Family f) { return kFamilies[place_of(f)]; }

/// Whether two faces of blocks meet there: an intact face or a contact. Only these may give, and slip.
inline constexpr bool is_joint(Family f) { return f == Family::kFace || f == Family::kContact; }

/// One of a family: kFace 2 * face + end, of BondSet::faces; kContact of State::contacts; kSupport of
/// Scene::supported; kBoundary, kTie of BoundarySet::points, ties; kBolt of State::bolts, once for each of
/// its crossings.
struct RowOwner {
  Family family = Family::kContact;
  int index = -1;

  size_t at() const { return index; }
};

}  // namespace talus
