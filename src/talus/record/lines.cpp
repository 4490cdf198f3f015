#include "talus/record/lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "talus/base/error.h"
#include "talus/base/text.h"
#include "talus/record/units.h"

namespace talus::record {

namespace {

// Fixed columns of Fortran leave no blank before a minus sign: cuts "1.2E-3-4.5E-3" after the first number.
size_t end_of_number(std::string_view token) {
  for (size_t i = 1; i < token.size(); ++i) {
    const bool sign = token[i] == '-' || token[i] == '+';
    const char before = token[i - 1];
    if (sign && ((before >= '0' && before <= '9') || before == '.')) return i;
  }
  return token.size();
}

}  // namespace

Lines split_lines(const std::string& file, const std::string& whole) {
  Lines lines{file, {}};
  // old media filled the last sector with zeros, or ended it with Ctrl-Z
  const size_t last = whole.find_last_not_of(std::string_view("\0\x1a", 2));
  const std::string_view text = std::string_view(whole).substr(0, last == std::string::npos ? 0 : last + 1);
  if (text.find('\0') != std::string_view::npos)
    fail(
        lines, 0, "is not a text file",
        "records are text: PEER, K-NET, JMA, ESM, GeoNet, CSMIP, COSMOS, SMC or a table; SAC and miniSEED are not read");
  size_t begin = 0;
  while (begin < text.size()) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    lines.line.emplace_back(text.substr(begin, end - begin));
    if (!lines.line.back().empty() && lines.line.back().back() == '\r') lines.line.back().pop_back();
    begin = end + 1;
  }
  const bool blank = std::all_of(lines.line.begin(), lines.line.end(),
                                 [](const std::string& l) { return trimmed(l).empty(); });
  if (blank) fail(lines, 0, "is empty", "fetch or write the file again");
  return lines;
}

void fail(const Lines& lines, size_t number, const std::string& text, const std::string& hint) {
  const std::string place = number > 0 ? fmt::format("{}:{}", lines.file, number) : lines.file;
  throw InputError(fmt::format("{}: error: {}\n      = {}", place, text, hint));
}

void check_header_line(const Lines& lines, size_t number) {
  constexpr size_t kMost = 1000;  // [bytes]
  if (number > lines.count())
    fail(lines, lines.count(), "the header ends too early", "the file is cut short: fetch it again");
  const size_t size = lines.line[number - 1].size();
  if (size > kMost)
    fail(lines, number, fmt::format("a line of the header has {} bytes, more than {}", size, kMost),
         "correct the line, or fetch the record again");
}

double number_at(const Lines& lines, size_t number, std::string_view token, std::string_view what) {
  std::string plain(trimmed(token));
  if (!plain.empty() && plain[0] == '+') plain.erase(0, 1);
  for (char& c : plain)
    if (c == 'D' || c == 'd') c = 'E';
  double v = 0;
  const char* end = plain.data() + plain.size();
  const auto [stop, status] = std::from_chars(plain.data(), end, v);
  const std::string hint = "correct the line, or cut what does not belong to the record";
  if (status == std::errc::result_out_of_range)
    fail(lines, number, fmt::format("{}: \"{}\" is beyond the range of numbers", what, token), hint);
  if (status != std::errc{} || stop != end)
    fail(lines, number, fmt::format("{}: \"{}\" is not a number", what, token), hint);
  if (!std::isfinite(v))
    fail(lines, number, fmt::format("{}: \"{}\" is not a finite number", what, token), hint);
  return v;
}

size_t count_at(const Lines& lines, size_t number, std::string_view token, std::string_view what) {
  const double value = number_at(lines, number, token, what);
  if (!(value >= 1 && value <= 1e9) || value != std::floor(value))
    fail(lines, number, fmt::format("{} is {:g}", what, value),
         "it must be a whole number from 1 on: fetch the file again");
  return static_cast<size_t>(value);
}

std::vector<double> numbers_from(const Lines& lines, size_t first, Numbers kind) {
  std::vector<double> out;
  for (size_t n = first; n <= lines.count(); ++n) {
    std::string_view rest = trimmed(lines.line[n - 1]);
    while (!rest.empty()) {
      const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
      const std::string_view token = word.substr(0, end_of_number(word));
      out.push_back(number_at(lines, n, token, fmt::format("value {}", out.size() + 1)));
      if (kind == Numbers::kWhole && out.back() != std::floor(out.back()))
        fail(lines, n, fmt::format("{} is not a whole count of the logger", token),
             "K-NET data are integers; read other tables as CSV: --format csv");
      rest = trimmed(rest.substr(token.size()));
    }
  }
  return out;
}

std::vector<double> fixed_numbers(const Lines& lines, size_t first, size_t count, size_t width,
                                  size_t* next) {
  std::vector<double> out;
  out.reserve(std::min<size_t>(count, 1000000));
  size_t n = first;
  for (; out.size() < count; ++n) {
    if (n > lines.count())
      fail(lines, lines.count(), fmt::format("the file ends after {} of {} values", out.size(), count),
           "it is cut short: fetch it again");
    const std::string_view line = lines.line[n - 1];
    const size_t before = out.size();
    for (size_t at = 0; at < line.size() && out.size() < count; at += width) {
      const std::string_view field = trimmed(line.substr(at, width));
      if (field.empty()) break;
      out.push_back(number_at(lines, n, field, fmt::format("value {}", out.size() + 1)));
    }
    if (out.size() == before)
      fail(lines, n, fmt::format("an empty line after {} of {} values", out.size(), count),
           "it is cut short: fetch it again");
  }
  if (next) *next = n;
  return out;
}

}  // namespace talus::record
