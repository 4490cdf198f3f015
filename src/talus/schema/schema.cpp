#include "talus/schema/schema.h"

#include <fmt/format.h>

#include "talus/base/error.h"
#include "talus/base/text.h"

namespace talus {

namespace {

using D = Dimension;
using K = KeyType;

// --- markdown ---

std::string_view type_text(const KeySpec& k) {
  switch (k.type) {
    case K::kBool:
      return "true or false";
    case K::kInteger:
      return "whole number";
    case K::kQuantity:
      return k.dimension == D::kNone ? "number" : "quantity";
    case K::kQuantityAuto:
      return "quantity or \"auto\"";
    case K::kText:
      return "text";
    case K::kChoice:
      return "choice";
    case K::kSignal:
      return "quantity or history";
    case K::kName:
      return "name";
    case K::kNames:
      return "two names";
    case K::kVector:
      return "[x, y]";
    case K::kIntegers:
      return "[nx, ny]";
    case K::kPoints:
      return "list of [x, y]";
    case K::kLines:
      return "list of lists of [x, y]";
    case K::kNumbers:
      return "list of numbers";
    case K::kTexts:
      return "list of texts";
    case K::kCurve:
      return "list of [time, number]";
    case K::kScattered:
      return "quantity or scatter";
    case K::kStrength:
      return "quantity or scatter";
    case K::kMotion:
      return "motion";
  }
  return "";
}

std::string allowed_text(const KeySpec& k) {
  const D shown = k.dimension == D::kAngle ? D::kAngle : D::kNone;
  std::string out = k.range.describe(shown);
  for (const std::string& c : k.choices) out += (out.empty() ? "`" : ", `") + c + "`";
  if (k.usual.given()) out += fmt::format("{}usually {}", out.empty() ? "" : "; ", k.usual.describe(shown));
  if (!k.refers_to.empty()) out = fmt::format("name of a {}", k.refers_to);
  return out;
}

std::string heading(const SectionSpec& s) {
  switch (s.shape) {
    case SectionShape::kTop:
      return "Top of the file";
    case SectionShape::kFree:
    case SectionShape::kTable:
      return fmt::format("`[{}]`", s.name);
    case SectionShape::kNamed:
      return fmt::format("`[{}.NAME]`", s.name);
    case SectionShape::kList:
      return fmt::format("`[[{}]]`", s.name);
  }
  return "";
}

// --- JSON schema: written by hand as text, because the shapes are few and the order of keys matters to
// readers ---

std::string json_range(const Range& r) {
  std::string out;
  const double infinity = std::numeric_limits<double>::infinity();
  if (r.min > -infinity)
    out += fmt::format(", \"{}\": {:g}", r.min_open ? "exclusiveMinimum" : "minimum", r.min);
  if (r.max < infinity)
    out += fmt::format(", \"{}\": {:g}", r.max_open ? "exclusiveMaximum" : "maximum", r.max);
  return out;
}

std::string json_type(const KeySpec& k) {
  const std::string quantity = R"("type": ["number", "string"])";
  const auto array = [](const std::string& item, const std::string& count) {
    return fmt::format(R"("type": "array", "items": {{{}}}{})", item, count);
  };
  const std::string two = R"(, "minItems": 2, "maxItems": 2)";
  switch (k.type) {
    case K::kBool:
      return R"("type": "boolean")";
    case K::kInteger:
      return R"("type": "integer")" + json_range(k.range);
    case K::kQuantity:
    case K::kQuantityAuto:
      return quantity + json_range(k.range);
    case K::kSignal:
      return quantity;
    case K::kText:
    case K::kName:
      return R"("type": "string")";
    case K::kChoice: {
      std::string list;
      for (const std::string& c : k.choices) list += (list.empty() ? "" : ", ") + in_quotes(c);
      return fmt::format(R"("enum": [{}])", list);
    }
    case K::kNames:
      return array(R"("type": "string")", two);
    case K::kVector:
      return array(quantity, two);
    case K::kIntegers:
      return array(R"("type": "integer")" + json_range(k.range), two);
    case K::kPoints:
      return array(array(quantity, two), R"(, "minItems": 2)");
    case K::kLines:
      return array(array(array(quantity, two), R"(, "minItems": 2)"), R"(, "minItems": 1)");
    case K::kNumbers:
      return array(R"("type": "number")", R"(, "minItems": 2)");
    case K::kTexts:
      return array(R"("type": "string")", "");
    case K::kCurve:
      return array(array(quantity, two), R"(, "minItems": 1)");
    case K::kScattered: {
      const auto table = [&](const std::string& one, const std::string& two_keys) {
        return fmt::format(
            R"({{"type": "object", "additionalProperties": false, "properties": {{{}}}, "required": [{}]}})",
            one, two_keys);
      };
      const std::string number = "{" + quantity + "}";
      return fmt::format(R"("oneOf": [{{{}}}, {}, {}, {}])", quantity + json_range(k.range),
                         table(R"("mean": )" + number + R"(, "normal": )" + number, R"("mean", "normal")"),
                         table(R"("mean": )" + number + R"(, "uniform": )" + number, R"("mean", "uniform")"),
                         table(R"("exponential": )" + number, R"("exponential")"));
    }
    case K::kStrength: {
      const std::string number = "{" + quantity + "}",
                        seed = R"("seed": {"type": ["integer", "string"], "minimum": 0})";
      const auto table = [&](const char* kind) {
        return fmt::format(
            R"({{"type": "object", "additionalProperties": false, "properties": {{"mean": {}, "{}": {}, {}}}, "required": ["mean", "{}"]}})",
            number, kind, number, seed, kind);
      };
      return fmt::format(R"("oneOf": [{{{}}}, {}, {}])", quantity + json_range(k.range), table("normal"),
                         table("lognormal"));
    }
    case K::kMotion:
      return R"("oneOf": [{"enum": ["fixed", "free"]}, {"type": "object", "additionalProperties": false, )"
             R"("properties": {"velocity": {"type": "string"}, "displacement": {"type": "string"}}, )"
             R"("minProperties": 1, "maxProperties": 1}])";
  }
  return "";
}

// A text with a variable stands for a value of any type.
std::string json_type_or_variable(const KeySpec& k) {
  const std::string type = json_type(k);
  if (type.rfind(R"("type": ["number", "string"])", 0) == 0 || type == R"("type": "string")") return type;
  return fmt::format(R"("anyOf": [{{{}}}, {{"type": "string", "pattern": "[$]"}}])", type);
}

std::string json_properties(const SectionSpec& s, const std::string& indent) {
  std::string out, required;
  for (const KeySpec& k : s.keys) {
    std::string doc(k.doc);
    if (k.dimension != D::kNone) doc += fmt::format(" Unit: {}.", si_symbol(k.dimension));
    out += fmt::format("{}{}{}: {{{}, \"description\": {}{}}}", out.empty() ? "" : ",\n", indent,
                       in_quotes(k.name), json_type_or_variable(k), in_quotes(doc),
                       k.default_text.empty() ? "" : fmt::format(", \"default\": {}", k.default_text));
    if (k.required) required += (required.empty() ? "" : ", ") + in_quotes(k.name);
  }
  return fmt::format("\"additionalProperties\": false, \"required\": [{}], \"properties\": {{\n{}}}",
                     required, out);
}

}  // namespace

const SectionSpec& section_spec(const Schema& schema, std::string_view name) {
  for (const SectionSpec& s : schema)
    if (s.name == name) return s;
  fail_assertion("the section is in the schema", __FILE__, __LINE__);
}

std::string schema_markdown(const Schema& schema) {
  std::string out;
  for (const SectionSpec& s : schema) {
    if (s.shape == SectionShape::kFree) {
      out += fmt::format("### {}\n\n{}\n\n", heading(s), s.doc);
      continue;
    }
    out += fmt::format(
        "### {}\n\n{}\n\n| key | type | unit | default | allowed | meaning |\n|---|---|---|---|---|---|\n",
        heading(s), s.doc);
    for (const KeySpec& k : s.keys) {
      const std::string def = k.required               ? "required"
                              : k.default_text.empty() ? "none"
                                                       : fmt::format("`{}`", k.default_text);
      out += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", k.name, type_text(k), si_symbol(k.dimension),
                         def, allowed_text(k), k.doc);
    }
    out += "\n";
  }
  return out;
}

