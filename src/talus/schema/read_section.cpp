#include "talus/schema/read_section.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "talus/base/text.h"

namespace talus {

namespace {

std::string_view kind_of(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (node.is_array()) return "a list";
  if (node.is_string()) return "text";
  if (node.is_boolean()) return "true or false";
  if (node.is_number()) return "a number";
  return "a date or time";
}

// "2 MPa" is no name.
bool begins_a_number(const std::string& text) {
  const size_t at = text.find_first_not_of(" +-.");
  return at != std::string::npos && text[at] >= '0' && text[at] <= '9';
}

constexpr Range kAnyTime{.min = 0};

// Reads the values of one key; every method returns nullopt after having told why.
class ValueReader {
 public:
  ValueReader(const KeySpec& spec, const std::string& path, const Where& where, Findings& findings)
      : spec_(spec), path_(path), where_(where), findings_(findings) {}

  std::optional<Value> read(const toml::node& node) const {
    switch (spec_.type) {
      case KeyType::kBool:
        if (const auto v = node.value_exact<bool>()) return Value(*v);
        return wrong(node, "true or false");
      case KeyType::kInteger:
        return wrap(integer(node));
      case KeyType::kQuantityAuto:
        if (node.value_or(std::string()) == "auto") return Value(std::nan(""));
        [[fallthrough]];
      case KeyType::kQuantity:
        return wrap(quantity(node));
      case KeyType::kSignal:
        if (node.is_string() && !begins_a_number(*node.value<std::string>()))
          return Value(*node.value<std::string>());
        return wrap(quantity(node));
      case KeyType::kText:
      case KeyType::kName: {
        const auto v = node.value_exact<std::string>();
        if (!v) return wrong(node, spec_.type == KeyType::kText ? "text in quotes" : "a name in quotes");
        return Value(*v);
      }
      case KeyType::kChoice:
        return choice(node);
      case KeyType::kVector:
        return wrap(vector(node, "[x, y]"));
      case KeyType::kIntegers:
        return integers(node);
      case KeyType::kPoints:
        return wrap(points(node));
      case KeyType::kLines:
        return lines(node);
      case KeyType::kNumbers:
        return numbers(node);
      case KeyType::kNames:
        return names(node);
      case KeyType::kTexts:
        return texts(node);
      case KeyType::kCurve:
        return curve(node);
      case KeyType::kScattered:
        return wrap(scattered(node));
      case KeyType::kStrength:
        return wrap(strength(node));
      case KeyType::kMotion:
        return motion(node);
    }
    return {};
  }

 private:
  template <class T>
  static std::optional<Value> wrap(const std::optional<T>& v) {
    return v ? std::optional<Value>(Value(*v)) : std::nullopt;
  }

  std::nullopt_t wrong(const toml::node& node, const std::string& expected) const {
    return tell(node, fmt::format("is {}; expected {}", kind_of(node), expected));
  }
  std::nullopt_t tell(const toml::node& node, const std::string& text, const std::string& hint = "") const {
    const Where at = where_of(node.source());
    findings_.error(at.line > 0 ? at : where_, path_, text, hint);
    return std::nullopt;
  }

  std::optional<double> quantity(const toml::node& node) const {
    double v = 0;
    if (node.is_number()) {
      v = *node.value<double>();
      if (spec_.dimension == Dimension::kAngle && v != 0) {
        return tell(node, parse_quantity(fmt::format("{}", v), Dimension::kAngle).error);
      }
    } else if (const auto text = node.value_exact<std::string>()) {
      const Quantity q = parse_quantity(*text, spec_.dimension);
      if (!q.error.empty()) return tell(node, q.error);
      v = q.value;
    } else {
      return wrong(node, describe(spec_.dimension));
    }
    if (!std::isfinite(v)) return tell(node, "is not a finite number");
    if (!spec_.range.holds(v)) {
      return tell(node, fmt::format("{} is not allowed; must be {}", with_unit(v, spec_.dimension),
                                    spec_.range.describe(spec_.dimension)));
    }
    if (v != 0 && !spec_.usual.holds(std::abs(v))) {
      const Where at = where_of(node.source());
      findings_.warning(at.line > 0 ? at : where_, path_,
                        fmt::format("{} is unusual: what there is, is {}", with_unit(v, spec_.dimension),
                                    spec_.usual.describe(spec_.dimension)),
                        "is a unit wrong, or missing? Numbers without one are in SI units");
    }
    return v;
  }

