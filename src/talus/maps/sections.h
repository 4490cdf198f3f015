#pragma once
// From the maps that a model asks for to the sections they become, as text of a model file, and a report of
// what was taken, mended and left out. Theory: docs/theory.md section 10.6.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "talus/maps/clean.h"
#include "talus/maps/drawing.h"
#include "talus/model/map_input.h"
#include "talus/schema/findings.h"

namespace talus::maps {

/// What came of one [[map]].
struct MapNote {
  std::string name, use, file;
  int features = 0;                 // taken
  int points = 0;                   // of its lines, after cleaning
  double length = 0;                // of its lines, after cleaning [m]
  int mended[5] = {0, 0, 0, 0, 0};  // by Mend::Kind
};

struct FileNote {
  std::string file, unit;  // "$INSUNITS = 4 (mm)"
  std::vector<LeftOut> left_out;
};

struct MapReport {
  std::vector<MapNote> maps;
  std::vector<FileNote> files;
  bool shifted = false;
  Vec2 origin;                         // [m] of the map, is (0, 0) of the model
  std::vector<Polyline> outlines;      // [m] regions and openings, closed
  std::vector<MapLine> before, after;  // joints and faults as drawn and as cleaned
  std::vector<Mend> mends;
};

struct MapSections {
  std::string text;  // sections of a model file; empty when there was an error
  MapReport report;
};

/// How a drawing comes to be read: read_drawing, or a substitute in tests.
using DrawingReader = std::function<Drawing(const std::filesystem::path&, double curve_step)>;

/// Reads the files of `maps`, takes the features they name, shifts and cleans them and writes the sections.
/// Everything wrong goes to `findings`.
/// @param folder  that relative paths count from
MapSections make_sections(const MapsInput& maps, const std::filesystem::path& folder,
                          const DrawingReader& reader, Findings& findings);

/// The report as text, a line or more per file and map.
std::string map_report_text(const MapReport& report);

/// `text` with every [maps] and [[map]] made a comment, so that all lines keep their numbers, and `sections`
/// after it.
std::string replace_maps(const std::string& text, const std::string& sections);

}  // namespace talus::maps
