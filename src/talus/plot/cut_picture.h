#pragma once
// Picture of a cut model: blocks, openings, the joints in the colours of their sets, dead ends in grey,
// monitors.

#include <filesystem>

#include "talus/cut/cut.h"
#include "talus/model/model.h"

namespace talus::plot {

/// Draws the cut of `model` in true proportion and writes it as `stem` + ".svg" and `stem` + ".png" (2 pixels
/// per px), each under a temporary name first and then renamed into place. Blocks that were not cut from a
/// region are not shown, nor are monitors outside the cut; an empty cut gives axes and title only. Throws
/// std::runtime_error naming file and cause when a file cannot be drawn or written.
/// @note  the SVG holds one path per origin and tint, lines put end to end: 100,000 blocks cut by joints that
/// go
///        through take some 100 kB
void write_cut_picture(const Model& model, const Cut& cut, const std::filesystem::path& stem);

}  // namespace talus::plot
