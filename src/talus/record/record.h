#pragma once
// One component of a strong-motion record, and what the command line says of its file.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "talus/record/units.h"

namespace talus::record {

enum class Format { kPeer, kKnet, kJma, kCsv, kEsm, kGeonet, kCsmip, kCosmos, kSmc };

/// "PEER", "K-NET", "JMA", "CSV", "ESM", "GeoNet", "CSMIP", "COSMOS", "SMC"
std::string_view name_of(Format format);

/// One component of a record at equal time steps; sample i stands at i dt.
struct Record {
  Format format = Format::kCsv;
  std::string title;  // event, station and component, or the title of the column
  std::string unit;   // as in the file
  Quantity quantity = Quantity::kAcceleration;
  double dt = 0;              // [s]
  std::vector<double> value;  // [n] SI
  std::string processed;      // what its header says was done to it, "": nothing
  double offset = 0;          // [SI] mean that the reader took off (raw counts of K-NET), 0: none
};

/// What the command line says about the file; everything may be absent.
struct ReadOptions {
  std::optional<Format> format;
  std::string column;        // title, quantity or component; "": the only one, or the only acceleration
  std::string unit;          // of the values, where the file names none
  std::optional<double> dt;  // [s] where the file has no time column
};

}  // namespace talus::record
