#pragma once
// A drawing or map as plain data, whatever format it came in. Filled by the module that reads vector files
// (vector_module.h); nothing here needs a library.

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "talus/base/vec2.h"

namespace talus::maps {

/// A line or point of a drawing.
struct Feature {
  std::string layer;
  std::string id;  // what the file calls it, as in messages: "feature 17", "entity 3B"
  std::map<std::string, std::string> attributes;
  bool is_point = false;
  bool is_area = false;      // ring of an area
  bool is_hole = false;      // inner ring of an area
  std::vector<Vec2> points;  // in units of the drawing; one for a point; a closed line repeats its first
};

/// Features of one layer that were left out for one reason.
struct LeftOut {
  std::string layer, what, reason;  // "TEXT", "is no line"
  int count = 0;
};

struct Drawing {
  std::string format;                                      // "DXF", "GPKG" ... as the reader calls it
  double unit = std::numeric_limits<double>::quiet_NaN();  // [m] of one unit; NaN: the file does not say
  std::string unit_source;                                 // how that is known: "$INSUNITS = 4 (mm)"
  bool geographic = false;                                 // degrees of longitude and latitude
  std::vector<Feature> features;
  std::vector<LeftOut> left_out;
  std::vector<std::string> notes;  // of the reader, worth a warning
  int unreadable = 0;              // entities of a DXF that the reader gave up
  std::string first_failure;       // what it said of the first

  /// Counts one feature that was left out.
  void leave_out(const std::string& layer, const std::string& what, const std::string& reason,
                 int count = 1) {
    for (LeftOut& l : left_out) {
      if (l.layer == layer && l.what == what && l.reason == reason) {
        l.count += count;
        return;
      }
    }
    left_out.push_back({layer, what, reason, count});
  }
};

}  // namespace talus::maps
