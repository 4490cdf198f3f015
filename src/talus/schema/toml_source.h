#pragma once
// The model file as text and as a TOML tree, with the overrides of the command line merged in.

#include <toml++/toml.h>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "talus/base/text_file.h"
#include "talus/schema/findings.h"
#include "talus/schema/schema.h"

namespace talus {

/// Largest text of a model [bytes]: beyond this it is a mistake.
inline constexpr size_t kMostModelText = size_t{64} << 20;

struct TomlSource {
  toml::table root;
  std::map<std::string, std::string> overridden;  // dotted path -> "--set path=value"
  std::set<std::string> variables_used;           // names of [variables] that texts hold
};

/// Parses `text`; syntax errors and broken encoding become findings. Variables stand as they are (variables.h).
/// @param overrides  "a.b=c" each; c is TOML, or taken as text. Entries of lists are named by their `name`,
///                   or by their number from 0: "block.striker.kind=rigid", "contact_pair.0.joint=glue".
/// @param schema     what the file may hold: only sections of entries are not made by a mistyped override
TomlSource parse_toml(const std::string& text, const std::vector<std::string>& overrides, Findings& findings,
                      const Schema& schema = {});

/// What stands before each override behind the text of a model.
inline constexpr const char* kOverride = "# --set ";

/// The text with overrides as comments of one line behind it, as results keep it.
std::string with_overrides(std::string text, const std::vector<std::string>& overrides);

/// Position of a node in the file.
Where where_of(const toml::source_region& region);

}  // namespace talus
