#pragma once
// The kinds of boundaries there are, by the names that models give them. What each does is in
// supports/boundaries.cpp.

#include <array>
#include <cstddef>
#include <string_view>

#include "talus/base/index.h"

namespace talus {

enum class BoundaryKind { kViscous, kFreeField, kTied };

struct BoundaryEntry {
  BoundaryKind kind;
  std::string_view name;
  const char* title;           // in pictures
  std::string_view doc;        // of the key
  std::string_view no_motion;  // why it takes no motion, and what does instead; "": it brings one in
  bool two_sided = false;      // has an opposite side
};

/// In the order of the enumeration. A new kind is a line here, and its rows.
inline constexpr std::array kBoundaries{
    BoundaryEntry{BoundaryKind::kViscous, "viscous", "viscous boundary",
                  "dashpots that absorb waves and, with `velocity_x` or `velocity_y`, a compliant base.", ""},
    BoundaryEntry{BoundaryKind::kFreeField, "free_field", "free field",
                  "dashpots against a column of level ground that shakes beside the edge.",
                  "its column takes the motion of the base that it stands on"},
    BoundaryEntry{BoundaryKind::kTied, "tied", "tied sides",
                  "moves with the opposite side, which is exact for level ground.",
                  "tied sides bring none in; give it to the base", true},
};

inline constexpr const BoundaryEntry& entry(BoundaryKind kind) { return kBoundaries[place_of(kind)]; }

}  // namespace talus
