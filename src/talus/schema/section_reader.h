#pragma once
// What every reader of a file of sections needs: the sections one by one, names that refer to something defined
// elsewhere, names that must be unique.

#include <fmt/format.h>

#include <set>
#include <string>

#include "talus/base/index.h"
#include "talus/base/name.h"
#include "talus/base/text.h"
#include "talus/schema/read_section.h"

namespace talus {

class SectionReader {
 public:
  SectionReader(const TomlSource& source, const Schema& schema, Findings& findings)
      : source_(source), schema_(schema), findings_(findings) {}

  // The table of a [section]; empty when the file has none. (Never a copy: copies forget their place in the
  // file.)
  const toml::table& table_of(const std::string& name, const std::string& form) {
    static const toml::table none;
    const toml::node* node = source_.root.get(name);
    if (!node) return none;
    if (const toml::table* t = node->as_table()) return *t;
    findings_.error(where_of(node->source()), name, fmt::format("is written {}", form));
    return none;
  }

  Fields read_table(const std::string& name) {
    const toml::table& t = table_of(name, "[" + name + "]");
    return read_section(section_spec(schema_, name), t, name, where_of(t.source()), source_, findings_);
  }

  // Calls `use(name, fields)` for every [section.NAME].
  template <class Use>
  void for_named(const std::string& section, Use use) {
    const toml::table& all = table_of(section, fmt::format("[{}.NAME]", section));
    for (const auto& [key, node] : all) {
      const std::string path = section + "." + std::string(key.str());
      const toml::table* t = node.as_table();
      if (!t) {
        findings_.error(where_of(key.source()), path, "is not a section",
                        fmt::format("write [{}.NAME] with a name of your own, then its keys", section));
        continue;
      }
      check_name(where_of(key.source()), path, std::string(key.str()));
      use(std::string(key.str()),
          read_section(section_spec(schema_, section), *t, path, where_of(key.source()), source_, findings_));
    }
  }

  // Calls `use(fields)` for every [[section]] but those with `use = false`.
  template <class Use>
  void for_list(const std::string& section, Use use) {
    const toml::node* node = source_.root.get(section);
    if (!node) return;
    const toml::array* list = node->as_array();
    if (!list || !node->is_array_of_tables()) {
      findings_.error(where_of(node->source()), section,
                      fmt::format("is a list: write [[{}]] with double brackets", section));
      return;
    }
    int index = 0;
    for (const toml::node& entry : *list) {
      const toml::table& t = *entry.as_table();
      const std::string name = t["name"].value_or(std::to_string(index++));
      const Fields fields = read_section(section_spec(schema_, section), t, section + "." + name,
                                         where_of(t.source()), source_, findings_);
      if (fields.get("use", true)) use(fields);
    }
  }

  // Whether the file has a [[section]] with this text at this key that `use = false` leaves out.
  bool is_left_out(const std::string& section, const std::string& key, const std::string& text) const {
    const toml::array* list = source_.root.get_as<toml::array>(section);
    if (!list) return false;
    for (const toml::node& entry : *list) {
      const toml::table* t = entry.as_table();
      if (t && (*t)[key].value_or(std::string()) == text && !(*t)["use"].value_or(true)) return true;
    }
    return false;
  }

  template <class List>
  static int index_of(const List& list, const std::string& name) {
    for (int i = 0; i < count_of(list); ++i)
      if (list[i].name == name) return i;
    return -1;
  }

  template <class List>
  int refer(const Fields& f, std::string_view key, const List& list, const std::string& what) {
    if (!f.has(key)) return -1;
    return refer_name(f.get<std::string>(key), f.where(key), f.path_of(key), list, what);
  }

  template <class List>
  int refer_name(const std::string& name, const Where& where, const std::string& path, const List& list,
                 const std::string& what) {
    const int i = index_of(list, name);
    if (i < 0) {
      std::vector<std::string> names;
      for (const auto& item : list)
        if (!item.name.empty()) names.push_back(item.name);
      const std::string near = closest_name(name, names);
      findings_.error(where, path, fmt::format("there is no {} called \"{}\"", what, name),
                      !near.empty()   ? fmt::format("did you mean \"{}\"?", near)
                      : names.empty() ? fmt::format("the file defines no {}", what)
                                      : fmt::format("there is {}", join_or(names)));
    }
    return i;
  }

  /// Indices of the stages that `stages` names. @pre  `list`, the stages of the model, is read
  template <class List>
  std::vector<int> stages(const Fields& f, const List& list) {
    std::vector<int> found;
    for (const std::string& name : f.get<std::vector<std::string>>("stages")) {
      const int i = refer_name(name, f.where("stages"), f.path_of("stages"), list, "stage");
      if (i >= 0) found.push_back(i);
    }
    if (f.has("stages") && f.get<std::vector<std::string>>("stages").empty())
      findings_.error(f.where("stages"), f.path_of("stages"), "is empty: it would never act",
                      "name stages, or leave it out for all");
    return found;
  }

  // A name that can go into keys, tables and file names.
  bool check_name(const Where& where, const std::string& path, const std::string& name) {
    const std::string defect = name_defect(name);
    if (!defect.empty())
      findings_.error(where, path, fmt::format("\"{}\" is no name: {}", shown_name(name), defect));
    return defect.empty();
  }

  void claim_name(const Fields& f, std::set<std::string>& used, const std::string& what) {
    if (!f.has("name")) return;
    const std::string name = f.get<std::string>("name");
    check_name(f.where("name"), f.path_of("name"), name);
    if (!used.insert(name).second)
      findings_.error(f.where("name"), f.path_of("name"),
                      fmt::format("a second {} is called \"{}\"", what, name));
  }

  void error(const Fields& f, std::string_view key, const std::string& text, const std::string& hint = "") {
    findings_.error(f.where(key), f.path_of(key), text, hint);
  }
  void warning(const Fields& f, std::string_view key, const std::string& text, const std::string& hint = "") {
    findings_.warning(f.where(key), f.path_of(key), text, hint);
  }

 protected:
  const TomlSource& source_;
  const Schema& schema_;
  Findings& findings_;
};

}  // namespace talus
