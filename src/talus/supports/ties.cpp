#include "talus/supports/ties.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/error.h"
#include "talus/base/index.h"

namespace talus {

namespace {

class SideTier {
 public:
  SideTier(const Model& model, const Layout& layout, const BlockSet& blocks, int boundary, Findings& findings)
      : layout_(layout),
        blocks_(blocks),
        input_(model.boundaries[boundary]),
        boundary_(boundary),
        findings_(findings) {}

  std::vector<TiePoint> tie(const std::vector<SelectedEdge>& side,
                            const std::vector<SelectedEdge>& opposite) {
    for (const auto* edges : {&side, &opposite})
      for (const SelectedEdge& e : *edges)
        low_ = std::min(low_, lower(e).y), high_ = std::max(high_, upper(e).y);
    tolerance_ = std::max(kHeightShare * (high_ - low_), layout_.touching);
    tie_ends(side, opposite, false);
    tie_ends(opposite, side, true);
    return std::move(ties_);
  }

 private:
  static Vec2 lower(const SelectedEdge& e) { return e.from.y < e.to.y ? e.from : e.to; }
  static Vec2 upper(const SelectedEdge& e) { return e.from.y < e.to.y ? e.to : e.from; }

  void error(const std::string& text, const std::string& hint) {
    if (failed_) return;
    findings_.error(input_.where, "boundary." + input_.name, text, hint);
    failed_ = true;
  }

  // Ties both ends of each edge to the edge across that goes on in the same direction.
  void tie_ends(const std::vector<SelectedEdge>& edges, const std::vector<SelectedEdge>& across,
                bool swapped) {
    for (const SelectedEdge& e : edges) {
      if (upper(e).y - lower(e).y <= tolerance_) {
        error(fmt::format("has a level edge at ({:g}, {:g}): points are tied by their heights", e.from.x,
                          e.from.y),
              "choose the upright edges only");
        return;
      }
      for (const bool up : {true, false}) {
        const Vec2 p = up ? lower(e) : upper(e);  // `up`: the edge goes up from there
        const auto there = std::find_if(across.begin(), across.end(), [&](const SelectedEdge& o) {
          return up ? lower(o).y <= p.y + tolerance_ && upper(o).y > p.y + tolerance_
                    : upper(o).y >= p.y - tolerance_ && lower(o).y < p.y - tolerance_;
        });
        if (there == across.end()) {
          error(fmt::format("has no opposite point for ({:g}, {:g})", p.x, p.y),
                "tied sides are equally high; ground that is not level needs kind = \"free_field\"");
          return;
        }
        add(e.block, p, there->block, point_at(*there, p.y), swapped);
      }
    }
  }

  Vec2 point_at(const SelectedEdge& e, double y) const {
    const Vec2 a = lower(e), b = upper(e);
    if (std::abs(y - a.y) <= tolerance_) return a;
    if (std::abs(y - b.y) <= tolerance_) return b;
    return a + (y - a.y) / (b.y - a.y) * (b - a);
  }

  void add(int block_a, Vec2 a, int block_b, Vec2 b, bool swapped) {
    if (swapped) std::swap(block_a, block_b), std::swap(a, b);
    if (block_a == block_b) {
      error(fmt::format("would tie \"{}\" to itself", layout_.blocks[block_a].name),
            "cut the ground between tied sides into at least two columns of blocks");
      return;
    }
    if (!blocks_.moves_freely(block_a) && !blocks_.moves_freely(block_b)) return;
    const auto arm = [this](int block, Vec2 p) { return p - blocks_.centroid[block]; };
    const TiePoint t{boundary_, block_a, block_b, arm(block_a, a), arm(block_b, b)};
    for (const TiePoint& other : ties_)
      if (other.block_a == block_a && other.block_b == block_b &&
          norm(other.arm_a - t.arm_a) <= 2 * tolerance_)
        return;
    ties_.push_back(t);
  }

  const Layout& layout_;
  const BlockSet& blocks_;
  const BoundaryInput& input_;
  const int boundary_;
  Findings& findings_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_, tolerance_ = 0;  // [m]
  bool failed_ = false;
  std::vector<TiePoint> ties_;
};

}  // namespace

// Theory 4.14.
std::vector<TiePoint> tie_sides(const Model& model, const Layout& layout, const BlockSet& blocks,
                                int boundary, const std::vector<SelectedEdge>& side,
                                const std::vector<SelectedEdge>& opposite, Findings& findings) {
  return SideTier(model, layout, blocks, boundary, findings).tie(side, opposite);
}

// Theory 4.14.
void add_tie_rows(const BlockSet& blocks, const std::vector<TiePoint>& ties, const State& state,
                  const StepClock& clock, RowSet& rows) {
  TALUS_ASSERT(state.ties.size() == ties.size());
  for (int i = 0; i < count_of(ties); ++i) {
    const TiePoint& t = ties[i];
    if (!t.active) continue;
    const int a = t.block_a, b = t.block_b;
    PointRows p;
    p.block_a = t.block_a, p.block_b = t.block_b;
    p.arm_a = acting_arm(blocks, state, a, t.arm_a), p.arm_b = acting_arm(blocks, state, b, t.arm_b);
    p.normal = {1, 0};
    const Vec2 apart = displacement_at(state, a, t.arm_a) - displacement_at(state, b, t.arm_b);
    p.row[0].bias = apart.x / clock.dt, p.row[1].bias = -apart.y / clock.dt;
    rows.add(p, {state.ties[i].force[0] * clock.dt_kick, state.ties[i].force[1] * clock.dt_kick},
             {Family::kTie, i});
  }
}

}  // namespace talus