  std::optional<int64_t> integer(const toml::node& node) const {
    const auto v = node.value_exact<int64_t>();
    if (!v) return wrong(node, "a whole number");
    if (!spec_.range.holds(static_cast<double>(*v))) {
      return tell(node,
                  fmt::format("{} is not allowed; must be {}", *v, spec_.range.describe(Dimension::kNone)));
    }
    return *v;
  }

  std::optional<Value> choice(const toml::node& node) const {
    const auto v = node.value_exact<std::string>();
    if (!v) return wrong(node, join_or(spec_.choices) + " in quotes");
    for (const std::string& c : spec_.choices)
      if (c == *v) return Value(*v);
    const std::string near = closest_name(*v, spec_.choices);
    return tell(node, fmt::format("\"{}\" is not known; must be {}", *v, join_or(spec_.choices)),
                near.empty() ? "" : fmt::format("did you mean \"{}\"?", near));
  }

  std::optional<Vec2> vector(const toml::node& node, const std::string& shape) const {
    const toml::array* a = node.as_array();
    if (!a || a->size() != 2) {
      if (!a) return wrong(node, fmt::format("{} with {}", shape, describe(spec_.dimension)));
      return tell(node, fmt::format("has {} entries; expected {}", a->size(), shape));
    }
    const auto x = quantity(*a->get(0)), y = quantity(*a->get(1));
    if (!x || !y) return {};
    return Vec2{*x, *y};
  }

  std::optional<Value> integers(const toml::node& node) const {
    const toml::array* a = node.as_array();
    if (!a) return wrong(node, "[columns, rows]");
    if (a->size() != 2) return tell(node, fmt::format("has {} entries; expected [columns, rows]", a->size()));
    const auto x = integer(*a->get(0)), y = integer(*a->get(1));
    if (!x || !y) return {};
    return Value(std::array<int, 2>{static_cast<int>(*x), static_cast<int>(*y)});
  }

  std::optional<std::vector<Vec2>> points(const toml::node& node) const {
    const toml::array* a = node.as_array();
    if (!a) return wrong(node, "a list of points [[x, y], [x, y], ...]");
    std::vector<Vec2> list;
    for (const toml::node& entry : *a) {
      const auto p = vector(entry, "a point [x, y]");
      if (!p) return {};
      list.push_back(*p);
    }
    return list;
  }

  std::optional<Value> lines(const toml::node& node) const {
    const toml::array* a = node.as_array();
    if (!a) return wrong(node, "a list of lines [[[x, y], [x, y], ...], ...]");
    std::vector<std::vector<Vec2>> list;
    for (const toml::node& entry : *a) {
      auto line = points(entry);
      if (!line) return {};
      if (line->size() < 2) return tell(entry, "is a line of fewer than two points");
      list.push_back(std::move(*line));
    }
    return Value(std::move(list));
  }

  std::optional<Value> numbers(const toml::node& node) const {
    const toml::array* a = node.as_array();
    if (!a) return wrong(node, "a list of numbers");
    std::vector<double> list;
    for (const toml::node& entry : *a) {
      const auto v = quantity(entry);
      if (!v) return {};
      list.push_back(*v);
    }
    return Value(list);
  }

  std::optional<Value> names(const toml::node& node) const {
    const toml::array* a = node.as_array();
    if (!a || a->size() != 2 || !a->get(0)->is_string() || !a->get(1)->is_string())
      return wrong(node, "two names, for example [\"striker\", \"bar\"]");
    return Value(
        std::vector<std::string>{*a->get(0)->value<std::string>(), *a->get(1)->value<std::string>()});
  }

