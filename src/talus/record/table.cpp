#include "talus/record/table.h"
#include "talus/base/text.h"

#include <fmt/format.h>

#include <charconv>

namespace talus::record {

namespace {

std::vector<std::string> split(std::string_view line, char separator) {
  std::vector<std::string> cells;
  if (separator == ' ') {
    for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
      const size_t end = std::min(line.find_first_of(" \t"), line.size());
      const std::string_view cell = line.substr(0, end);
      if (!cells.empty() && (cell[0] == '[' || cell[0] == '('))
        cells.back() += ' ' + std::string(cell);  // "acceleration [m/s2]" is one title
      else
        cells.emplace_back(cell);
      line.remove_prefix(end);
    }
    return cells;
  }
  for (size_t end = 0; end != std::string_view::npos;) {
    end = line.find(separator);
    cells.emplace_back(trimmed(line.substr(0, end)));
    if (end != std::string_view::npos) line.remove_prefix(end + 1);
  }
  while (cells.size() > 1 && cells.back().empty()) cells.pop_back();  // old files end rows with separators
  return cells;
}

char separator_of(std::string_view line) {
  for (const char c : {',', ';', '\t'})
    if (line.find(c) != std::string_view::npos) return c;
  return ' ';
}

bool is_number(const std::string& cell) {
  const char* begin = cell.data() + (!cell.empty() && cell[0] == '+');
  double v = 0;
  const auto [end, status] = std::from_chars(begin, cell.data() + cell.size(), v);
  return status == std::errc{} && end == cell.data() + cell.size();
}

bool passed_over(std::string_view line) {
  line = trimmed(line);
  return line.empty() || line[0] == '#' || line[0] == '%';
}

}  // namespace

Table read_table(const Lines& lines, size_t first) {
  Table table;
  char separator = 0;
  for (size_t n = first; n <= lines.count(); ++n) {
    std::string_view line = lines.line[n - 1];
    if (n == 1 && line.substr(0, 3) == "\xef\xbb\xbf") line.remove_prefix(3);  // byte order mark
    if (passed_over(line)) continue;
    if (!separator) separator = separator_of(trimmed(line));
    std::vector<std::string> cells = split(line, separator);
    if (table.title.empty()) {
      if (!is_number(cells[0])) {
        table.title_line = n;
        table.title = std::move(cells);
        continue;
      }
      for (size_t i = 0; i < cells.size(); ++i) table.title.push_back(std::to_string(i + 1));
    }
    if (cells.size() != table.title.size())
      fail(lines, n,
           fmt::format("the row has {} cells, the table {} columns", cells.size(), table.title.size()),
           n == lines.count() ? "the file may be cut short: fetch or write it again"
                              : "correct the row, or the title line");
    table.row.push_back({n, std::move(cells)});
  }
  if (table.row.empty())
    fail(lines, table.title_line > 0 ? table.title_line : lines.count(), "there is no row of numbers",
         "the file may be cut short: fetch or write it again");
  return table;
}

std::vector<double> numbers_of(const Lines& lines, const Table& table, size_t column) {
  std::vector<double> out;
  out.reserve(table.row.size());
  for (const Table::Row& row : table.row)
    out.push_back(
        number_at(lines, row.line, row.cell[column], fmt::format("column \"{}\"", table.title[column])));
  return out;
}

std::string titles_of(const Table& table) {
  std::string list;
  for (const std::string& t : table.title) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", t);
  return list;
}

size_t find_column(const Lines& lines, const Table& table, const std::string& name) {
  const std::string wanted = lower_case(name);
  const auto fits = [&](const std::string& title, int how) {
    if (how == 0) return lower_case(title) == wanted;
    const std::string bare = lower_case(parse_title(title).name);
    if (how == 1) return bare == wanted;
    const auto meant = quantity_called(bare);
    return meant && name_of(*meant) == wanted;
  };
  for (int how = 0; how < 3; ++how) {
    std::vector<size_t> found;
    for (size_t i = 0; i < table.title.size(); ++i)
      if (fits(table.title[i], how)) found.push_back(i);
    if (found.size() > 1)
      fail(lines, table.title_line, fmt::format("{} columns are called \"{}\"", found.size(), name),
           "name it by its whole title, and let no two titles be the same; there is " + titles_of(table));
    if (found.size() == 1) return found[0];
  }
  fail(lines, table.title_line, fmt::format("there is no column \"{}\"", name),
       "there is " + titles_of(table));
}

std::optional<TimeColumn> find_time(const Lines& lines, const Table& table) {
  std::optional<TimeColumn> found;
  for (size_t i = 0; i < table.title.size(); ++i) {
    const Title title = parse_title(table.title[i]);
    const std::string name = lower_case(title.name);
    if (name != "t" && name != "time") continue;
    const std::string unit = lower_case(title.unit_text.value_or("s"));
    if (unit != "s" && unit != "sec" && unit != "ms")
      fail(lines, table.title_line, fmt::format("\"{}\": the unit of the time is not known", table.title[i]),
           "it is s or ms");
    if (found)
      fail(lines, table.title_line, "there are two columns of time", "leave one: " + titles_of(table));
    found = TimeColumn{i, unit == "ms" ? 1e-3 : 1.0};
  }
  return found;
}

}  // namespace talus::record