std::string units_markdown() {
  std::string out = "### Units\n\n| quantity | units (SI first) |\n|---|---|\n";
  for (int d = static_cast<int>(D::kLength); d <= static_cast<int>(D::kLineForce); ++d) {
    const std::string text = describe(static_cast<D>(d));
    const size_t open = text.find(" (");
    out += fmt::format("| {} | {} |\n", text.substr(0, open), text.substr(open + 2, text.size() - open - 3));
  }
  return out;
}

std::string schema_json(const Schema& schema, std::string_view title) {
  std::string out = json_properties(schema.front(), "    ");
  out.pop_back();  // the closing brace of the properties: sections follow
  for (const SectionSpec& s : schema) {
    if (s.shape == SectionShape::kTop) continue;
    const std::string object = fmt::format("\"type\": \"object\", {}", json_properties(s, "      "));
    std::string body;
    if (s.shape == SectionShape::kFree) body = R"("type": "object")";
    if (s.shape == SectionShape::kTable) body = object;
    if (s.shape == SectionShape::kNamed)
      body = fmt::format("\"type\": \"object\", \"additionalProperties\": {{{}}}", object);
    if (s.shape == SectionShape::kList) body = fmt::format("\"type\": \"array\", \"items\": {{{}}}", object);
    out += fmt::format(",\n    {}: {{\"description\": {}, {}}}", in_quotes(s.name), in_quotes(s.doc), body);
  }
  return fmt::format(
      "{{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": {},\n"
      "  \"type\": \"object\",\n  {}}}\n}}\n",
      in_quotes(title), out);
}

}  // namespace talus
