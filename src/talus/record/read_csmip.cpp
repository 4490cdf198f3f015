// CSMIP (CDMG, SMIP) volume 2: corrected accelerograms of California, a block of three series for each channel.

#include <fmt/format.h>

#include <regex>

#include "talus/base/text.h"
#include "talus/record/formats.h"

namespace talus::record {

namespace {

// "  7500 points of accel data equally spaced at  .010 sec, in cm/sec2. (8f10.6)", and until about 1990
// "3251 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)"
const std::regex& csmip_series() {
  static const std::regex pattern(
      R"(^\s*(\d+)\s+points of accel data equally spaced at\s+([0-9.]+)\s+sec[.,]\s+(?:in|\(units:)\s+([a-z0-9/]+)\.?\s*(?:\((\d+)f(\d+)\.\d+\))?)",
      std::regex::icase);
  return pattern;
}

struct CsmipChannel {
  std::string title;  // "Chan  1:  H1"
  size_t series = 0;  // line that tells of the acceleration
  size_t band = 0;    // line that tells of the filter, 0: none
};

std::vector<CsmipChannel> csmip_channels(const Lines& lines) {
  static const std::regex kChannel(R"((chan(nel)?\s*\d+:\s*.*?)\s+from)", std::regex::icase);
  std::vector<CsmipChannel> out;
  CsmipChannel next;
  for (size_t n = 1; n <= lines.count(); ++n) {
    const std::string& line = lines.line[n - 1];
    const std::string lower = lower_case(line.substr(0, 200));
    if (lower.find("corrected accelerogram") == 0) {
      std::smatch match;
      check_header_line(lines, n);
      next = {};
      next.title = std::regex_search(line, match, kChannel) ? match[1].str()
                                                            : fmt::format("channel {}", out.size() + 1);
    } else if (lower.find("bandpass") != std::string::npos || lower.find("band-pass") != std::string::npos) {
      next.band = n;
    } else if (lower.find("points of accel data") != std::string::npos) {
      next.series = n;
      out.push_back(next);
    }
  }
  if (out.empty())
    fail(lines, 1, "this CSMIP file holds no corrected acceleration",
         "talus reads volume 2 (.V2); volume 1 and raw files are not read");
  return out;
}

}  // namespace

Record read_csmip(const Lines& lines, const ReadOptions& options) {
  const std::vector<CsmipChannel> channels = csmip_channels(lines);
  std::vector<std::string> titles;
  for (const CsmipChannel& c : channels) titles.push_back(c.title);
  const CsmipChannel& channel = channels[chosen_part(lines, titles, options, "channel")];
  check_header_line(lines, channel.series);
  std::smatch match;
  if (!std::regex_search(lines.line[channel.series - 1], match, csmip_series()))
    fail(lines, channel.series,
         fmt::format("count, step, unit and format are not understood: \"{}\"",
                     trimmed(lines.line[channel.series - 1])),
         "it is written as \"7500 points of accel data equally spaced at .010 sec, in cm/sec2. (8f10.6)\"");
  const MotionUnit& unit = agreed_unit(lines, channel.series, match[3].str(), options);
  Record record;
  record.title =
      fmt::format("{}, {}", trimmed(lines.line.size() > 6 ? lines.line[6] : lines.line[0]), channel.title);
  record.unit = unit.symbol;
  record.quantity = unit.quantity;
  record.dt = agreed_step(lines, channel.series,
                          number_at(lines, channel.series, match[2].str(), "the time step"), options);
  const auto count = count_at(lines, channel.series, match[1].str(), "the number of points");
  constexpr size_t kUsual = 10;  // where the line does not tell
  const size_t width =
      match[5].matched ? count_at(lines, channel.series, match[5].str(), "the width of a field") : kUsual;
  record.value = fixed_numbers(lines, channel.series + 1, count, std::max<size_t>(width, 1));
  for (double& v : record.value) v *= unit.factor;
  record.processed =
      channel.band ? std::string(trimmed(lines.line[channel.band - 1])) : "instrument and baseline corrected";
  return record;
}

}  // namespace talus::record
