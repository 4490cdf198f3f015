#pragma once
// Points that are held or follow a history, and blocks that are driven.

#include <vector>

#include "talus/blocks/state.h"
#include "talus/rows/rows.h"
#include "talus/rows/step_clock.h"

namespace talus {

struct SupportedPoint {
  int support = -1;  // index in the model
  int block = -1;
  Vec2 arm;            // reference arm [m]
  bool active = true;  // in this stage; rows are made of active points only
};

/// All points of all supports, in the order of the model.
std::vector<SupportedPoint> supported_points(const Model& model, const Layout& layout,
                                             const BlockSet& blocks);

/// Rows of the active points for a step: along x, and along -y (the tangent of x).
void add_support_rows(const BlockSet& blocks, const Model& model, const std::vector<SupportedPoint>& points,
                      const State& state, const StepClock& clock, RowSet& rows);

/// Rates that bring driven blocks to their prescribed place at the end of the step; fixed blocks get none.
void drive_blocks(const BlockSet& blocks, const Model& model, const Layout& layout, const State& state,
                  const StepClock& clock, std::vector<BlockRate>& rate);

}  // namespace talus
