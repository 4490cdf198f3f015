#pragma once
// What `talus import` does: a map, and words of the user for its layers, to sections of a model file.

#include <string>
#include <vector>

#include "talus/maps/sections.h"

namespace talus::maps {

struct ImportRequest {
  std::string file, attribute, unit = "auto";
  std::vector<std::string> uses;  // "LAYER=joints"; empty: guessed
  MapsInput maps;                 // its list is filled here
};

/// Sections named after layers, or values of the attribute. Where no use is given it is guessed from the name
/// (outline, boundary, tunnel, bolt ...) and the shapes, and told as a warning. Wrong words and all that
/// make_sections finds go to `findings`.
MapSections import_map(const ImportRequest& request, const DrawingReader& reader, Findings& findings);

/// What lies on a layer, or has one value of an attribute.
struct Content {
  bool points = false, lines = false, areas = false;
};

/// The use that the name of a layer and what lies on it suggest. Areas are outlines unless the name says
/// otherwise, never joints.
MapUse guessed_use(const std::string& layer, const Content& holds);

}  // namespace talus::maps
