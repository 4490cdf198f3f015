#pragma once
// The reader of each format; read_record.h chooses. All throw InputError with file and line.

#include "talus/record/lines.h"
#include "talus/record/record.h"

namespace talus::record {

/// PEER: titles, "... IN UNITS OF G", count and step, then the values.
Record read_peer(const Lines& lines, const ReadOptions& options);
/// K-NET and KiK-net: 17 header lines, then counts of the logger.
Record read_knet(const Lines& lines, const ReadOptions& options);
/// JMA: header lines with "=", a line of components, then rows.
Record read_jma(const Lines& lines, const ReadOptions& options);
/// CSV with a title line, or bare numbers.
Record read_plain_csv(const Lines& lines, const ReadOptions& options);

/// The unit `text` found on line `number`, agreeing with what the command line says. Throws when it is
/// unknown, missing, or contradicted.
/// @param text  "" when the file names none
const MotionUnit& agreed_unit(const Lines& lines, size_t number, const std::string& text,
                              const ReadOptions& options);

/// The units that the words of `text` name. Throws when they are two different ones; nullptr when there is
/// none.
const MotionUnit* only_unit_in(const Lines& lines, size_t number, std::string_view text);

/// Step [s] of the file, agreeing with --dt. Throws unless it is positive and the same.
double agreed_step(const Lines& lines, size_t number, double dt, const ReadOptions& options);

}  // namespace talus::record
