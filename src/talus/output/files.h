#pragma once
// Writing result files so that a reader never meets half a file, and every failure is reported.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Writes a whole file under a temporary name and renames it into place. Throws FileError (path, cause).
void write_file(const std::filesystem::path& path, const std::string& content);

/// Throws FileError when the folder holds anything and `force` is false, or when what it holds is no (even
/// unfinished) result of talus: then even `force` would remove nothing. Changes nothing.
void check_result_folder(const std::filesystem::path& folder, bool force);

/// Prepares the folder for results, checked as above.
/// Of an earlier run, cut, record, safety or picture only the files of the same kind are removed.
enum class ResultKind { kRun, kCut, kRecord, kSafety, kPicture };
void open_result_folder(const std::filesystem::path& folder, bool force, ResultKind kind = ResultKind::kRun);

/// A table written row by row; every row is complete in the file when append() returns after flush().
class CsvWriter {
 public:
  /// Writes the header: columns joined by commas.
  CsvWriter(std::filesystem::path path, const std::vector<std::string>& columns);
  /// Goes on behind the first `size` bytes of a table; what follows them is cut off. Throws FileError when
  /// there are fewer.
  CsvWriter(std::filesystem::path path, int64_t size);
  ~CsvWriter();
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  /// One row, numbers with 17 significant digits. Throws FileError.
  void append(const std::vector<double>& row);
  void flush();
  /// Bytes written so far, the waiting ones included.
  int64_t size() const;

 private:
  void check(bool ok) const;

  std::filesystem::path path_;
  std::FILE* file_ = nullptr;
  std::string line_;
};

struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> values;  // [column][row]

  /// The column called `name`, or the only one that begins with it. Throws FileError naming the columns there
  /// are.
  const std::vector<double>& column(const std::string& name) const;
  size_t rows() const { return values.empty() ? 0 : values[0].size(); }
};

/// Reads a table of numbers. Throws FileError with path and line.
CsvTable read_csv(const std::filesystem::path& path);

}  // namespace talus
