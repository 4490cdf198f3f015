#pragma once
// Names that a user gives to things of a model. They go into keys, tables, file names and pictures.

#include <string>
#include <string_view>

namespace talus {

/// Longest name [bytes].
inline constexpr size_t kLongestName = 100;

/// What makes a text no name, as the end of a sentence ("\"a/b\" is no name: ..."); "" for a name.
std::string name_defect(std::string_view name);

/// A name, or any text from outside, as a message shows it: control characters, but for those of `kept`, as
/// \xXX or \uXXXX.
std::string shown_name(std::string_view name, std::string_view kept = "");

/// A file name for a text of any kind, in no folder but its own: bytes that file names should not hold stand as
/// %XX, and what is too long ends in a hash. Different texts have different file names.
std::string file_name_of(std::string_view text);

}  // namespace talus