  std::optional<Value> texts(const toml::node& node) const {
    const toml::array* a = node.as_array();
    if (!a) return wrong(node, "a list of texts in quotes");
    std::vector<std::string> list;
    for (const toml::node& entry : *a) {
      const auto v = entry.value_exact<std::string>();
      if (!v) return wrong(entry, "text in quotes");
      list.push_back(*v);
    }
    return Value(list);
  }

  std::optional<Value> curve(const toml::node& node) const {
    const toml::array* a = node.as_array();
    if (!a) return wrong(node, "a list of [time, number], for example [[\"0 s\", 0], [\"0.1 s\", 1]]");
    KeySpec time_spec = spec_;
    time_spec.dimension = Dimension::kTime, time_spec.range = kAnyTime;
    const ValueReader times(time_spec, path_, where_, findings_);
    std::vector<Vec2> list;
    for (const toml::node& entry : *a) {
      const toml::array* pair = entry.as_array();
      if (!pair || pair->size() != 2) return wrong(entry, "[time, number]");
      const auto t = times.quantity(*pair->get(0)), v = quantity(*pair->get(1));
      if (!t || !v) return {};
      list.push_back({*t, *v});
    }
    return Value(list);
  }

  // A quantity, or a table that says how it scatters.
  std::optional<Scattered> scattered(const toml::node& node) const {
    const toml::table* t = node.as_table();
    if (!t) {
      const auto v = quantity(node);
      return v ? std::optional<Scattered>({Scattered::kConstant, *v, 0}) : std::nullopt;
    }
    const std::string expected =
        R"(a quantity, { mean = ..., normal = standard deviation }, { mean = ..., uniform = half width } or )"
        R"({ exponential = mean })";
    if (t->size() == 1 && t->contains("exponential")) {
      const auto mean = quantity(*t->get("exponential"));
      if (!mean) return {};
      if (*mean < 0) return tell(*t->get("exponential"), "a mean of exponential scatter cannot be negative");
      return Scattered{Scattered::kExponential, *mean, *mean};
    }
    const bool normal = t->contains("normal");
    if (t->size() != 2 || !t->contains("mean") || !(normal || t->contains("uniform")))
      return wrong(node, expected);
    const toml::node& spread_node = *t->get(normal ? "normal" : "uniform");
    const auto mean = quantity(*t->get("mean"));
    const ValueReader free(without_range(), path_, where_, findings_);
    const auto spread = free.quantity(spread_node);
    if (!mean || !spread) return {};
    if (*spread < 0) return tell(spread_node, "a scatter cannot be negative");
    const double low = spec_.range.min;
    if (!normal && std::isfinite(low) && *mean - *spread < low)
      return tell(spread_node, fmt::format("is wider than the mean: values would go below {}",
                                           with_unit(low, spec_.dimension)));
    return Scattered{normal ? Scattered::kNormal : Scattered::kUniform, *mean, *spread};
  }

  // A quantity, or a table that says how it scatters from face to face.
  std::optional<Strewn> strength(const toml::node& node) const {
    Strewn s;
    s.least = spec_.range.min, s.most = spec_.range.max;
    const toml::table* t = node.as_table();
    if (!t) {
      const auto v = quantity(node);
      if (!v) return {};
      s.mean = *v;
      return s;
    }
    const std::string expected =
        "a quantity, { mean = ..., normal = standard deviation, seed = 1 } or { mean = ..., lognormal = standard "
        "deviation, seed = 1 }";
    const bool normal = t->contains("normal");
    if (!t->contains("mean") || normal == t->contains("lognormal") ||
        t->size() != (t->contains("seed") ? 3U : 2U))
      return wrong(node, expected);
    const toml::node& spread_node = *t->get(normal ? "normal" : "lognormal");
    const auto mean = quantity(*t->get("mean"));
    const auto spread = ValueReader(without_range(), path_, where_, findings_).quantity(spread_node);
    if (!mean || !spread) return {};
    if (*mean == 0) return tell(*t->get("mean"), "a mean of 0 cannot scatter");
    if (*spread < 0) return tell(spread_node, "a scatter cannot be negative");
    int64_t seed = 0;
    if (const toml::node* given = t->get("seed")) {
      const auto v = given->value_exact<int64_t>();
      if (!v || *v < 0) return tell(*given, "a seed is a whole number, 0 or more");
      seed = *v;
    }
    s.mean = *mean, s.deviation = *spread, s.seed = seed;
    s.kind = normal ? Strewn::kNormal : Strewn::kLognormal;
    return s;
  }

