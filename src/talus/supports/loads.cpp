#include "talus/supports/loads.h"

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/cut/selection.h"

namespace talus {

namespace {

Vec2 value_of(const LoadInput& load, const Model& model, double time) {
  return load.factor * Vec2{load.x.value_at(time, model.histories), load.y.value_at(time, model.histories)};
}

std::vector<int> loaded_blocks(const LoadInput& load, const Layout& layout) {
  if (load.kind != LoadKind::kAcceleration) return {};
  if (!load.block.empty()) return layout.blocks_called(load.block);
  std::vector<int> all;
  for (int i = 0; i < count_of(layout.blocks); ++i) all.push_back(i);
  return all;
}

void add_points(const LoadInput& load, int index, const Layout& layout, const BlockSet& blocks,
                std::vector<LoadedPoint>& points) {
  const auto arm = [&blocks](int block, Vec2 p) { return p - blocks.centroid[block]; };
  if (load.kind == LoadKind::kSurface) {
    // a traction that is the same along an edge has its resultant in the middle
    for (const SelectedEdge& e : outer_edges(layout, load).edges)
      if (blocks.moves_freely(e.block))
        points.push_back({index, e.block, arm(e.block, 0.5 * (e.from + e.to)), e.normal(),
                          e.length() * blocks.thickness, true});
    return;
  }
  const size_t first = points.size();
  for (const SelectedCorner& c : selected_corners(layout, load))
    if (blocks.moves_freely(c.block)) points.push_back({index, c.block, arm(c.block, c.point), {}, 0, true});
  for (size_t i = first; i < points.size(); ++i)
    points[i].area = 1.0 / static_cast<double>(points.size() - first);
}

}  // namespace

LoadSet build_loads(const Model& model, const Layout& layout, const BlockSet& blocks) {
  TALUS_ASSERT(count_of(layout.blocks) == blocks.count);
  LoadSet set;
  for (int i = 0; i < count_of(model.loads); ++i) {
    set.blocks.push_back(loaded_blocks(model.loads[i], layout));
    if (model.loads[i].has_place) add_points(model.loads[i], i, layout, blocks, set.points);
  }
  return set;
}

std::vector<Vec2> load_acceleration(const Model& model, const LoadSet& loads, int block_count, double time) {
  std::vector<Vec2> acceleration(block_count);
  for (size_t i = 0; i < model.loads.size(); ++i) {
    if (!loads.active.empty() && !loads.active[i]) continue;
    const LoadInput& l = model.loads[i];
    if (l.kind != LoadKind::kAcceleration) continue;
    const Vec2 a = value_of(l, model, time);
    for (const int b : loads.blocks[i]) acceleration[b] += a;
  }
  return acceleration;
}

// Theory 4.16.
void add_edge_and_point_loads(const BlockSet& blocks, const Model& model, const LoadSet& loads,
                              const State& state, double time, std::vector<BlockForce>& force) {
  TALUS_ASSERT(count_of(force) == blocks.count);
  for (const LoadedPoint& p : loads.points) {
    if (!p.active) continue;
    const LoadInput& l = model.loads[p.load];
    const int block = p.block;
    Vec2 f = value_of(l, model, time);
    if (l.pressure.is_given()) {
      const Vec2 turn = elastic_state(blocks.moduli[block], state.strain_part[block]).rotation;
      const Vec2 n{turn.x * p.normal.x - turn.y * p.normal.y, turn.y * p.normal.x + turn.x * p.normal.y};
      f -= l.factor * l.pressure.value_at(time, model.histories) * n;
    }
    f *= p.area;
    force[block] += {f, outer(f, acting_arm(blocks, state, block, p.arm))};
  }
}

}  // namespace talus
