#pragma once
// The audit of one instant: are the points between blocks, and their forces, what the polygons say? It looks
// at polygons and points alone and shares no code with the search for contacts. Theory: docs/theory.md
// section 12.

#include "talus/audit/findings.h"
#include "talus/audit/frame.h"
#include "talus/base/parallel.h"

namespace talus::audit {

struct FrameResult {
  std::vector<Finding> findings;  // in the order of pairs and points
  double unexplained_share = 0, unexplained_area = 0;
  double closure_share = 0;
  double slack = 0;  // as Report::slack
  int patches_by_energy = 0;
};

/// @param turn  how many frames came before: of more patches than one frame compares with the energy of their overlap, each
///              frame takes the next ones
/// @pre  the polygons of blocks that are not removed are simple, counter-clockwise
/// @note  the same findings for any number of threads
FrameResult check_frame(const Rules& rules, const Frame& frame, const Workers& workers = Workers(),
                        int64_t turn = 0);

/// The same, added to what was found before.
void add_frame(const Rules& rules, const Frame& frame, const Workers& workers, Report& report);

}  // namespace talus::audit
