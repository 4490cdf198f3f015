#include "talus/output/columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "talus/base/error.h"
#include "talus/output/text_table.h"

namespace talus {

std::string ColumnTitle::text() const {
  std::string out = monitor.empty() ? quantity : monitor + "." + quantity;
  if (!unit.empty()) out += " [" + unit + "]";
  return out;
}

ColumnTitle parts_of_title(const std::string& title) {
  const size_t dot = title.find('.'), bracket = title.find(" [");
  ColumnTitle out;
  out.monitor = dot < bracket ? title.substr(0, dot) : "";
  const size_t from = dot < bracket ? dot + 1 : 0;
  out.quantity = title.substr(from, bracket == std::string::npos ? bracket : bracket - from);
  if (bracket != std::string::npos) out.unit = title.substr(bracket + 2, title.size() - bracket - 3);
  return out;
}

std::vector<std::string> texts_of(const std::vector<ColumnTitle>& titles) {
  std::vector<std::string> out;
  for (const ColumnTitle& title : titles) out.push_back(title.text());
  return out;
}

std::string csv_line(const std::vector<std::string>& cells) {
  return fmt::format("{}\n", fmt::join(cells, ","));
}

std::string cell_text(const Cell& cell, int digits) {
  if (const auto* number = std::get_if<double>(&cell); number && !std::isfinite(*number))
    throw NumericalError(fmt::format(
        "{} in a table of results: the model has a number beyond what can be computed with", *number));
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{:.{}g}", *number, digits);
  if (const auto* whole = std::get_if<int64_t>(&cell)) return fmt::format("{}", *whole);
  return table_cell(std::get<std::string>(cell));
}

}  // namespace talus
