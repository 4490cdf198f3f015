#pragma once
// JSON texts from outside: a limit that keeps readers from the end of their stack.

#include <string>

namespace talus {

/// Deepest nesting of lists and objects in a JSON text that is read.
inline constexpr int kMostJsonDepth = 100;

/// Gives the text back. Throws FileError, with `name`, where it is nested deeper.
const std::string& checked_json(const std::string& name, const std::string& text);

}  // namespace talus
