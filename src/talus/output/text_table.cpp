#include "talus/output/text_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "talus/base/error.h"
#include "talus/base/text_file.h"

namespace talus {

int TextTable::find(const std::string& column) const {
  const auto it = std::find(columns.begin(), columns.end(), column);
  return it == columns.end() ? -1 : static_cast<int>(it - columns.begin());
}

std::string table_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

TextTable parse_text_table(const std::string& name, const std::string& text) {
  TextTable table;
  std::vector<std::string> cells(1);
  bool quoted = false;
  int line = 1, begin = 1;
  const auto end_row = [&] {
    if (cells.size() > 1 || !cells[0].empty()) {
      if (table.columns.empty()) {
        table.columns = cells;
      } else if (cells.size() != table.columns.size()) {
        throw FileError(fmt::format("{}:{}: has {} cells, the header {}", name, begin, cells.size(),
                                    table.columns.size()));
      } else {
        table.rows.push_back(cells);
      }
    }
    cells.assign(1, "");
  };
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    line += c == '\n';
    if (quoted) {
      if (c != '"')
        cells.back() += c;
      else if (i + 1 < text.size() && text[i + 1] == '"')
        cells.back() += text[++i];
      else
        quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      cells.emplace_back();
    } else if (c == '\n') {
      end_row();
      begin = line;
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  if (quoted) throw FileError(fmt::format("{}:{}: a quote has no end", name, begin));
  end_row();
  if (table.columns.empty()) throw FileError(fmt::format("{}: is empty", name));
  return table;
}

TextTable read_text_table(const std::filesystem::path& path) {
  return parse_text_table(path.string(), read_text_file(path));
}

}  // namespace talus
