#include "talus/model/names_used.h"

#include <fmt/format.h>

#include <set>

#include "talus/schema/read_section.h"

namespace talus {

namespace {

void collect(const toml::node& node, std::set<std::string>& texts) {
  if (const auto* text = node.as_string()) texts.insert(text->get());
  if (const auto* list = node.as_array())
    for (const toml::node& item : *list) collect(item, texts);
  if (const auto* table = node.as_table())
    for (const auto& [key, item] : *table) collect(item, texts);
}

}  // namespace

void check_names_used(const TomlSource& source, const Model& model, Findings& findings) {
  std::set<std::string> texts;
  collect(source.root, texts);
  // physical groups of meshes take materials and joints by their own names
  for (const MeshInput& m : model.meshes) {
    texts.insert(m.mesh.surface_groups.begin(), m.mesh.surface_groups.end());
    texts.insert(m.mesh.curve_groups.begin(), m.mesh.curve_groups.end());
  }
  for (const char* section : {"material", "joint", "history", "bolt_type"}) {
    const toml::table* entries = source.root[section].as_table();
    if (!entries) continue;
    for (const auto& [key, node] : *entries) {
      const std::string name(key.str());
      if (texts.count(name)) continue;
      findings.warning(where_of(node.source()), fmt::format("{}.{}", section, name),
                       "is named by nothing in the file", "is another name mistyped? Else leave it out");
    }
  }
}

}  // namespace talus
