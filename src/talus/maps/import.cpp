#include "talus/maps/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/name.h"
#include "talus/base/text.h"

namespace talus::maps {

namespace {

// A name that a model file takes.
std::string section_name(const std::string& text, std::set<std::string>& used) {
  std::string name;
  constexpr std::string_view kWrong = ".,\"[]*/\\";
  constexpr size_t kLongest = kLongestName - 20;  // features are numbered behind it
  size_t end = std::min(text.size(), kLongest);
  while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  for (const char c : text.substr(0, end)) {
    const auto byte = static_cast<unsigned char>(c);
    name += kWrong.find(c) != std::string_view::npos || byte < 0x20 || byte == 0x7f ? '_' : c;
  }
  if (!name.empty() && !name_defect(name).empty()) name = "map " + name;
  while (!name.empty() && name.back() == ' ') name.pop_back();
  if (!name_defect(name).empty()) name = "map";
  const std::string base = name;
  for (int n = 2; !used.insert(name).second; ++n) name = fmt::format("{}_{}", base, n);
  return name;
}

// Layers, or values of the attribute, and what they hold.
std::map<std::string, Content> content_of(const Drawing& drawing, const std::string& attribute) {
  std::map<std::string, Content> out;
  for (const Feature& f : drawing.features) {
    std::string key = f.layer;
    if (!attribute.empty()) {
      const auto it = f.attributes.find(attribute);
      if (it == f.attributes.end()) continue;
      key = it->second;
    }
    Content& holds = out[key];
    (f.is_point ? holds.points : f.is_area ? holds.areas : holds.lines) = true;
  }
  return out;
}

}  // namespace

MapUse guessed_use(const std::string& layer, const Content& holds) {
  std::string lower = layer;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto says = [&lower](std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(),
                       [&lower](const char* w) { return lower.find(w) != std::string::npos; });
  };
  if (holds.points && !holds.lines && !holds.areas) return MapUse::kMonitor;
  if (says({"outline", "boundary", "border", "domain", "region"})) return MapUse::kOutline;
  if (says({"opening", "excavation", "tunnel", "cavern"})) return MapUse::kOpening;
  if (lower == "stone" || says({"stones", "block", "brick", "masonry"})) return MapUse::kStone;
  if (holds.areas && !holds.lines) return MapUse::kOutline;
  if (says({"bolt", "anchor"})) return MapUse::kBolt;
  if (says({"fault"})) return MapUse::kFault;
  return MapUse::kJoints;
}

MapSections import_map(const ImportRequest& request, const DrawingReader& reader, Findings& findings) {
  MapsInput maps = request.maps;
  std::vector<std::string> units = drawing_unit_names();
  units.insert(units.begin(), "auto");
  if (std::find(units.begin(), units.end(), request.unit) == units.end()) {
    findings.error({}, "unit", fmt::format("\"{}\" is not known; must be {}", request.unit, join_or(units)));
    return {};
  }
  Drawing drawing = reader(request.file, maps.curve_step);
  const std::map<std::string, Content> content = content_of(drawing, request.attribute);
  std::set<std::string> names;
  const auto add = [&](const std::string& what, MapUse use) {
    MapInput m;
    m.name = section_name(what, names);
    m.file = request.file;
    if (request.attribute.empty())
      m.layer = what;
    else
      m.attribute = request.attribute, m.values = {what};
    m.unit = drawing_unit(request.unit);
    m.use = use;
    if (use == MapUse::kOutline) m.material = "rock";
    if (use == MapUse::kStone) m.material = "stone";
    if (use == MapUse::kBolt) m.type = "bolt";
    maps.list.push_back(std::move(m));
  };
  for (const std::string& word : request.uses) {
    const size_t equal = word.rfind('=');
    const std::string use = equal == std::string::npos ? "" : word.substr(equal + 1);
    const auto& uses = map_use_names();
    const auto found = std::find(uses.begin(), uses.end(), use);
    if (found == uses.end()) {
      findings.error({}, "as", fmt::format("\"{}\" is not written LAYER=USE", word),
                     fmt::format("USE is {}", join_or(uses)));
      continue;
    }
    add(word.substr(0, equal), static_cast<MapUse>(found - uses.begin()));
  }
  if (findings.has_errors()) return {};
  if (request.uses.empty()) {
    for (const auto& [what, holds] : content) {
      const MapUse use = guessed_use(what, holds);
      add(what, use);
      findings.warning({}, what, fmt::format("taken for {} (a guess)", map_use_names()[place_of(use)]),
                       fmt::format("--as \"{}=...\" says what it is{}", what,
                                   holds.areas ? ": outline, opening, stone for areas" : ""));
    }
    if (content.empty())
      findings.error({}, "",
                     request.attribute.empty()
                         ? "holds no line and no point"
                         : fmt::format("no feature has an attribute \"{}\"", request.attribute));
  }
  if (findings.has_errors()) return {};
  const auto again = [&drawing](const std::filesystem::path&, double) { return drawing; };
  MapSections made = make_sections(maps, "", again, findings);
  made.text = "# materials and bolt types that are named here belong into the model\n" + made.text;
  return made;
}

}  // namespace talus::maps
