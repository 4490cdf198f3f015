#pragma once
// Whole numbers of JSON texts from outside.

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

namespace talus {

/// The number. The library would make any number an int, by a conversion that has no meaning where it does not fit:
/// here std::runtime_error is thrown.
template <class Json>
int whole_number(const Json& j) {
  constexpr int most = std::numeric_limits<int>::max();
  const bool fits = j.is_number_unsigned() ? j.template get<uint64_t>() <= uint64_t{most}
                                           : j.is_number_integer() && j.template get<int64_t>() >= -most;
  if (!fits) throw std::runtime_error(fmt::format("{} stands where a whole number belongs", j.dump()));
  return j.template get<int>();
}

template <class Json>
std::vector<int> whole_numbers(const Json& list) {
  std::vector<int> numbers;
  for (const Json& j : list) numbers.push_back(whole_number(j));
  return numbers;
}

}  // namespace talus
