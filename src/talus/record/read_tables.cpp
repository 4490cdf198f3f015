// Records in tables: JMA CSV and plain CSV.

#include <fmt/format.h>

#include <cmath>
#include <regex>

#include "talus/base/text.h"
#include "talus/record/formats.h"
#include "talus/record/table.h"

namespace talus::record {

namespace {

// --- JMA ---

struct JmaHeader {
  size_t titles = 0;     // line of the component names, from 1
  size_t rate_line = 0;  // 0: absent
  double frequency = 0;  // [Hz]
  size_t unit_line = 0;
  std::string unit;
  std::string site, start;
};

JmaHeader read_jma_header(const Lines& lines) {
  static const std::regex kRate(R"(^([0-9.]+)\s*hz\b.*$)", std::regex::icase);
  JmaHeader h;
  for (size_t n = 1; n <= lines.count(); ++n) {
    const std::string_view line = trimmed(lines.line[n - 1]);
    const size_t equal = line.find('=');
    if (equal == std::string_view::npos) {
      const std::string plain = lower_case(line);
      if (plain.find("ns") != std::string::npos || plain.find("ew") != std::string::npos ||
          plain.find("ud") != std::string::npos) {
        h.titles = n;
        return h;
      }
      continue;
    }
    const std::string key = lower_case(trimmed(line.substr(0, equal)));
    std::string value(trimmed(line.substr(equal + 1)));
    while (!value.empty() && (value.back() == ',' || value.back() == ' ')) value.pop_back();
    if (key.rfind("sampling rate", 0) == 0) {
      check_header_line(lines, n);
      std::smatch match;
      if (!std::regex_match(value, match, kRate))
        fail(lines, n, fmt::format("the sampling rate \"{}\" is not understood", value),
             "it is written as in 100Hz");
      h.rate_line = n;
      h.frequency = number_at(lines, n, match[1].str(), "sampling rate");
    } else if (key.rfind("unit", 0) == 0) {
      h.unit_line = n;
      h.unit = value;
    } else if (key.rfind("site code", 0) == 0) {
      h.site = value;
    } else if (key.rfind("initial time", 0) == 0) {
      h.start = value;
    }
  }
  fail(lines, lines.count(), "there is no line of components (NS,EW,UD)",
       "the file may be cut short: fetch it again, or read it as CSV: --format csv");
}

// --- plain CSV ---

// Column of the values: as asked for, the only one beside the time, or the only acceleration.
size_t value_column(const Lines& lines, const Table& table, const std::optional<TimeColumn>& time,
                    const ReadOptions& options) {
  if (!options.column.empty()) return find_column(lines, table, options.column);
  std::vector<size_t> values, accelerations;
  for (size_t i = 0; i < table.title.size(); ++i) {
    if (time && i == time->column) continue;
    values.push_back(i);
    const Title title = parse_title(table.title[i]);
    const MotionUnit* unit = title.unit_text ? find_unit(*title.unit_text) : nullptr;
    const auto meant = quantity_called(title.name);
    if (unit ? unit->quantity == Quantity::kAcceleration : meant == Quantity::kAcceleration)
      accelerations.push_back(i);
  }
  if (values.size() == 1) return values[0];
  if (accelerations.size() == 1) return accelerations[0];
  fail(lines, table.title_line,
       values.empty() ? "there is no column beside the time" : "it is open which column to read",
       "say it with --column; there is " + titles_of(table));
}

const MotionUnit& column_unit(const Lines& lines, const Table& table, size_t column,
                              const ReadOptions& options) {
  const Title title = parse_title(table.title[column]);
  if (!title.second_unit.empty())
    fail(lines, table.title_line,
         fmt::format("\"{}\" names two units: {} and {}", table.title[column], title.second_unit,
                     *title.unit_text),
         "leave the right one only");
  const MotionUnit& unit = agreed_unit(lines, table.title_line, title.unit_text.value_or(""), options);
  const auto meant = quantity_called(title.name);
  if (meant && *meant != unit.quantity)
    fail(lines, table.title_line,
         fmt::format("\"{}\": {} has no unit {}", table.title[column], name_of(*meant), unit.symbol),
         fmt::format("a unit of {} is {}", name_of(*meant), si_symbol(*meant)));
  return unit;
}

// Step of a time column whose times may be off by `room` of a step from equal ones.
double even_step(const Lines& lines, const Table& table, const std::vector<double>& time, double dt,
                 double room) {
  for (size_t i = 1; i < time.size(); ++i) {
    if (time[i] <= time[i - 1] && room < 1)
      fail(lines, table.row[i].line,
           fmt::format("time does not rise: {:g} s is followed by {:g} s", time[i - 1], time[i]),
           "sort the rows by time, each time once");
    if (std::abs(time[i] - time[0] - static_cast<double>(i) * dt) > room * dt)
      fail(lines, table.row[i].line,
           fmt::format("time steps are uneven: {:g} s stands where equal steps of {:g} s lead to {:g} s",
                       time[i], dt, time[0] + static_cast<double>(i) * dt),
           "resample the record to equal steps; where times are only rounded too far, give --dt");
  }
  return dt;
}

double table_step(const Lines& lines, const Table& table, const std::optional<TimeColumn>& time,
                  const ReadOptions& options) {
  if (options.dt && !(*options.dt > 0))
    fail(lines, 0, fmt::format("--dt {:g}: must be above 0 s", *options.dt), "give it in s");
  if (!time) {
    if (options.dt) return *options.dt;
    fail(lines, table.title_line, "there is no column of time and no time step",
         "give --dt in s, or a column \"time [s]\"");
  }
  std::vector<double> t = numbers_of(lines, table, time->column);
  for (double& v : t) v *= time->factor;
  if (t.size() < 2) return options.dt.value_or(1);
  // rounded to the digits of the column, times stray from equal steps: up to a step where --dt tells the
  // step, a hundredth where the column has to tell it
  if (options.dt) return even_step(lines, table, t, *options.dt, 1.001);
  return even_step(lines, table, t, (t.back() - t.front()) / static_cast<double>(t.size() - 1), 0.01);
}

}  // namespace

Record read_jma(const Lines& lines, const ReadOptions& options) {
  const JmaHeader header = read_jma_header(lines);
  if (header.rate_line == 0)
    fail(lines, header.titles, "the header has no SAMPLING RATE", "add it, as in SAMPLING RATE= 100Hz");
  if (!(header.frequency > 0))
    fail(lines, header.rate_line, "the sampling rate is 0", "it is written as in 100Hz");
  const MotionUnit* named = header.unit_line ? only_unit_in(lines, header.unit_line, header.unit) : nullptr;
  const MotionUnit& unit = agreed_unit(lines, header.unit_line ? header.unit_line : header.titles,
                                       named ? std::string(named->symbol) : header.unit, options);
  const Table table = read_table(lines, header.titles);
  if (options.column.empty() && table.title.size() > 1)
    fail(lines, header.titles, "it is open which component to read",
         "say it with --column; there is " + titles_of(table));
  const size_t column = options.column.empty() ? 0 : find_column(lines, table, options.column);
  Record record;
  record.title = fmt::format("{} {} {}", header.site, table.title[column], header.start);
  record.unit = unit.symbol;
  record.quantity = unit.quantity;
  record.dt = agreed_step(lines, header.rate_line, 1 / header.frequency, options);
  record.value = numbers_of(lines, table, column);
  for (double& v : record.value) v *= unit.factor;
  return record;
}

Record read_plain_csv(const Lines& lines, const ReadOptions& options) {
  const Table table = read_table(lines, 1);
  const auto time = find_time(lines, table);
  const size_t column = value_column(lines, table, time, options);
  const MotionUnit& unit = column_unit(lines, table, column, options);
  Record record;
  record.title = table.title[column];
  record.unit = unit.symbol;
  record.quantity = unit.quantity;
  record.value = numbers_of(lines, table, column);
  record.dt = table_step(lines, table, time, options);
  for (double& v : record.value) v *= unit.factor;
  return record;
}

}  // namespace talus::record
