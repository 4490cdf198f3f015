#pragma once
// Tables with texts in them, as joints.csv, slips.csv, bolts.csv and blocks.csv are: cells apart by commas, a
// cell with commas in double quotes.

#include <filesystem>
#include <string>
#include <vector>

namespace talus {

struct TextTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // [row][column]

  /// Index of the column, -1 when there is none.
  int find(const std::string& column) const;
};

/// A cell as it is written: in quotes where it needs them.
std::string table_cell(const std::string& text);

/// @param name  of the file, for messages
TextTable parse_text_table(const std::string& name, const std::string& text);
/// Throws FileError with path and line.
TextTable read_text_table(const std::filesystem::path& path);

}  // namespace talus