  const KeySpec& without_range() const {
    unlimited_ = spec_;
    unlimited_.range = {};
    return unlimited_;
  }

  std::optional<Value> motion(const toml::node& node) const {
    const std::string expected =
        R"("fixed", "free", { velocity = "HISTORY" } or { displacement = "HISTORY" })";
    if (const auto text = node.value_exact<std::string>()) {
      if (*text == "fixed") return Value(MotionText{MotionText::kFixed, ""});
      if (*text == "free") return Value(MotionText{MotionText::kFree, ""});
      return tell(node, fmt::format("\"{}\" is not known; must be {}", *text, expected));
    }
    const toml::table* t = node.as_table();
    if (!t || t->size() != 1) return wrong(node, expected);
    for (const auto& [key, value] : *t) {
      const auto history = value.value_exact<std::string>();
      if (!history) return wrong(value, "the name of a history in quotes");
      if (key.str() == "velocity") return Value(MotionText{MotionText::kVelocity, *history});
      if (key.str() == "displacement") return Value(MotionText{MotionText::kDisplacement, *history});
      return tell(value, fmt::format("\"{}\" is not known; must be {}", key.str(), expected));
    }
    return {};
  }

  const KeySpec& spec_;
  mutable KeySpec unlimited_;
  const std::string path_;
  const Where where_;
  Findings& findings_;
};

std::string default_toml(const KeySpec& key) { return "v = " + std::string(key.default_text) + "\n"; }

}  // namespace

Where Fields::where(std::string_view key) const {
  const auto it = places_.find(key);
  return it == places_.end() ? place_ : it->second;
}

Fields read_section(const SectionSpec& spec, const toml::table& table, const std::string& path,
                    const Where& place, const TomlSource& source, Findings& findings) {
  Fields fields;
  fields.keys_ = &spec.keys;
  fields.path_ = path;
  fields.place_ = place;
  std::vector<std::string> known;
  for (const KeySpec& k : spec.keys) known.emplace_back(k.name);
  const auto full = [&path](std::string_view key) {
    return path.empty() ? std::string(key) : path + "." + std::string(key);
  };

  // what the file gives
  for (const auto& [key, node] : table) {
    Where where = where_of(key.source());
    // given by --set as a whole or in part, as in angle.mean
    const std::string path_here = full(key.str());
    const auto over = source.overridden.lower_bound(path_here);
    if (over != source.overridden.end() &&
        (over->first == path_here || over->first.rfind(path_here + ".", 0) == 0))
      where = {0, 0, over->second};
    const KeySpec* match = nullptr;
    for (const KeySpec& k : spec.keys)
      if (k.name == key.str()) match = &k;
    if (!match) {
      if (spec.shape == SectionShape::kTop) continue;  // sections; the caller knows their names
      const std::string near = findings.many() ? "" : closest_name(key.str(), known);
      findings.error(where, full(key.str()), "unknown key",
                     near.empty() ? fmt::format("known here: {}", join_or(known))
                                  : fmt::format("did you mean \"{}\"?", near));
      continue;
    }
    fields.places_[std::string(key.str())] = where;
    if (const auto v = ValueReader(*match, full(key.str()), where, findings).read(node))
      fields.values_[std::string(key.str())] = *v;
  }

  // what it leaves out
  for (const KeySpec& k : spec.keys) {
    const std::string name(k.name);
    if (fields.places_.count(name)) continue;
    if (k.required) {
      findings.error(place, full(k.name), "is missing", fmt::format("{}", k.doc));
    } else if (!k.default_text.empty()) {
      const toml::table parsed = toml::parse(default_toml(k));
      if (const auto v = ValueReader(k, full(k.name), place, findings).read(*parsed.get("v")))
        fields.values_[name] = *v;
    }
  }
  return fields;
}

}  // namespace talus
