#include "talus/supports/supports.h"

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/cut/selection.h"

namespace talus {

std::vector<SupportedPoint> supported_points(const Model& model, const Layout& layout,
                                             const BlockSet& blocks) {
  std::vector<SupportedPoint> points;
  for (int s = 0; s < count_of(model.supports); ++s) {
    for (const SelectedCorner& c : selected_corners(layout, model.supports[s])) {
      if (!blocks.moves_freely(c.block)) continue;
      points.push_back({s, c.block, c.point - blocks.centroid[c.block], true});
    }
  }
  return points;
}

// Theory 4, table of rows.
void add_support_rows(const BlockSet& blocks, const Model& model, const std::vector<SupportedPoint>& points,
                      const State& state, const StepClock& clock, RowSet& rows) {
  TALUS_ASSERT(state.supports.size() == points.size());
  for (int i = 0; i < count_of(points); ++i) {
    if (!points[i].active) continue;
    const SupportInput& support = model.supports[points[i].support];
    const int block = points[i].block;
    PointRows p;
    p.block_a = points[i].block;
    p.arm_a = acting_arm(blocks, state, block, points[i].arm);
    p.normal = {1, 0};
    const Vec2 now = displacement_at(state, block, points[i].arm) - state.supports[i].hold;
    const auto hold = [&](Row& row, const Motion& motion, double place, double sign) {
      if (motion.kind != Motion::kFree)
        row.bias = sign * (place - motion.displacement_at(clock.history_end(), model.histories)) / clock.dt;
    };
    hold(p.row[0], support.x, now.x, 1);
    hold(p.row[1], support.y, now.y, -1);
    if (support.x.kind == Motion::kFree) p.lower = p.upper = 0;
    if (support.y.kind == Motion::kFree) p.cohesion = 0;
    rows.add(p, {state.supports[i].force[0] * clock.dt_kick, -state.supports[i].force[1] * clock.dt_kick},
             {Family::kSupport, i});
  }
}

// Theory 4.2.
void drive_blocks(const BlockSet& blocks, const Model& model, const Layout& layout, const State& state,
                  const StepClock& clock, std::vector<BlockRate>& rate) {
  TALUS_ASSERT(count_of(rate) == blocks.count);
  for (size_t i = 0; i < rate.size(); ++i) {
    if (blocks.kind[i] == BlockKind::kFixed) rate[i] = {};
    if (blocks.kind[i] != BlockKind::kDriven) continue;
    const BlockShape& shape = layout.blocks[i];
    const Vec2 target{shape.motion_x.displacement_at(clock.history_end(), model.histories),
                      shape.motion_y.displacement_at(clock.history_end(), model.histories)};
    const double angle = shape.motion_rotation.displacement_at(clock.history_end(), model.histories);
    rate[i] = {(target - state.displacement[i]) / clock.dt, spin_matrix((angle - state.angle[i]) / clock.dt)};
  }
}

}  // namespace talus
