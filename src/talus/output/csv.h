#pragma once
// Tables of numbers: written row by row, and read.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "talus/base/descriptor.h"

namespace talus {

/// A table that grows by whole rows. The end of a line is the mark that its row is whole: rows wait in memory
/// and go to the file many at a time, and what a full disk took of a row is taken back. Rows that wait when the object ends are
/// lost: flush() tells of failures, a destructor cannot.
class CsvWriter {
 public:
  /// Begins a table: columns joined by commas. Throws FileError when the path holds anything but a regular
  /// file.
  CsvWriter(std::filesystem::path path, const std::vector<std::string>& columns);
  /// Goes on behind the first `size` bytes of a table; what follows them is cut off. Throws FileError when
  /// there are fewer, or when the file is no regular file of this name alone.
  CsvWriter(std::filesystem::path path, int64_t size);
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  /// One row, numbers with 17 significant digits. Throws FileError.
  void append(const std::vector<double>& row);
  /// Hands the waiting rows to the system. Throws FileError; the file then ends with a whole row.
  void flush();
  /// Throws FileError when what was handed over is not all there, under its name: somebody has removed, replaced or
  /// shortened the file.
  void check() const;
  /// Bytes written so far, the waiting ones included.
  int64_t size() const { return size_ + static_cast<int64_t>(waiting_.size()); }

 private:
  std::filesystem::path path_;
  Descriptor file_;
  int64_t size_ = 0;  // in the file
  std::string waiting_;
};

struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> values;  // [column][row]
  bool cut_short = false;                   // the last line had no end, and was left out (LastLine::kMustEnd)

  /// The column called `name`, or the only one that begins with it. Throws FileError naming the columns there
  /// are.
  const std::vector<double>& column(const std::string& name) const;
  size_t rows() const { return values.empty() ? 0 : values[0].size(); }
};

/// What becomes of a last line without line end. Of a table that talus wrote it is what a killed run left of
/// a row: it is left out, and a table of nothing else has no columns. In anyone's table it is a row.
enum class LastLine { kMustEnd, kMayEnd };

/// Reads a table of numbers. Throws FileError with name or path, and line.
CsvTable parse_csv(const std::string& name, std::string_view text, LastLine last);
CsvTable read_csv(const std::filesystem::path& path, LastLine last = LastLine::kMayEnd);

}  // namespace talus
