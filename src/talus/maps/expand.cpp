#include "talus/maps/expand.h"

#include <sstream>

#include "talus/base/text.h"
#include "talus/model/read_maps.h"
#include "talus/model/variables.h"

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
  const TomlSource source = read_toml(text, of_maps, findings);
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

std::string with_folder(const std::string& text, const std::filesystem::path& folder,
                        const std::filesystem::path& new_folder) {
  const auto absolute = [](const std::filesystem::path& p) {
    return std::filesystem::absolute(p.empty() ? "." : p).lexically_normal();
  };
  const std::string way =
      absolute(folder / "").lexically_relative(absolute(new_folder / "")).generic_string();
  // the key that is there already becomes a comment
  Findings ignored("", text);
  const TomlSource source = parse_toml(text, {}, ignored);
  const toml::node* key = source.root.get("folder");
  const auto key_line = key ? key->source().begin.line : 0;
  std::istringstream in(text.compare(0, 3, "\xef\xbb\xbf") == 0 ? text.substr(3) : text);
  std::string out = "folder = " + in_quotes(way) + "\n", line;
  for (toml::source_index number = 1; std::getline(in, line); ++number)
    out += (number == key_line ? "# " : "") + line + "\n";
  return out;
}

}  // namespace talus::maps
