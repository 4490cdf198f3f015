#pragma once
// JSON texts from outside: a limit that keeps readers from the end of their stack.

#include <cstddef>
#include <string>

namespace talus {

/// Deepest nesting of lists and objects in a JSON text that is read.
inline constexpr int kMostJsonDepth = 100;
/// Half the square of the number of keys in an object, summed over objects: an object may have 30,000.
inline constexpr size_t kMostJsonLooks = 450'000'000;

/// Gives the text back. Throws FileError, with `name`, where it is nested deeper or has more keys.
const std::string& checked_json(const std::string& name, const std::string& text);

}  // namespace talus
