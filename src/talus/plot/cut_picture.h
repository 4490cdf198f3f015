#pragma once
// Picture of a model before it runs: blocks, openings, the joints in the colours of their sets, dead ends in
// grey, and what acts: supports, boundaries, loads, motions, bolts, monitors.

#include <filesystem>

#include "talus/cut/layout.h"

namespace talus::plot {

/// Draws `model` in true proportion and writes it as `stem` + ".svg" and `stem` + ".png" (2 pixels per px),
/// each under a temporary name first and then renamed into place. Monitors outside the blocks are not shown;
/// a model without blocks gives axes and title only. Throws std::runtime_error naming file and cause when a
/// file cannot be drawn or written.
/// @param layout  of the cut
/// @note  the SVG holds one path per origin and tint, lines put end to end: 100,000 blocks cut by joints that
///        go through take some 100 kB
void write_cut_picture(const Model& model, const Cut& cut, const Layout& layout,
                       const std::filesystem::path& stem);

}  // namespace talus::plot
