// The target spectrum of a synthetic motion from a file.

#include <fmt/format.h>

#include "talus/record/synthetic.h"
#include "talus/record/table.h"

namespace talus::record {

namespace {

bool is_period(const Title& title) {
  const std::string name = lower_case(title.name);
  return name == "t" || name == "period";
}

}  // namespace

TargetSpectrum read_target(const std::filesystem::path& path) {
  const Lines lines = split_lines(path.string(), read_record_file(path));
  const Table table = read_table(lines, 1);
  const std::string form = "a target has two columns, for example \"period [s]\" and \"sa [m/s2]\"";
  if (table.title_line == 0 || table.title.size() != 2)
    fail(lines, table.title_line ? table.title_line : 1, "the table of the target spectrum is not understood",
         form);
  const size_t first = is_period(parse_title(table.title[0])) ? 0 : 1;
  const Title period = parse_title(table.title[first]), value = parse_title(table.title[1 - first]);
  const MotionUnit* unit = find_unit(value.unit_text.value_or(""));
  if (!is_period(period) || period.unit_text != "s")
    fail(lines, table.title_line, "there is no column of periods in s", form);
  if (!unit || unit->quantity != Quantity::kAcceleration)
    fail(lines, table.title_line, fmt::format("\"{}\" names no unit of acceleration", table.title[1 - first]),
         form);

  TargetSpectrum target{numbers_of(lines, table, first), numbers_of(lines, table, 1 - first)};
  for (size_t i = 0; i < target.period.size(); ++i) {
    target.value[i] *= unit->factor;
    const size_t line = table.row[i].line;
    if (!(target.period[i] > 0 && target.value[i] > 0))
      fail(lines, line, "period and Sa must be above 0", "leave the row out");
    if (i > 0 && target.period[i] <= target.period[i - 1])
      fail(lines, line,
           fmt::format("periods do not rise: {:g} s is followed by {:g} s", target.period[i - 1],
                       target.period[i]),
           "sort the rows by period, each once");
  }
  if (target.period.size() < 2) fail(lines, table.title_line, "the target has one row", "give two or more");
  return target;
}

}  // namespace talus::record
