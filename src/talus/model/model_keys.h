#pragma once
// The keys of a model text by their dotted paths, and in which of them two models differ.

#include <map>
#include <string>
#include <vector>

namespace talus {

/// Every key with its value, entries of lists by their name or number: "stage.rest.duration" -> "1".
using ModelKeys = std::map<std::string, std::string>;

/// Of a model text as the file has it; lines "# --set KEY=VALUE" behind it are keys of their own.
ModelKeys keys_as_written(const std::string& text);

/// The same with what these lines say merged in.
ModelKeys keys_in_force(const std::string& text);

struct KeyDifference {
  std::string key;
  const std::string *now = nullptr, *before = nullptr;  // null: not given

  /// "stage.rest.duration: 1 s, was 2 s"
  std::string text() const;
};

/// In the order of the keys. @note  points into both maps
std::vector<KeyDifference> differences(const ModelKeys& now, const ModelKeys& before);

/// Lines of the differences as written, "" when there are none.
std::string model_difference(const std::string& now, const std::string& before);

/// Lines of some differences, the first twenty of them.
std::string difference_lines(const std::vector<KeyDifference>& all);

}  // namespace talus
