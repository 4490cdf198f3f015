// GeoNet V2A: corrected accelerograms of New Zealand, a block of three series for each component.

#include <fmt/format.h>

#include <regex>

#include "talus/base/text.h"
#include "talus/record/formats.h"

namespace talus::record {

namespace {

constexpr size_t kGeonetHeader = 26;  // lines of text and numbers in front of the series
constexpr size_t kGeonetWidth = 8;    // of a value

struct GeonetBlock {
  size_t begin = 0;  // its first line
  std::string component;
};

// What `pattern` catches on a line of a block.
std::string caught(const Lines& lines, size_t n, const std::regex& pattern, const char* what) {
  if (n > lines.count())
    fail(lines, lines.count(), "the header ends too early", "the file is cut short: fetch it again");
  check_header_line(lines, n);
  std::smatch match;
  if (!std::regex_search(lines.line[n - 1], match, pattern))
    fail(lines, n, fmt::format("{} is not found: \"{}\"", what, trimmed(lines.line[n - 1])),
         "it stands there in a V2A file of GeoNet");
  return match[1].str();
}

std::vector<GeonetBlock> geonet_blocks(const Lines& lines) {
  std::vector<GeonetBlock> out;
  for (size_t n = 1; n <= lines.count(); ++n) {
    if (lower_case(lines.line[n - 1]).rfind("corrected accelerogram", 0) != 0) continue;
    const size_t at = n + 12;  // "Component N28W  Longitudinal ..."
    if (at > lines.count())
      fail(lines, lines.count(), "the header ends too early", "the file is cut short: fetch it again");
    const std::string_view line = trimmed(lines.line[at - 1]);
    constexpr std::string_view kWord = "Component ";
    if (line.substr(0, kWord.size()) != kWord)
      fail(lines, at, fmt::format("the component is not found: \"{}\"", line),
           "it stands there in a V2A file of GeoNet");
    const std::string_view rest = trimmed(line.substr(kWord.size()));
    out.push_back({n, std::string(rest.substr(0, rest.find(' ')))});
  }
  return out;
}

}  // namespace

Record read_geonet(const Lines& lines, const ReadOptions& options) {
  static const std::regex kPoints(R"(points\s+(\d+))", std::regex::icase);
  static const std::regex kStep(R"(at\s+([0-9.]+)\s+sec)", std::regex::icase);
  static const std::regex kBand(
      R"(bands are\s+([0-9.]+)\s*-\s*([0-9.]+)\s*Hz and\s+([0-9.]+)\s*-\s*([0-9.]+))", std::regex::icase);
  const std::vector<GeonetBlock> blocks = geonet_blocks(lines);
  std::vector<std::string> components;
  for (const GeonetBlock& b : blocks) components.push_back(b.component);
  const GeonetBlock& block = blocks[chosen_part(lines, components, options, "component")];
  const size_t n = block.begin;
  const MotionUnit& unit =
      agreed_unit(lines, n + 13, "mm/s2", options);  // "Acceleration: peak -9733.1 mm/s/s"
  Record record;
  record.title = fmt::format("{}, {}", trimmed(lines.line[n - 1]), block.component);
  record.unit = unit.symbol;
  record.quantity = unit.quantity;
  const size_t count =
      count_at(lines, n + 9, caught(lines, n + 9, kPoints, "the number of points"), "the number of points");
  record.dt = agreed_step(
      lines, n + 10, number_at(lines, n + 10, caught(lines, n + 10, kStep, "the time step"), "the time step"),
      options);
  record.value = fixed_numbers(lines, n + kGeonetHeader, count, kGeonetWidth);
  for (double& v : record.value) v *= unit.factor;
  std::smatch band;
  check_header_line(lines, n + 11);
  if (std::regex_search(lines.line[n + 10], band, kBand))
    record.processed = fmt::format("band-pass, transition bands {} to {} and {} to {} Hz", band[1].str(),
                                   band[2].str(), band[3].str(), band[4].str());
  else
    record.processed = std::string(trimmed(lines.line[n + 10]));
  return record;
}

}  // namespace talus::record
