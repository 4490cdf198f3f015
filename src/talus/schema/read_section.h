#pragma once
// One section of the file, checked against the schema: unknown keys, types, units, ranges, missing keys.

#include <array>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "talus/base/vec2.h"
#include "talus/schema/findings.h"
#include "talus/schema/scattered.h"
#include "talus/schema/schema.h"
#include "talus/schema/strength_scatter.h"
#include "talus/schema/toml_source.h"

namespace talus {

struct MotionText {
  enum Kind { kFree, kFixed, kVelocity, kDisplacement } kind = kFixed;
  std::string history;
};

using Value = std::variant<bool, int64_t, double, std::string, Vec2, std::array<int, 2>, std::vector<Vec2>,
                           std::vector<std::vector<Vec2>>, std::vector<double>, std::vector<std::string>,
                           MotionText, Scattered, StrengthScatter>;

/// The values of one section, in SI, defaults filled in. A key that was wrong is absent, and a finding tells
/// why.
class Fields {
 public:
  bool has(std::string_view key) const { return values_.count(std::string(key)) > 0; }
  /// Whether the file itself (or --set) gives the key.
  bool given(std::string_view key) const { return places_.count(std::string(key)) > 0; }

  /// The value, or `fallback` when absent.
  template <class T>
  T get(std::string_view key, T fallback = T{}) const {
    const auto it = values_.find(std::string(key));
    return it == values_.end() ? fallback : std::get<T>(it->second);
  }
  /// Whether the value is of this kind, of a key that may be of several. @pre has(key)
  template <class T>
  bool holds(std::string_view key) const {
    return std::holds_alternative<T>(values_.at(std::string(key)));
  }
  Where where(std::string_view key) const;
  Where where() const { return place_; }
  const std::string& path() const { return path_; }
  /// "block.striker.kind"
  std::string path_of(std::string_view key) const { return path_ + "." + std::string(key); }

 private:
  friend Fields read_section(const SectionSpec&, const toml::table&, const std::string&, const Where&,
                             const TomlSource&, Findings&);
  std::map<std::string, Value> values_;
  std::map<std::string, Where> places_;
  Where place_;
  std::string path_;
};

/// @param path  dotted name of this section in messages and overrides, "block.striker"
Fields read_section(const SectionSpec& spec, const toml::table& table, const std::string& path,
                    const Where& place, const TomlSource& source, Findings& findings);

}  // namespace talus
