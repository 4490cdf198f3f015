#include "talus/record/read_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "talus/base/error.h"
#include "talus/base/text_file.h"
#include "talus/record/formats.h"

namespace talus::record {

namespace {

constexpr size_t kLongestHeader = 20;                     // no format has a longer header
constexpr double kShortestStep = 1e-5, kLongestStep = 1;  // [s] beyond, a unit was mistaken

bool holds(const std::string& line, std::string_view word) {
  return lower_case(line).find(word) != std::string::npos;
}

}  // namespace

std::string_view name_of(Format format) {
  constexpr std::array<std::string_view, 4> names{"PEER", "K-NET", "JMA", "CSV"};
  return names[static_cast<size_t>(format)];
}

Format recognised(const Lines& lines) {
  const size_t n = std::min(lines.count(), kLongestHeader);
  const auto any = [&](std::string_view word) {
    return std::any_of(lines.line.begin(), lines.line.begin() + static_cast<std::ptrdiff_t>(n),
                       [&](const std::string& l) { return holds(l, word); });
  };
  if (any("origin time") || any("scale factor")) return Format::kKnet;
  if (any("site code") || any("sampling rate")) return Format::kJma;
  if (any("npts") || any("in units of")) return Format::kPeer;
  return Format::kCsv;
}

std::string read_record_file(const std::filesystem::path& path) {
  try {
    return read_text_file(path);
  } catch (const FileError& e) {
    throw FileError(
        fmt::format("{}\n      = check the path; it counts from the folder that talus runs in", e.what()));
  }
}

Record read_record(const std::filesystem::path& path, const ReadOptions& options) {
  return read_record_text(path.string(), read_record_file(path), options);
}

Record read_record_text(const std::string& file, const std::string& text, const ReadOptions& options) {
  const Lines lines = split_lines(file, text);
  const Format format = options.format.value_or(recognised(lines));
  Record record = format == Format::kPeer   ? read_peer(lines, options)
                  : format == Format::kKnet ? read_knet(lines, options)
                  : format == Format::kJma  ? read_jma(lines, options)
                                            : read_plain_csv(lines, options);
  record.format = format;
  if (record.value.size() < 2)
    fail(lines, lines.count(),
         fmt::format("the record has {} value{}", record.value.size(), record.value.size() == 1 ? "" : "s"),
         "a motion needs at least two");
  if (record.dt < kShortestStep || record.dt > kLongestStep)
    fail(lines, 0, fmt::format("the time step is {:g} s", record.dt),
         fmt::format("steps of a motion are {:g} to {:g} s; is the unit of the time the right one?",
                     kShortestStep, kLongestStep));
  return record;
}

const MotionUnit& agreed_unit(const Lines& lines, size_t number, const std::string& text,
                              const ReadOptions& options) {
  const MotionUnit* given = options.unit.empty() ? nullptr : find_unit(options.unit);
  if (!options.unit.empty() && !given)
    fail(lines, 0, fmt::format("--unit {}: the unit is not known", options.unit),
         "units are " + known_units());
  if (text.empty()) {
    if (!given)
      fail(lines, number, "no unit of the values is named",
           "say it with --unit, or in the title as \"acceleration [m/s2]\"; units are " + known_units());
    return *given;
  }
  const MotionUnit* named = find_unit(text);
  if (!named)
    fail(lines, number, fmt::format("the unit \"{}\" is not known", text), "units are " + known_units());
  if (given && (given->quantity != named->quantity || given->factor != named->factor))
    fail(lines, number, fmt::format("the unit is named twice: {} here, {} by --unit", text, options.unit),
         "leave --unit out, or correct the file");
  return *named;
}

const MotionUnit* only_unit_in(const Lines& lines, size_t number, std::string_view text) {
  const MotionUnit* found = nullptr;
  size_t at = 0;
  while (at < text.size()) {
    const size_t from = text.find_first_not_of(" \t(),;:", at);
    if (from == std::string_view::npos) break;
    at = std::min(text.find_first_of(" \t(),;:", from), text.size());
    std::string_view word = text.substr(from, at - from);
    while (!word.empty() && word.back() == '.') word.remove_suffix(1);
    const MotionUnit* unit = find_unit(word);
    if (!unit) continue;
    if (found && (found->quantity != unit->quantity || found->factor != unit->factor))
      fail(lines, number, fmt::format("two units are named: {} and {}", found->symbol, unit->symbol),
           "leave the right one only");
    if (!found) found = unit;
  }
  return found;
}

double agreed_step(const Lines& lines, size_t number, double dt, const ReadOptions& options) {
  if (!(dt > 0))
    fail(lines, number, fmt::format("the time step is {:g} s", dt),
         "it must be above 0 s; correct the header");
  if (options.dt && std::abs(*options.dt - dt) > 1e-6 * dt)
    fail(lines, number, fmt::format("the time step is {:g} s here, {:g} s by --dt", dt, *options.dt),
         "leave --dt out, or correct the file");
  return dt;
}

}  // namespace talus::record
