#pragma once
// Line charts of results over time (forces, gaps, displacements), written as SVG and PNG.
// Both files come from one layout and one drawing routine, so they show the same picture.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace talus::plot {

enum class Style {
  kSolid,   // full line in the palette colour
  kDashed,  // dashes in a darker shade of the palette colour, drawn above all other curves
  kThin     // pale thin line, drawn below all other curves; meant for raw, noisy data
};

/// One line of a chart; a point whose x or y is not finite makes a gap.
struct Curve {
  std::string label;         // legend text
  std::vector<double> x, y;  // of equal length, in the units named by the axis labels
  int color = 0;             // palette index 0..15 (then repeating); 8..15 are 0..7 in another line pattern
  Style style = Style::kSolid;
  bool in_legend = true;
};

/// One chart; limits that are left open follow the data (y with a small margin).
struct Figure {
  std::string title;
  std::string x_label, y_label;  // with units, e.g. "t [ms]"
  std::vector<Curve> curves;
  std::optional<double> x_min, x_max, y_min, y_max;  // in the units of the axes
  std::vector<std::string> x_names;                  // of x = 1, 2 ...: kinds and no numbers; empty: numbers
  double width = 760, height = 460;  // px; the height grows if a long legend would squeeze the plot area
};

/// Draws `figure` and writes it as `stem` + ".svg" and `stem` + ".png" (2 pixels per px), each under a
/// temporary name first and then renamed into place; throws std::runtime_error naming file and cause when a
/// file cannot be written, std::invalid_argument when x and y of a curve differ in length.
void write_figure(const Figure& figure, const std::filesystem::path& stem);

}  // namespace talus::plot
