#include "talus/record/history_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "talus/record/lines.h"
#include "talus/record/read_record.h"
#include "talus/record/table.h"

namespace talus::record {

namespace {

// Units of histories that are no motion, all SI.
bool is_other(std::string_view unit) {
  constexpr std::array<std::string_view, 6> kOther{"rad", "rad/s", "rad/s2", "-", "N", "Pa"};
  return std::find(kOther.begin(), kOther.end(), unit) != kOther.end();
}

// SI value of one unit of a column that any history may hold.
double factor_of(const Lines& lines, const Table& table, size_t column) {
  const Title title = parse_title(table.title[column]);
  const std::string hint = fmt::format(
      "write it as \"{} [m/s2]\"; units are {}, rad, rad/s, rad/s2, N, Pa, -", title.name, known_units());
  if (!title.second_unit.empty())
    fail(lines, table.title_line,
         fmt::format("\"{}\" names two units: {} and {}", table.title[column], title.second_unit,
                     *title.unit_text),
         "leave the right one only");
  if (!title.unit_text || title.unit_text->empty())
    fail(lines, table.title_line, fmt::format("\"{}\" names no unit", table.title[column]), hint);
  if (is_other(*title.unit_text)) return 1;
  const MotionUnit* unit = find_unit(*title.unit_text);
  if (!unit)
    fail(lines, table.title_line, fmt::format("the unit \"{}\" is not known", *title.unit_text), hint);
  const auto meant = quantity_called(title.name);
  if (meant && *meant != unit->quantity)
    fail(lines, table.title_line,
         fmt::format("\"{}\": {} has no unit {}", table.title[column], name_of(*meant), unit->symbol),
         fmt::format("a unit of {} is {}", name_of(*meant), si_symbol(*meant)));
  return unit->factor;
}

// The same where the model names the unit: the title must name none, or the same.
double named_factor(const Lines& lines, const Table& table, size_t column, const std::string& unit) {
  const MotionUnit* named = find_unit(unit);
  if (!named && !is_other(unit))
    fail(lines, 0, fmt::format("the unit \"{}\" is not known", unit),
         fmt::format("units are {}, rad, rad/s, rad/s2, N, Pa, -", known_units()));
  const double factor = named ? named->factor : 1;
  const Title title = parse_title(table.title[column]);
  if (title.unit_text && !title.unit_text->empty() && factor_of(lines, table, column) != factor)
    fail(lines, table.title_line,
         fmt::format("the unit is named twice: {} here, {} in the model", *title.unit_text, unit),
         "leave unit out, or correct the file");
  return factor;
}

HistoryColumn from_table(const Lines& lines, const std::string& name, const Bare& bare) {
  const Table table = read_table(lines, 1);
  const auto time = find_time(lines, table);
  if (!time)
    fail(lines, table.title_line, "there is no column of time",
         (table.title_line ? "title one \"time [s]\"; there is " + titles_of(table)
                           : "begin the file with a line of titles, as \"time [s],acceleration [m/s2]\"") +
             "; or say dt = \"...\" (and unit = \"...\") of values at equal steps");
  if (name.empty() && table.title.size() != 2)
    fail(lines, table.title_line, "it is open which column to read",
         "say it with column = \"...\"; there is " + titles_of(table));
  const size_t column = name.empty() ? 1 - time->column : find_column(lines, table, name);
  if (column == time->column)
    fail(lines, table.title_line, fmt::format("\"{}\" is the time itself", table.title[column]),
         "name another column: " + titles_of(table));

  HistoryColumn out{numbers_of(lines, table, time->column), numbers_of(lines, table, column),
                    table.title[column]};
  const double factor =
      bare.unit.empty() ? factor_of(lines, table, column) : named_factor(lines, table, column, bare.unit);
  for (double& t : out.time) t *= time->factor;
  for (double& v : out.value) v *= factor;
  for (size_t i = 1; i < out.time.size(); ++i)
    if (out.time[i] <= out.time[i - 1])
      fail(lines, table.row[i].line,
           fmt::format("time does not rise: {:g} s is followed by {:g} s", out.time[i - 1], out.time[i]),
           "sort the rows by time, each time once");
  if (out.time.size() < 2)
    fail(lines, table.row[0].line, "the table has one row", "a history needs at least two");
  return out;
}

}  // namespace

namespace {

// Values at equal steps, in a unit that is no motion.
HistoryColumn bare_values(const Lines& lines, const std::string& name, const Bare& bare) {
  const Table table = read_table(lines, 1);
  if (name.empty() && table.title.size() != 1)
    fail(lines, table.title_line, "it is open which column to read",
         "say it with column = \"...\"; there is " + titles_of(table));
  const size_t column = name.empty() ? 0 : find_column(lines, table, name);
  const double factor = named_factor(lines, table, column, bare.unit);
  HistoryColumn out{{}, numbers_of(lines, table, column), table.title[column]};
  for (size_t i = 0; i < out.value.size(); ++i)
    out.value[i] *= factor, out.time.push_back(static_cast<double>(i) * *bare.dt);
  if (out.time.size() < 2)
    fail(lines, table.row[0].line, "the table has one row", "a history needs at least two");
  return out;
}

}  // namespace

HistoryColumn read_history_text(const std::string& file, const std::string& text, const std::string& column,
                                const Bare& bare) {
  const Lines lines = split_lines(file, text);
  const Format format = recognised(lines);
  if (format == Format::kCsv && !bare.dt) {
    check_known(lines);
    return from_table(lines, column, bare);
  }
  if (format == Format::kCsv && is_other(bare.unit)) return bare_values(lines, column, bare);
  ReadOptions options;
  options.dt = bare.dt, options.unit = bare.unit;
  // one component in a file: the column can only be what it is
  const bool single =
      format == Format::kPeer || format == Format::kKnet || format == Format::kEsm || format == Format::kSmc;
  if (!single) options.column = column;
  const Record record = read_record_text(file, text, options);
  if (single && !column.empty() && column != name_of(record.quantity))
    fail(lines, 0, fmt::format("there is no column \"{}\" in this {} file", column, name_of(format)),
         fmt::format("it holds one {}; leave column out", name_of(record.quantity)));
  HistoryColumn out{{}, record.value, record.title};
  for (size_t i = 0; i < record.value.size(); ++i) out.time.push_back(static_cast<double>(i) * record.dt);
  return out;
}

}  // namespace talus::record
