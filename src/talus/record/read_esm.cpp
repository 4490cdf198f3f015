// ESM and ITACA: .ASC of the Engineering Strong-Motion database, header format DYNA.

#include <fmt/format.h>

#include <map>

#include "talus/base/text.h"
#include "talus/record/formats.h"

namespace talus::record {

namespace {

struct EsmEntry {
  size_t line = 0;
  std::string value;
};

}  // namespace

Record read_esm(const Lines& lines, const ReadOptions& options) {
  std::map<std::string, EsmEntry> header;
  size_t n = 1;
  for (; n <= lines.count(); ++n) {
    const std::string& line = lines.line[n - 1];
    const size_t colon = line.find(':');
    if (colon == std::string::npos) break;
    header[std::string(trimmed(std::string_view(line).substr(0, colon)))] = {
        n, std::string(trimmed(std::string_view(line).substr(colon + 1)))};
  }
  const auto asked = [&](const char* key) -> const EsmEntry& {
    const auto at = header.find(key);
    if (at == header.end() || at->second.value.empty())
      fail(lines, n, fmt::format("the header of this ESM file has no {}", key), "fetch the file again");
    return at->second;
  };
  const auto told = [&](const char* key) {
    const auto at = header.find(key);
    return at == header.end() ? std::string() : at->second.value;
  };
  const EsmEntry &unit_text = asked("UNITS"), &step = asked("SAMPLING_INTERVAL_S"),
                 &count_text = asked("NDATA");
  const MotionUnit& unit = agreed_unit(lines, unit_text.line, unit_text.value, options);
  Record record;
  record.title =
      fmt::format("{}, {} {}, {}", told("EVENT_NAME"), told("NETWORK"), told("STATION_CODE"), told("STREAM"));
  record.unit = unit.symbol;
  record.quantity = unit.quantity;
  record.dt =
      agreed_step(lines, step.line, number_at(lines, step.line, step.value, "SAMPLING_INTERVAL_S"), options);
  const double count = number_at(lines, count_text.line, count_text.value, "NDATA");
  record.value = numbers_from(lines, n);
  if (count != static_cast<double>(record.value.size()))
    fail(lines, lines.count(),
         fmt::format("there are {} values, but NDATA is {:g}", record.value.size(), count),
         "it is cut short or was changed: fetch it again");
  for (double& v : record.value) v *= unit.factor;
  if (!told("FILTER_TYPE").empty())
    record.processed = fmt::format(
        "{} filter of order {} from {} to {} Hz; {}", lower_case(told("FILTER_TYPE")), told("FILTER_ORDER"),
        told("LOW_CUT_FREQUENCY_HZ"), told("HIGH_CUT_FREQUENCY_HZ"), lower_case(told("BASELINE_CORRECTION")));
  return record;
}

}  // namespace talus::record
