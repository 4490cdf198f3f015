#pragma once
// The legend of a cut picture: which entries it has, where they go and how they are drawn.

#include <cstddef>
#include <string>
#include <vector>

#include "talus/plot/conditions.h"
#include "talus/plot/cut_layers.h"
#include "talus/plot/name_places.h"
#include "talus/plot/sheet.h"

namespace talus::plot {

constexpr double kLegendRow = 19;  // height of one [px]

struct LegendEntry {
  enum Kind { kLine, kSquare, kMarker, kSymbol, kNote };
  Kind kind = kLine;
  std::string text;
  Pen pen;                   // of the line; its colour fills the square
  double width = 0;          // sample and text
  double x = 0, y = 0;       // left end and middle height
  Condition condition = {};  // of a symbol

  /// Where the text begins, from the left end.
  double indent() const { return kind == kNote ? 0 : 37; }
};

/// Entries for what the picture shows, without places: areas and lines, up to 60 together; then dead ends,
/// conditions, monitored points, what is taken out in which stage, and slivers.
std::vector<LegendEntry> legend_entries(const Model& model, const Cut& cut, const std::vector<Layer>& areas,
                                        const std::vector<Layer>& lines,
                                        const std::vector<Condition>& conditions, const Pen& dead_ends,
                                        const Pen& merged, const Names& names);

/// Puts the entries into rows of aligned columns, as many as there is room for, and shortens texts of more
/// than 420 px. Returns what they cover.
/// @param corner  upper left
Rect place_legend(cairo_t* cr, Vec2 corner, double available, std::size_t most_columns,
                  std::vector<LegendEntry>& entries);

void draw_legend(cairo_t* cr, const std::vector<LegendEntry>& entries);

}  // namespace talus::plot
