// SMC: the format of the strong-motion CD-ROM of the USGS.

#include <fmt/format.h>

#include "talus/base/text.h"
#include "talus/record/formats.h"

namespace talus::record {

namespace {

constexpr size_t kTexts = 11, kIntegers = 48, kReals = 50, kIntegerWidth = 10, kRealWidth = 15,
                 kSmcWidth = 10;
constexpr double kNone = 1.6e38;  // reals from here on mean that there is none

}  // namespace

Record read_smc(const Lines& lines, const ReadOptions& options) {
  size_t at = kTexts + 1;
  const std::vector<double> whole = fixed_numbers(lines, at, kIntegers, kIntegerWidth, &at);
  const size_t real_line = at;
  const std::vector<double> real = fixed_numbers(lines, at, kReals, kRealWidth, &at);
  const double comments = whole[15], count = whole[16], rate = real[1];
  if (!(comments >= 0 && comments <= static_cast<double>(lines.count())) || !(count >= 1 && count <= 1e9))
    fail(lines, kTexts + 2,
         fmt::format("{:g} lines of comments and {:g} values are not possible", comments, count),
         "they are the 16th and 17th integer of an SMC file: fetch it again");
  if (!(rate > 0 && rate < kNone))
    fail(lines, real_line, fmt::format("the sampling rate is {:g} per second", rate),
         "it is the second real number of an SMC file: fetch it again");
  const std::string kind = lower_case(lines.line[0]);
  const char* unit_text = kind.find("veloc") != std::string::npos   ? "cm/s"
                          : kind.find("displ") != std::string::npos ? "cm"
                          : kind.find("accel") != std::string::npos ? "cm/s2"
                                                                    : "";
  if (!*unit_text)
    fail(lines, 1, fmt::format("\"{}\" is no motion", trimmed(lines.line[0])),
         "talus reads acceleration, velocity and displacement of SMC files");
  const MotionUnit& unit = agreed_unit(lines, 1, unit_text, options);
  Record record;
  record.title = std::string(trimmed(lines.line[5]));  // "station = ... component= 133"
  record.unit = unit.symbol;
  record.quantity = unit.quantity;
  record.dt = agreed_step(lines, real_line, 1 / rate, options);
  record.value =
      fixed_numbers(lines, at + static_cast<size_t>(comments), static_cast<size_t>(count), kSmcWidth);
  for (double& v : record.value) v *= unit.factor;
  if (kind.find("uncorrected") == std::string::npos) record.processed = "corrected";
  return record;
}

}  // namespace talus::record
