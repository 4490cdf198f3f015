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
/// ESM and ITACA (DYNA 1.2): "KEY: value" lines, then a value a line.
Record read_esm(const Lines& lines, const ReadOptions& options);
/// GeoNet V2A: blocks of a component each, 26 lines, then acceleration, velocity, displacement in fields of 8.
Record read_geonet(const Lines& lines, const ReadOptions& options);
/// CSMIP (CDMG) volume 2: blocks of a channel each, with a line before each series that tells its format.
Record read_csmip(const Lines& lines, const ReadOptions& options);
/// COSMOS v1.20, corrected or uncorrected acceleration: text, integer and real header, comments, values.
Record read_cosmos(const Lines& lines, const ReadOptions& options);
/// SMC of the USGS: 11 lines of text, 48 integers, 50 reals, comments, values in fields of 10.
Record read_smc(const Lines& lines, const ReadOptions& options);

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

/// The part that `options.column` names, the only one where it names none. Throws with what there is.
/// @param what  "component", "channel"
size_t chosen_part(const Lines& lines, const std::vector<std::string>& titles, const ReadOptions& options,
                   const std::string& what);

/// Step [s] of the file, agreeing with --dt. Throws unless it is positive and the same.
double agreed_step(const Lines& lines, size_t number, double dt, const ReadOptions& options);

}  // namespace talus::record
