#include "talus/record/read_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"
#include "talus/record/formats.h"

namespace talus::record {

namespace {

constexpr size_t kLongestHeader = 20;                     // no format has a longer header
constexpr double kShortestStep = 1e-5, kLongestStep = 1;  // [s] beyond, a unit was mistaken

bool holds(const std::string& line, std::string_view word) {
  return lower_case(line).find(word) != std::string::npos;
}

// What a file looks like that is none of the formats read; "": a table, as far as one sees.
std::string foreign_format(const Lines& lines) {
  const auto line = [&](size_t k) {
    return k < lines.count() ? lower_case(lines.line[k].substr(0, 200)) : std::string();
  };
  const auto early = [&](std::string_view word) {
    for (size_t k = 0; k < kLongestHeader; ++k)
      if (line(k).find(word) != std::string::npos) return true;
    return false;
  };
  if (line(0).find("vol1ds") != std::string::npos) return "BHRC (ISMN, Iran)";
  if (line(0).rfind("#earthquake information", 0) == 0) return "CWA (CWB, Taiwan)";
  if (early("strong ground motion records of turk") || early("strong ground motion data of turk"))
    return "AFAD (Turkey)";
  if (line(0).rfind("uncorrected accelerogram", 0) == 0)
    return line(0).find("gns") != std::string::npos ? "GeoNet volume 1" : "CSMIP volume 1";
  if (line(0).find("raw data") != std::string::npos || early("unam"))
    return early("unam") ? "UNAM (Mexico)" : "";
  return "";
}

// Whether the lines are rows of numbers, or of as many cells, apart from a title and a row or two that may be wrong.
bool looks_like_table(const Lines& lines) {
  constexpr size_t kSeen = 40;
  size_t rows = 0, numbers = 0;
  std::map<std::ptrdiff_t, size_t> separators;  // how often each number of them
  for (size_t n = 0; n < lines.count() && rows < kSeen; ++n) {
    const std::string_view line = trimmed(lines.line[n]);
    if (line.empty() || line[0] == '#' || line[0] == '%') continue;
    ++rows;
    numbers += line.find_first_not_of("0123456789.,;+-eEdD \t") == std::string_view::npos;
    ++separators[std::count_if(line.begin(), line.end(),
                               [](char c) { return c == ',' || c == ';' || c == '\t'; })];
  }
  size_t alike = 0;
  for (const auto& [count, times] : separators)
    if (count > 0) alike = std::max(alike, times);
  return rows > 0 && (5 * numbers >= 3 * (rows - 1) || 5 * alike >= 3 * rows);
}

}  // namespace

// Before a row is blamed of what is no table.
void check_known(const Lines& lines) {
  const std::string likely = foreign_format(lines);
  if (likely.empty() && looks_like_table(lines)) return;
  fail(
      lines, 0,
      likely.empty() ? std::string("the format of this file is not known")
                     : fmt::format("this looks like a file of {}, a format that is not read", likely),
      "read are PEER (AT2, VT2, DT2), K-NET and KiK-net, JMA, ESM and ITACA (ASC), GeoNet V2A, CSMIP V2, COSMOS V1 and V2, SMC, and "
      "tables: \"time [s],acceleration [m/s2]\" above the rows, or bare values with --dt and --unit");
}

std::string_view name_of(Format format) {
  constexpr std::array<std::string_view, 9> names{"PEER",   "K-NET", "JMA",    "CSV", "ESM",
                                                  "GeoNet", "CSMIP", "COSMOS", "SMC"};
  return names[place_of(format)];
}

Format recognised(const Lines& lines) {
  const size_t n = std::min(lines.count(), kLongestHeader);
  const auto any = [&](std::string_view word) {
    return std::any_of(lines.line.begin(), lines.line.begin() + n,
                       [&](const std::string& l) { return holds(l, word); });
  };
  const std::string first = lower_case(lines.line[0].substr(0, 200));
  const bool gns = holds(first, "gns science") || holds(first, "geological & nuclear");
  if (holds(first, "(format v")) return Format::kCosmos;
  if (first.rfind("corrected accelerogram", 0) == 0) return gns ? Format::kGeonet : Format::kCsmip;
  if (first.size() > 2 && first[0] >= '1' && first[0] <= '4' && first[1] == ' ' &&
      (holds(first, "corrected accelerogram") || holds(first, "velocity") || holds(first, "displacement")))
    return Format::kSmc;
  if (first.rfind("event_name:", 0) == 0) return Format::kEsm;
  if (!foreign_format(lines).empty()) return Format::kCsv;
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
  if (format == Format::kCsv && !options.format) check_known(lines);
  using Reader = Record (*)(const Lines&, const ReadOptions&);
  constexpr std::array<Reader, 9> kReaders{read_peer,   read_knet,  read_jma,    read_plain_csv, read_esm,
                                           read_geonet, read_csmip, read_cosmos, read_smc};
  Record record = kReaders[place_of(format)](lines, options);
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

size_t chosen_part(const Lines& lines, const std::vector<std::string>& titles, const ReadOptions& options,
                   const std::string& what) {
  std::string list;
  for (const std::string& t : titles) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", t);
  if (titles.empty())
    fail(lines, 0, fmt::format("there is no {}", what), "the file is cut short: fetch it again");
  if (options.column.empty() && titles.size() == 1) return 0;
  std::vector<size_t> found;
  const std::string wanted = lower_case(options.column);
  for (size_t k = 0; k < titles.size() && !wanted.empty(); ++k) {
    if (lower_case(titles[k]) == wanted) return k;
    if (lower_case(titles[k]).find(wanted) != std::string::npos) found.push_back(k);
  }
  if (found.size() == 1) return found[0];
  fail(lines, 0,
       wanted.empty()     ? fmt::format("the file holds {} {}s", titles.size(), what)
       : found.size() > 1 ? fmt::format("\"{}\" may be {} {}s", options.column, found.size(), what)
                          : fmt::format("there is no {} \"{}\"", what, options.column),
       fmt::format("say which one: --column, in a model column = \"...\"; there is {}", list));
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
