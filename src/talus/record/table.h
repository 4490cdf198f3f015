#pragma once
// A table of text cells with a title line: what JMA CSV, plain CSV and history files have in common.

#include <optional>
#include <string>
#include <vector>

#include "talus/record/lines.h"
#include "talus/record/units.h"

namespace talus::record {

struct Table {
  struct Row {
    size_t line;  // from 1
    std::vector<std::string> cell;
  };
  size_t title_line = 0;           // 0: the table has bare numbers only
  std::vector<std::string> title;  // [n_columns] "1", "2", ... when the table has none
  std::vector<Row> row;            // each with n_columns cells
};

/// Reads a table separated by commas, semicolons, tabs or blanks (whichever the first line has, in this
/// order). Lines that are empty or begin with # or % are passed over. Throws InputError when a row has other
/// cells than the first line, or when there is no row.
/// @param first  line to begin at, from 1
Table read_table(const Lines& lines, size_t first);

/// The numbers of a column. Throws InputError at the first cell that is none.
std::vector<double> numbers_of(const Lines& lines, const Table& table, size_t column);

/// The column called `name`: its whole title, the title without its unit, or the quantity (acceleration,
/// velocity, displacement) that its name means, in this order, upper or lower case. Throws InputError when
/// none or several fit.
size_t find_column(const Lines& lines, const Table& table, const std::string& name);

/// The time column ("time [s]", "t_s", "t [ms]", "Time"; s when it names no unit), if there is one.
struct TimeColumn {
  size_t column;
  double factor;  // SI value of one unit
};
std::optional<TimeColumn> find_time(const Lines& lines, const Table& table);

/// "\"time [s]\", \"a_gal\""
std::string titles_of(const Table& table);

}  // namespace talus::record
