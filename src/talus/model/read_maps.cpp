#include "talus/model/read_maps.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "talus/base/index.h"
#include "talus/model/model_schema.h"
#include "talus/schema/section_reader.h"

namespace talus {

namespace {

class MapsReader : private SectionReader {
 public:
  using SectionReader::SectionReader;

  MapsInput read() {
    const Fields f = read_table("maps");
    f.fill(out_);
    out_.has_origin = f.has("origin");
    std::set<std::string> names;
    for_list("map", [&](const Fields& m) { read_map(m, names); });
    return std::move(out_);
  }

 private:
  void read_map(const Fields& f, std::set<std::string>& names) {
    claim_name(f, names, "map");
    auto m = f.filled<MapInput>();
    m.unit = drawing_unit(f.get<std::string>("unit"));
    if (f.given("kind")) m.kind = f.get<std::string>("kind");
    m.where_layer = f.where("layer");
    m.where_attribute = f.where("attribute"), m.where_unit = f.where("unit");
    if (f.given("file") && m.file.empty()) error(f, "file", "is empty", "name a drawing");
    if (f.given("attribute") != f.given("values"))
      findings_.error(f.where(), f.path_of(f.given("values") ? "attribute" : "values"),
                      "is missing: attribute and values belong together");
    if (f.has("becomes")) check_keys(f, m.use);
    out_.list.push_back(std::move(m));
  }

  // Keys that what it becomes has not, and those it cannot be without.
  void check_keys(const Fields& f, MapUse use) {
    const std::map<std::string, std::vector<MapUse>> belongs{
        {"joint", {MapUse::kJoints, MapUse::kFault, MapUse::kOutline, MapUse::kOpening}},
        {"material", {MapUse::kOutline, MapUse::kStone}},
        {"kind", {MapUse::kOutline, MapUse::kStone}},
        {"type", {MapUse::kBolt}},
        {"rock", {MapUse::kOpening}}};
    for (const auto& [key, uses] : belongs) {
      const bool has = std::find(uses.begin(), uses.end(), use) != uses.end();
      const std::string& word = map_use_names()[place_of(use)];
      if (f.given(key) && !has) error(f, key, fmt::format("has no meaning for \"{}\"", word), "leave it out");
      if (!f.given(key) && has && (key == "material" || key == "type"))
        findings_.error(f.where(), f.path_of(key), fmt::format("is missing for becomes = \"{}\"", word));
    }
  }

  MapsInput out_;
};

}  // namespace

const std::vector<std::string>& map_use_names() {
  static const std::vector<std::string> names{"joints", "fault", "outline", "opening",
                                              "stone",  "bolt",  "monitor", "ignored"};
  return names;
}

namespace {

const std::vector<std::pair<std::string, double>> kUnits{{"m", 1},    {"mm", 1e-3},   {"cm", 1e-2},
                                                         {"km", 1e3}, {"in", 0.0254}, {"ft", 0.3048}};

}  // namespace

const std::vector<std::string>& drawing_unit_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& [name, metres] : kUnits) list.push_back(name);
    return list;
  }();
  return names;
}

double drawing_unit(const std::string& name) {
  for (const auto& [unit, metres] : kUnits)
    if (unit == name) return metres;
  return std::nan("");
}

bool has_maps(const TomlSource& source) {
  return source.root.get("map") != nullptr || source.root.get("maps") != nullptr;
}

MapsInput read_maps(const TomlSource& source, Findings& findings) {
  return MapsReader(source, model_schema(), findings).read();
}

}  // namespace talus
