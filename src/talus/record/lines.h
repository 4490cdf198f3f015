#pragma once
// A record file as numbered lines, the numbers on them, and errors that name file and line.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace talus::record {

struct Lines {
  std::string file;               // as shown in messages
  std::vector<std::string> line;  // without line ends; line[0] is line 1

  size_t count() const { return line.size(); }
};

/// @param text  the file; ends of lines may be LF or CR LF
/// Throws InputError when it is empty or not text.
Lines split_lines(const std::string& file, const std::string& text);

/// Throws InputError "file:line: error: text" with `hint`, the next move, below.
/// @param number  line from 1; 0: the file as a whole
[[noreturn]] void fail(const Lines& lines, size_t number, const std::string& text, const std::string& hint);

/// Throws by fail() where a line is longer than headers are: what takes them apart goes as deep as they are long.
void check_header_line(const Lines& lines, size_t number);

/// The number that `token` is (also ".5", "+1.2E-03", "1.2D-3"). Throws by fail() on text, nan, inf and
/// numbers too large for a double; `what` names the thing in the message.
double number_at(const Lines& lines, size_t number, std::string_view token, std::string_view what);

/// The same as a count or a width: a whole number from 1 to 1e9.
size_t count_at(const Lines& lines, size_t number, std::string_view token, std::string_view what);

enum class Numbers { kAny, kWhole };

/// All numbers from line `first` (from 1) on, any count per line, blanks or nothing before a sign between
/// them. Throws by fail(), also on a fraction where whole numbers are expected (counts of a logger).
std::vector<double> numbers_from(const Lines& lines, size_t first, Numbers kind = Numbers::kAny);

/// `count` numbers in columns of `width` characters from line `first` on: Fortran's fixed fields, which need no blank
/// between them. Throws by fail() where the lines end before.
/// @param next  the line behind them, when given
std::vector<double> fixed_numbers(const Lines& lines, size_t first, size_t count, size_t width,
                                  size_t* next = nullptr);

}  // namespace talus::record
