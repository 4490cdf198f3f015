#include "talus/model/with_folder.h"

#include <sstream>

#include "talus/base/text.h"
#include "talus/schema/findings.h"
#include "talus/schema/toml_source.h"

namespace talus {

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

}  // namespace talus
