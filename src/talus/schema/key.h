#pragma once
// One key of a file of sections: its type, unit, range, default and meaning, and the member of the plain struct that its
// value goes to.

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeindex>
#include <vector>

#include "talus/base/error.h"
#include "talus/schema/findings.h"
#include "talus/schema/units.h"
#include "talus/schema/value.h"

namespace talus {

enum class KeyType {
  kBool,
  kInteger,
  kQuantity,      // number, or text with unit
  kQuantityAuto,  // the same, or "auto" (read as NaN)
  kText,
  kChoice,     // one of `choices`
  kSignal,     // quantity, or name of a history
  kName,       // name of something defined elsewhere in the file: `refers_to`
  kNames,      // list of two names
  kVector,     // [x, y], each a quantity
  kIntegers,   // [nx, ny]
  kPoints,     // list of [x, y]
  kLines,      // list of lists of [x, y]
  kNumbers,    // list of plain numbers
  kTexts,      // list of texts, any number
  kCurve,      // list of [time, number]
  kScattered,  // quantity, { mean, normal }, { mean, uniform } or { exponential }
  kStrength,   // quantity, or { mean, normal | lognormal, seed }
  kMotion,     // "fixed", "free", { velocity = "history" } or { displacement = "history" }
};

struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false, max_open = false;

  bool holds(double v) const { return (min_open ? v > min : v >= min) && (max_open ? v < max : v <= max); }
  bool given() const { return std::isfinite(min) || std::isfinite(max); }
  /// "> 0", "from 0 to below 1", "" when anything is allowed; with the unit of `dimension`.
  std::string describe(Dimension dimension) const;
};

struct KeySpec;

namespace key_detail {

/// Place of a text among the choices of a key. @pre  it is one of them
int place_among(const KeySpec& key, const std::string& text);

template <class T>
T from(const KeySpec& key, const Value& v) {
  if constexpr (std::is_enum_v<T>)
    return static_cast<T>(place_among(key, std::get<std::string>(v)));
  else if constexpr (std::is_same_v<T, bool>)
    return v.index() == 0 ? std::get<bool>(v) : place_among(key, std::get<std::string>(v)) == 1;
  else if constexpr (std::is_integral_v<T>)
    return static_cast<T>(std::get<int64_t>(v));
  else
    return std::get<T>(v);
}

// As the file would write it; "" where there is no way, or it is none.
std::string text_of(const KeySpec& key, bool v);
std::string text_of(const KeySpec& key, int64_t v);
std::string text_of(const KeySpec& key, double v);
std::string text_of(const KeySpec& key, const std::string& v);
std::string text_of(const KeySpec& key, Vec2 v);
std::string text_of(const KeySpec& key, const Scattered& v);  // @pre  constant
std::string text_of_choice(const KeySpec& key, int place);

template <class T>
std::string text_of_any(const KeySpec& key, const T& v) {
  if constexpr (std::is_enum_v<T>)
    return text_of_choice(key, static_cast<int>(v));
  else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>)
    return text_of(key, static_cast<int64_t>(v));
  else if constexpr (requires { text_of(key, v); })
    return text_of(key, v);
  else
    return "";
}

}  // namespace key_detail

/// Where a value goes. What a new struct holds there is what the key is when nobody gives it.
class Member {
 public:
  Member() = default;
  template <class S, class T>
  Member(T S::*member, Where S::*where)
      : of_(typeid(S)),
        put_([member, where](const KeySpec& key, const Value& v, const Where& place, void* s) {
          static_cast<S*>(s)->*member = key_detail::from<T>(key, v);
          if (where) static_cast<S*>(s)->*where = place;
        }),
        standard_([member](const KeySpec& key) { return key_detail::text_of_any(key, S{}.*member); }) {}

  /// Nothing, where the key has no member. @pre  else it is one of S
  template <class S>
  void put(const KeySpec& key, const Value& v, const Where& where, S& s) const {
    if (!put_) return;
    if (of_ != typeid(S)) fail_assertion("a section fills the struct that its keys name", __FILE__, __LINE__);
    put_(key, v, where, &s);
  }
  std::string standard(const KeySpec& key) const { return standard_ ? standard_(key) : ""; }

 private:
  std::type_index of_ = typeid(void);
  std::function<void(const KeySpec&, const Value&, const Where&, void*)> put_;
  std::function<std::string(const KeySpec&)> standard_;
};

/// The member that a key's value goes to; an enumeration by the order of the key's choices, true or false where there
/// are two.
/// @param where  member that keeps the place in the file
template <class S, class T>
Member to(T S::*member, Where S::*where = nullptr) {
  return {member, where};
}

struct KeySpec {
  std::string_view name;
  KeyType type = KeyType::kQuantity;
  Dimension dimension = Dimension::kNone;
  Range range = {};
  Range usual = {};  // of magnitudes but 0; what lies outside is legal and warned of
  bool required = false;
  std::string default_text = {};  // as it would be written in the file; "" = none
  std::vector<std::string> choices = {};
  std::string_view refers_to = {};  // "material", "joint", "history", "block or grid"
  std::string_view doc = {};
  Member member = {};  // that the value goes to
};

// Parts of a key, in any order: key("window", D::kTime, Range{.min = 0}, to(&MonitorInput::window), "What it is.").
// A member says what the key is when nobody gives it, but for Default or kNoDefault.
struct Usual {
  Range range;
};
struct Default {
  std::string_view text;
};
struct Choices {
  std::vector<std::string> names;
};
struct RefersTo {
  std::string_view what;
};
struct Required {};
inline constexpr Required kRequired;
inline constexpr Default kNoDefault{""};

namespace key_detail {

inline void put(KeySpec& k, KeyType type) { k.type = type; }
inline void put(KeySpec& k, Dimension dimension) { k.dimension = dimension; }
inline void put(KeySpec& k, const Range& range) { k.range = range; }
inline void put(KeySpec& k, const Usual& usual) { k.usual = usual.range; }
inline void put(KeySpec& k, const Default& value) { k.default_text = value.text; }
inline void put(KeySpec& k, const Choices& choices) { k.type = KeyType::kChoice, k.choices = choices.names; }
inline void put(KeySpec& k, const RefersTo& to) { k.refers_to = to.what; }
inline void put(KeySpec& k, Required) { k.required = true; }
inline void put(KeySpec& k, const Member& member) { k.member = member; }
inline void put(KeySpec& k, std::string_view doc) { k.doc = doc; }

template <class Part>
constexpr bool says_default = std::is_same_v<Part, Default> || std::is_same_v<Part, Required>;

}  // namespace key_detail

/// A quantity, where no part says otherwise.
template <class... Parts>
KeySpec key(std::string_view name, const Parts&... parts) {
  KeySpec k;
  k.name = name;
  (key_detail::put(k, parts), ...);
  if (!(key_detail::says_default<Parts> || ...)) k.default_text = k.member.standard(k);
  return k;
}

}  // namespace talus
