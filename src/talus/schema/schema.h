#pragma once
// What a file of sections may hold: every section and key with type, unit, range, default and meaning, in one table.
// The reader validates with it, the documentation tables and the published JSON schema are printed from it.

#include <string>
#include <string_view>
#include <vector>

#include "talus/schema/key.h"

namespace talus {

enum class SectionShape {
  kTop,    // keys at the top of the file
  kFree,   // [section] with keys of the user's own
  kTable,  // [section]
  kNamed,  // [section.NAME], any number
  kList,   // [[section]], any number
};

struct SectionSpec {
  std::string_view name;
  SectionShape shape;
  std::string_view doc;
  std::vector<KeySpec> keys;
};

/// All sections of a kind of file, in the order of its documentation.
using Schema = std::vector<SectionSpec>;

/// @pre  the section exists
const SectionSpec& section_spec(const Schema& schema, std::string_view name);

/// Markdown tables of sections and their keys.
std::string schema_markdown(const Schema& schema);

/// A markdown table of all units.
std::string units_markdown();

/// JSON Schema (draft 2020-12) for editors. @pre  the first section is the top of the file
std::string schema_json(const Schema& schema, std::string_view title);

}  // namespace talus
