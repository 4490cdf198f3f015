#pragma once
// What the user asked of maps: which layers of which drawings become what, and how their lines are cleaned.

#include <limits>
#include <string>
#include <vector>

#include "talus/base/angle.h"
#include "talus/base/vec2.h"
#include "talus/schema/findings.h"

namespace talus {

enum class MapUse { kJoints, kFault, kOutline, kOpening, kStone, kBolt, kMonitor, kIgnored };

/// The words of the model file, in the order of MapUse.
const std::vector<std::string>& map_use_names();

/// Units of drawings: m, mm, cm, km, in, ft.
const std::vector<std::string>& drawing_unit_names();
/// Metres in one unit of a drawing by its name; NaN for others.
double drawing_unit(const std::string& name);

/// One [[map]]: some features of a file and what they become.
struct MapInput {
  std::string name;                 // of the section that comes of it, or its beginning
  std::string file;                 // relative to the model file
  std::string layer = "*";          // of the file; a * at the end stands for any text
  std::string attribute;            // "": any feature of the layer
  std::vector<std::string> values;  // of the attribute
  double unit = std::numeric_limits<double>::quiet_NaN();  // [m] of one unit of the file; NaN: the file says
  MapUse use = MapUse::kJoints;
  std::string joint, material, type;  // names in the model; "": none
  std::string kind;                   // of outlines and stones, "": deformable
  bool rock_kept = false;             // openings
  Where where, where_file, where_layer, where_attribute, where_unit;
};

/// [maps]: what holds for all of them.
struct MapsInput {
  double snap = 0;                   // [m] ends this near to another line are joined to it
  double shortest = 0;               // [m] shorter lines and segments are left out
  double curve_step = 10 * kDegree;  // [rad] of arcs between two points
  bool has_origin = false;
  Vec2 origin;  // [m] of the map, becomes (0, 0)
  std::vector<MapInput> list;
};

}  // namespace talus
