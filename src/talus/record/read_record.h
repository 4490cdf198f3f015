#pragma once
// Strong-motion records from files: PEER (AT2, VT2, DT2), K-NET and KiK-net ASCII, JMA CSV, ESM and ITACA ASC, GeoNet V2A,
// CSMIP V2, COSMOS V1 and V2, SMC, plain CSV.
// The format is known from the content. Values become SI; g is 9.80665 m/s2.

#include <filesystem>
#include <string>

#include "talus/record/lines.h"
#include "talus/record/record.h"

namespace talus::record {

/// What the first lines look like; CSV when they look like nothing else.
Format recognised(const Lines& lines);

/// Throws InputError where the lines are neither a table nor any format that is read, with the likely name of it.
void check_known(const Lines& lines);

/// The text of a record, or of another table. Throws FileError with a next move.
std::string read_record_file(const std::filesystem::path& path);

/// Reads one component. Throws FileError when the file cannot be read, InputError (file:line, what was found,
/// what to do next) when it cannot be understood, is cut short or contradicts itself or `options`.
Record read_record(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same from text. @param file  name for messages
Record read_record_text(const std::string& file, const std::string& text, const ReadOptions& options = {});

}  // namespace talus::record
