#include "talus/maps/expand.h"

#include <sstream>

#include "talus/model/read_maps.h"
#include "talus/model/toml_source.h"

namespace talus::maps {

ExpandedModel expand_model(const std::string& file, const std::string& text,
                           const std::vector<std::string>& overrides, const DrawingReader& reader,
                           Findings& findings) {
  ExpandedModel out;
  std::vector<std::string> of_maps;
  for (const std::string& item : overrides)
    (item.rfind("map.", 0) == 0 || item.rfind("maps.", 0) == 0 ? of_maps : out.overrides).push_back(item);
  const TomlSource source = parse_toml(text, of_maps, findings);
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
  for (const std::string& item : of_maps) head += "# --set " + item + "\n";
  out.text = replace_maps(text, head + made.text);
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
  std::string quoted;
  for (const char c : way) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  std::istringstream in(text);
  std::string out = "folder = \"" + quoted + "\"\n", line;
  bool at_top = true;  // keys before the first section
  while (std::getline(in, line)) {
    const size_t first = line.find_first_not_of(" \t");
    at_top = at_top && (first == std::string::npos || line[first] != '[');
    const bool is_key = at_top && first != std::string::npos && line.compare(first, 6, "folder") == 0;
    out += (is_key ? "# " : "") + line + "\n";
  }
  return out;
}

}  // namespace talus::maps
