// K-NET and KiK-net ASCII: header lines of a label (columns 1 to 18) and a value, then counts of the logger.
// a = (count - mean) x numerator / denominator of the scale factor: raw counts carry an offset.

#include <fmt/format.h>

#include <cmath>
#include <regex>

#include "talus/base/text.h"
#include "talus/record/formats.h"

namespace talus::record {

namespace {

constexpr size_t kLabelWidth = 18;
constexpr size_t kKnetHeader = 17;

struct Entry {
  size_t line = 0;  // from 1; 0: absent
  std::string value;
};

// The header line whose label begins with `label` (labels are spelled in more than one way behind that).
Entry find_entry(const Lines& lines, std::string_view label) {
  for (size_t n = 1; n <= std::min(lines.count(), kKnetHeader); ++n) {
    const std::string& line = lines.line[n - 1];
    if (lower_case(line).rfind(label, 0) != 0) continue;
    check_header_line(lines, n);
    return {
        n, line.size() > kLabelWidth ? std::string(trimmed(std::string_view(line).substr(kLabelWidth))) : ""};
  }
  return {};
}

Entry need_entry(const Lines& lines, std::string_view label) {
  const Entry e = find_entry(lines, label);
  if (e.line == 0)
    fail(lines, std::min(lines.count(), kKnetHeader), fmt::format("the header has no line \"{}\"", label),
         "a K-NET file has 17 header lines, from Origin Time to Memo.; fetch it again");
  return e;
}

double leading_number(const Lines& lines, const Entry& e, const std::string& what) {
  static const std::regex kNumber(R"(^([0-9.]+)\s*(hz|s)?$)", std::regex::icase);
  std::smatch match;
  if (!std::regex_match(e.value, match, kNumber))
    fail(lines, e.line, fmt::format("{}: \"{}\" is not understood", what, e.value),
         "it is written as in 100Hz");
  return number_at(lines, e.line, match[1].str(), what);
}

// [m/s2] per count, from "3920(gal)/6182761"
double count_factor(const Lines& lines, Record& record, const ReadOptions& options) {
  static const std::regex kScale(R"(^([0-9.]+)\s*\(([^)]*)\)\s*/\s*([0-9.]+)$)");
  const Entry e = need_entry(lines, "scale factor");
  std::smatch match;
  if (!std::regex_match(e.value, match, kScale))
    fail(lines, e.line, fmt::format("the scale factor \"{}\" is not understood", e.value),
         "it is written as in 3920(gal)/6182761");
  const MotionUnit& unit = agreed_unit(lines, e.line, match[2].str(), options);
  const double over = number_at(lines, e.line, match[1].str(), "scale factor"),
               under = number_at(lines, e.line, match[3].str(), "scale factor");
  if (!(over > 0 && under > 0))
    fail(lines, e.line, fmt::format("the scale factor is \"{}\"", e.value), "both numbers must be above 0");
  record.unit = unit.symbol;
  record.quantity = unit.quantity;
  return unit.factor * over / under;
}

}  // namespace

Record read_knet(const Lines& lines, const ReadOptions& options) {
  Record record;
  const double factor = count_factor(lines, record, options);
  const Entry rate = need_entry(lines, "sampling freq");
  const double frequency = leading_number(lines, rate, "sampling frequency");
  if (!(frequency > 0))
    fail(lines, rate.line, "the sampling frequency is 0", "correct the header; it is written as in 100Hz");
  record.dt = agreed_step(lines, rate.line, 1 / frequency, options);
  record.title = fmt::format("{} {} {}", find_entry(lines, "station code").value,
                             find_entry(lines, "dir").value, find_entry(lines, "record time").value);

  record.value = numbers_from(lines, need_entry(lines, "memo").line + 1, Numbers::kWhole);
  const Entry duration = need_entry(lines, "duration");
  const double expected = std::round(leading_number(lines, duration, "duration") * frequency);
  const auto n = static_cast<double>(record.value.size());
  if (n != expected)
    fail(lines, n < expected ? lines.count() : duration.line,
         fmt::format("there are {} values, but duration and sampling frequency make {}", n, expected),
         n < expected ? "the file is cut short: fetch it again" : "correct the header");
  double mean = 0;
  for (const double v : record.value) mean += v / n;
  for (double& v : record.value) v = (v - mean) * factor;
  record.offset = mean * factor;
  return record;
}

}  // namespace talus::record
