#pragma once
// Columns of result files that describe themselves: what they are called, their unit, how rows that are not
// written count in the one that is, and how the value follows from what a row tells of. Every table and every
// frame of points is such a list; who writes, reads, shows or compares one goes by it, never by position.

#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace talus {

/// What a column holds of the rows since the last one written.
enum class Over : char {
  kLast,   // its own row
  kWorst,  // the largest of all of them
  kSum
};

/// A value of a table with texts in it; numbers have the digits of their column.
using Cell = std::variant<double, int64_t, std::string>;

/// "top.displacement_x [m]" in its parts.
struct ColumnTitle {
  std::string monitor;  // "": none
  std::string quantity, unit;

  /// As the heads of files have it.
  std::string text() const;
};
ColumnTitle parts_of_title(const std::string& title);
std::vector<std::string> texts_of(const std::vector<ColumnTitle>& titles);

/// One column over rows that tell of a `Row`.
template <class Row, class Value = double>
struct Column {
  std::string name, unit;  // unit "": none
  std::function<Value(const Row&)> of;
  Over over = Over::kLast;
  int digits = 17;  // of numbers in a table of cells

  std::string title() const { return ColumnTitle{"", name, unit}.text(); }
};

template <class Row, class Value = double>
using Columns = std::vector<Column<Row, Value>>;

template <class Row, class Value>
std::vector<std::string> titles_of(const Columns<Row, Value>& columns) {
  std::vector<std::string> out;
  for (const auto& c : columns) out.push_back(c.title());
  return out;
}

template <class Row>
std::vector<double> values_of(const Columns<Row>& columns, const Row& row) {
  std::vector<double> out;
  out.reserve(columns.size());
  for (const auto& c : columns) out.push_back(c.of(row));
  return out;
}

/// Takes the values of rows that were not written into those of a later one.
template <class Row>
void take_in(const Columns<Row>& columns, const std::vector<double>& before, std::vector<double>& values) {
  for (size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].over == Over::kWorst && before[c] > values[c]) values[c] = before[c];
    if (columns[c].over == Over::kSum) values[c] += before[c];
  }
}

/// The cells of one line apart by commas, with its end; texts in quotes where they need them.
std::string csv_line(const std::vector<std::string>& cells);
std::string cell_text(const Cell& cell, int digits);

template <class Row, class Value>
std::string csv_head(const Columns<Row, Value>& columns) {
  return csv_line(titles_of(columns));
}

template <class Row>
std::string csv_row(const Columns<Row, Cell>& columns, const Row& row) {
  std::vector<std::string> cells;
  for (const auto& c : columns) cells.push_back(cell_text(c.of(row), c.digits));
  return csv_line(cells);
}

}  // namespace talus
