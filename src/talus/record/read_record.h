#pragma once
// Strong-motion records from files: PEER (AT2, VT2, DT2), K-NET and KiK-net ASCII, JMA CSV, plain CSV.
// The format is known from the content. Values become SI; g is 9.80665 m/s2.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "talus/record/lines.h"
#include "talus/record/units.h"

namespace talus::record {

enum class Format { kPeer, kKnet, kJma, kCsv };

/// "PEER", "K-NET", "JMA", "CSV"
std::string_view name_of(Format format);

/// What the first lines look like; CSV when they look like nothing else.
Format recognised(const Lines& lines);

/// One component of a record at equal time steps; sample i stands at i dt.
struct Record {
  Format format = Format::kCsv;
  std::string title;  // event, station and component, or the title of the column
  std::string unit;   // as in the file
  Quantity quantity = Quantity::kAcceleration;
  double dt = 0;              // [s]
  std::vector<double> value;  // [n] SI
  double offset = 0;          // [SI] mean that the reader took off (raw counts of K-NET), 0: none
};

/// What the command line says about the file; everything may be absent.
struct ReadOptions {
  std::optional<Format> format;
  std::string column;        // title, quantity or component; "": the only one, or the only acceleration
  std::string unit;          // of the values, where the file names none
  std::optional<double> dt;  // [s] where the file has no time column
};

/// The text of a record, or of another table. Throws FileError with a next move.
std::string read_record_file(const std::filesystem::path& path);

/// Reads one component. Throws FileError when the file cannot be read, InputError (file:line, what was found,
/// what to do next) when it cannot be understood, is cut short or contradicts itself or `options`.
Record read_record(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same from text. @param file  name for messages
Record read_record_text(const std::string& file, const std::string& text, const ReadOptions& options = {});

}  // namespace talus::record
