#include "talus/maps/expand.h"

#include "talus/model/model_schema.h"
#include "talus/model/read_maps.h"
#include "talus/schema/variables.h"

namespace talus::maps {

ExpandedModel expand_model(const std::string& file, const std::string& text,
                           const std::vector<std::string>& overrides, const DrawingReader& reader,
                           Findings& findings) {
  ExpandedModel out;
  std::vector<std::string> of_maps;
  for (const std::string& item : overrides) {
    const bool is_map = item.rfind("map.", 0) == 0 || item.rfind("maps.", 0) == 0;
    if (is_map || item.rfind("folder=", 0) == 0 || item.rfind("variables.", 0) == 0) of_maps.push_back(item);
    if (!is_map) out.overrides.push_back(item);
  }
  const TomlSource source = read_toml(text, of_maps, findings, model_schema());
  if (findings.has_errors()) return out;
  out.has_maps = has_maps(source);
  out.text = text;
  if (!out.has_maps) return out;
  const MapsInput maps = read_maps(source, findings);
  if (findings.has_errors()) return out;
  const std::filesystem::path folder =
      std::filesystem::path(file).parent_path() / source.root["folder"].value_or(std::string());
  MapSections made = make_sections(maps, folder, reader, findings);
  out.folder = folder;
  std::string head;
  for (const std::string& item : of_maps)
    if (item.rfind("variables.", 0) != 0) head += "# --set " + item + "\n";  // that one stays an override
  out.text = replace_maps(text, head + made.text);
  if (!findings.has_errors() && has_maps(parse_toml(out.text, {}, findings)))
    findings.error({1, 1, ""}, "map", "is written in a way that cannot be replaced",
                   "write [maps] and [[map]], each with its keys in the lines below");
  out.report = std::move(made.report);
  return out;
}

}  // namespace talus::maps
