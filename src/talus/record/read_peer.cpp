// PEER AT2, VT2, DT2: four lines of header, count and step in several spellings, values without a time
// column.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <regex>

#include "talus/base/text.h"
#include "talus/record/formats.h"

namespace talus::record {

namespace {

constexpr size_t kPeerHeader = 10;

struct Counts {
  size_t line = 0;  // that holds them, from 1
  size_t count = 0;
  double dt = 0;  // [s]
};

// "NPTS=   7500, DT=   .0200 SEC,", "NPTS=3309, DT=0.0050SEC", "4000   .0050   NPTS, DT"
Counts find_counts(const Lines& lines) {
  static const std::regex kNamed(
      R"(npts\s*=?\s*(\d+)\s*,?\s*dt\s*=?\s*([-+]?[0-9.]+(e[-+]?\d+)?)\s*(s|sec)?[\s,.]*$)",
      std::regex::icase);
  static const std::regex kOld(R"(^\s*(\d+)[\s,]+([-+]?[0-9.]+(e[-+]?\d+)?)[\s,]+npts\s*,?\s*dt.*$)",
                               std::regex::icase);
  for (size_t n = 1; n <= std::min(lines.count(), kPeerHeader); ++n) {
    const std::string& line = lines.line[n - 1];
    if (lower_case(line).find("npts") == std::string::npos) continue;
    check_header_line(lines, n);
    std::smatch match;
    if (!std::regex_search(line, match, kNamed) && !std::regex_match(line, match, kOld))
      fail(lines, n, fmt::format("count and time step are not understood: \"{}\"", trimmed(line)),
           "write the line as NPTS= 4000, DT= .0050 SEC");
    const double count = number_at(lines, n, match[1].str(), "NPTS");
    if (count < 1 || count > 1e9)
      fail(lines, n, fmt::format("NPTS is {:g}", count), "it must be the number of values, from 2 on");
    return {n, static_cast<size_t>(count), number_at(lines, n, match[2].str(), "DT")};
  }
  fail(lines, std::min(lines.count(), size_t{4}), "there is no NPTS and DT in the header of this PEER file",
       "line 4 of an AT2 file says NPTS= 4000, DT= .0050 SEC; otherwise read the values as CSV: --format csv "
       "--dt");
}

// The unit of "ACCELERATION TIME SERIES IN UNITS OF G", and the quantity it speaks of.
const MotionUnit& find_header_unit(const Lines& lines, const Counts& counts, const ReadOptions& options) {
  for (size_t n = 1; n < counts.line; ++n) {
    const std::string line = lower_case(lines.line[n - 1]);
    const size_t at = line.find("units of");
    if (at == std::string::npos) continue;
    const std::string_view rest = trimmed(std::string_view(line).substr(at + 8));
    const MotionUnit* only = only_unit_in(lines, n, rest);
    const MotionUnit& unit =
        agreed_unit(lines, n, only ? std::string(only->symbol) : std::string(rest), options);
    for (const Quantity q : {Quantity::kAcceleration, Quantity::kVelocity, Quantity::kDisplacement})
      if (line.rfind(name_of(q), at) != std::string::npos && q != unit.quantity)
        fail(lines, n, fmt::format("the header speaks of {} in {}", name_of(q), unit.symbol),
             fmt::format("a unit of {} is {}", name_of(q), si_symbol(q)));
    return unit;
  }
  return agreed_unit(lines, counts.line, "", options);
}

}  // namespace

Record read_peer(const Lines& lines, const ReadOptions& options) {
  const Counts counts = find_counts(lines);
  const MotionUnit& unit = find_header_unit(lines, counts, options);
  Record record;
  record.title = std::string(trimmed(counts.line > 2 ? lines.line[1] : lines.line[0]));
  record.unit = unit.symbol;
  record.quantity = unit.quantity;
  record.dt = agreed_step(lines, counts.line, counts.dt, options);
  record.value = numbers_from(lines, counts.line + 1);
  if (record.value.size() < counts.count)
    fail(lines, lines.count(),
         fmt::format("the file ends after {} of {} values (NPTS)", record.value.size(), counts.count),
         "it is cut short: fetch it again");
  if (record.value.size() > counts.count)
    fail(lines, lines.count(),
         fmt::format("there are {} values, but NPTS is {}", record.value.size(), counts.count),
         "correct NPTS, or take away what does not belong to the record");
  for (double& v : record.value) v *= unit.factor;
  return record;
}

}  // namespace talus::record
