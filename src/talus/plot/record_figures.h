#pragma once
// Figures of a ground motion: acceleration, velocity, displacement over time and the 5 % response spectrum.

#include <filesystem>
#include <string>
#include <vector>

#include "talus/record/motion.h"
#include "talus/record/synthetic.h"

namespace talus::plot {

struct MotionCurve {
  std::string label;  // in the legend
  const record::Motion* motion;
};

/// Writes acceleration, velocity, displacement and spectrum as .svg and .png into `folder`, which exists.
/// @param curves  in the order of drawing; the last lies on top
/// @param target  drawn dashed in the spectrum; nullptr: none
/// Throws FileError.
void write_record_figures(const std::string& title, const std::vector<MotionCurve>& curves,
                          const record::TargetSpectrum* target, const std::filesystem::path& folder);

}  // namespace talus::plot
