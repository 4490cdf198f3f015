#pragma once
// Frames of an instant for ParaView, and the picture that a run leaves of one.

#include <string>

#include "talus/output/bolt_lines.h"
#include "talus/run/instant.h"

namespace talus {

/// The bolts at an instant, those of stages up to `stage`.
std::vector<BoltLine> bolt_lines(const Scene& scene, const State& state, int stage);

struct FrameTexts {
  std::string blocks, contacts, bolts;  // bolts "": the model has none
};
FrameTexts frame_texts(const Scene& scene, const Instant& instant);

/// The blocks by kind with joints and bolts over them, as SVG, drawn from the frame as `talus plot` draws it.
/// Throws FileError where blocks have lost their shape.
std::string picture_of(const FrameTexts& frame, const std::string& title);

}  // namespace talus
