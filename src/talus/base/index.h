#pragma once
// Indices: numbers of blocks, corners, points and rows are int (docs/decisions/0026-indices-are-int.md).

#include <limits>
#include <type_traits>

#include "talus/base/error.h"

namespace talus {

/// How many there are, in the type of what counts them.
/// @pre  no more than an int holds
template <class List>
constexpr int count_of(const List& list) {
  TALUS_ASSERT(list.size() <= static_cast<size_t>(std::numeric_limits<int>::max()));
  return static_cast<int>(list.size());
}

/// The place of an enumerator in a table that has one for each.
template <class Enum>
constexpr int place_of(Enum enumerator) {
  static_assert(std::is_enum_v<Enum>);
  return static_cast<int>(enumerator);
}

}  // namespace talus
