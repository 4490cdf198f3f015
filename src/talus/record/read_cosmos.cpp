// COSMOS v1.20: acceleration of volume 1 and 2, as the COSMOS virtual data centre and CESMD give it.

#include <fmt/format.h>

#include <regex>

#include "talus/base/text.h"
#include "talus/record/formats.h"

namespace talus::record {

namespace {

constexpr size_t kCosmosText = 13;  // lines of text
constexpr size_t kStepIndex = 61;   // in the real header: interval of the data [ms], counted from 0

// "42000 acceleration pts, approx  210 secs, units=cm/sec2(04),Format=(1E15.6)"
const std::regex& cosmos_series() {
  static const std::regex pattern(
      R"(^\s*(\d+)\s+accel[a-z.]*\s+(?:pts|points),?.*units\s*=\s*([a-z0-9/^]+)[^,]*,\s*format\s*=\s*\((?:\d+)?[ef](\d+)\.)",
      std::regex::icase);
  return pattern;
}

struct CosmosChannel {
  std::string title;
  size_t begin = 0, series = 0;  // lines
  double dt = 0;                 // [s]
  std::string filter;
};

// Count of values and width of the fields that "100 Real-header values follow on 20 lines, Format= (5F15.6)" tells.
std::vector<double> header_numbers(const Lines& lines, size_t n, size_t& next) {
  static const std::regex kTold(R"(^\s*(\d+)\s+.*header values follow.*\((?:\d+)[if](\d+))",
                                std::regex::icase);
  check_header_line(lines, n);
  std::smatch match;
  if (!std::regex_search(lines.line[n - 1], match, kTold))
    fail(lines, n, "the numbers of the header are not found",
         "it is written as \"100 Real-header values follow on 20 lines, Format= (5F15.6)\"");
  const auto count = count_at(lines, n, match[1].str(), "the number of values");
  const auto width = count_at(lines, n, match[2].str(), "the width of a field");
  return fixed_numbers(lines, n + 1, count, std::max<size_t>(width, 1), &next);
}

std::vector<CosmosChannel> cosmos_channels(const Lines& lines) {
  std::vector<CosmosChannel> out;
  for (size_t n = 1; n <= lines.count(); ++n) {
    const std::string head = lower_case(lines.line[n - 1].substr(0, 120));
    if (head.find("(format v") == std::string::npos) continue;
    CosmosChannel c;
    c.begin = n;
    if (n + kCosmosText > lines.count())
      fail(lines, lines.count(), "the header ends too early", "the file is cut short: fetch it again");
    c.title = std::string(trimmed(lines.line[n + 7]));    // "Sta Chan   1: 90 deg (Rcrdr Chan  1) Location:"
    c.filter = std::string(trimmed(lines.line[n + 10]));  // "Record filtered below ..."
    if (head.rfind("raw", 0) == 0 || head.find("counts") != std::string::npos)
      fail(lines, n, "these are raw counts of a recorder",
           "talus reads acceleration: volume 1 or 2 of the same record (.V1c, .V2c)");
    size_t at = n + kCosmosText;
    header_numbers(lines, at, at);
    const std::vector<double> real = header_numbers(lines, at, at);
    if (real.size() > kStepIndex) c.dt = 1e-3 * real[kStepIndex];
    for (; at <= lines.count(); ++at) {  // comments
      const std::string& line = lines.line[at - 1];
      if (line.empty() || line[0] == '|' ||
          lower_case(line.substr(0, 200)).find("comment line") != std::string::npos)
        continue;
      break;
    }
    c.series = at;
    if (at > lines.count())
      fail(lines, lines.count(), "the values are missing", "the file is cut short: fetch it again");
    if (lower_case(lines.line[at - 1].substr(0, 200)).find("accel") != std::string::npos) out.push_back(c);
    n = at;
  }
  if (out.empty())
    fail(lines, 1, "this COSMOS file holds no acceleration", "talus reads acceleration of volume 1 or 2");
  return out;
}

}  // namespace

Record read_cosmos(const Lines& lines, const ReadOptions& options) {
  const std::vector<CosmosChannel> channels = cosmos_channels(lines);
  std::vector<std::string> titles;
  for (const CosmosChannel& c : channels) titles.push_back(c.title);
  const CosmosChannel& channel = channels[chosen_part(lines, titles, options, "channel")];
  check_header_line(lines, channel.series);
  std::smatch match;
  if (!std::regex_search(lines.line[channel.series - 1], match, cosmos_series()))
    fail(lines, channel.series,
         fmt::format("count, unit and format are not understood: \"{}\"",
                     trimmed(lines.line[channel.series - 1])),
         "it is written as \"42000 acceleration pts, approx 210 secs, units=cm/sec2(04),Format=(1E15.6)\"");
  const MotionUnit& unit = agreed_unit(lines, channel.series, match[2].str(), options);
  Record record;
  record.title = fmt::format("{}, {}", trimmed(lines.line[channel.begin + 3]), channel.title);
  record.unit = unit.symbol;
  record.quantity = unit.quantity;
  record.dt = agreed_step(lines, channel.begin + kCosmosText + 1, channel.dt, options);
  const auto count = count_at(lines, channel.series, match[1].str(), "the number of points");
  const auto width = count_at(lines, channel.series, match[3].str(), "the width of a field");
  record.value = fixed_numbers(lines, channel.series + 1, count, std::max<size_t>(width, 1));
  for (double& v : record.value) v *= unit.factor;
  if (lower_case(lines.line[channel.begin - 1]).rfind("corrected", 0) == 0) record.processed = channel.filter;
  return record;
}

}  // namespace talus::record
