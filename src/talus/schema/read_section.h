#pragma once
// One section of the file, checked against the schema: unknown keys, types, units, ranges, missing keys.

#include <map>
#include <string>
#include <vector>

#include "talus/schema/findings.h"
#include "talus/schema/schema.h"
#include "talus/schema/toml_source.h"

namespace talus {

/// The values of one section, in SI, defaults filled in. A key that was wrong is absent, and a finding tells
/// why.
class Fields {
 public:
  bool has(std::string_view key) const { return values_.count(key) > 0; }
  /// Whether the file itself (or --set) gives the key.
  bool given(std::string_view key) const { return places_.count(key) > 0; }

  /// The value, or `fallback` when absent.
  template <class T>
  T get(std::string_view key, T fallback = T{}) const {
    const auto it = values_.find(key);
    return it == values_.end() ? fallback : std::get<T>(it->second);
  }
  /// Whether the value is of this kind, of a key that may be of several. @pre has(key)
  template <class T>
  bool holds(std::string_view key) const {
    return std::holds_alternative<T>(values_.find(key)->second);
  }
  /// Gives the members of `s` that keys go to (to() in schema.h) what the section says, and `s.where` its place. Of a
  /// key that is wrong, or not given and without a default, the member stays as it is.
  template <class S>
  void fill(S& s) const {
    for (const KeySpec& k : *keys_)
      if (const auto it = values_.find(k.name); it != values_.end())
        k.member.put(k, it->second, where(k.name), s);
    if constexpr (requires { s.where = place_; }) s.where = place_;
  }
  template <class S>
  S filled() const {
    S s;
    fill(s);
    return s;
  }
  Where where(std::string_view key) const;
  Where where() const { return place_; }
  const std::string& path() const { return path_; }
  /// "block.striker.kind"
  std::string path_of(std::string_view key) const { return path_ + "." + std::string(key); }

 private:
  friend Fields read_section(const SectionSpec&, const toml::table&, const std::string&, const Where&,
                             const TomlSource&, Findings&);
  const std::vector<KeySpec>* keys_ = nullptr;
  std::map<std::string, Value, std::less<>> values_;
  std::map<std::string, Where, std::less<>> places_;
  Where place_;
  std::string path_;
};

/// @param path  dotted name of this section in messages and overrides, "block.striker"
Fields read_section(const SectionSpec& spec, const toml::table& table, const std::string& path,
                    const Where& place, const TomlSource& source, Findings& findings);

}  // namespace talus
