#include "talus/supports/boundaries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/supports/medium.h"

namespace talus {

namespace {

class BoundaryMaker {
 public:
  BoundaryMaker(const Model& model, const Layout& layout, const BlockSet& blocks, Findings& findings)
      : model_(model), layout_(layout), blocks_(blocks), findings_(findings) {}

  BoundarySet make() {
    for (int i = 0; i < count_of(model_.boundaries); ++i) {
      const BoundaryInput& input = model_.boundaries[i];
      const std::vector<SelectedEdge> edges = outer_edges(layout_, input).edges;
      if (edges.empty() || !claim(input, edges)) continue;
      if (entry(input.kind).two_sided)
        add_ties(i, edges);
      else
        add_edges(i, edges);
    }
    warn_held();
    return std::move(set_);
  }

 private:
  void error(const BoundaryInput& b, const Where& where, const std::string& text, const std::string& hint) {
    findings_.error(where, "boundary." + b.name, text, hint);
  }

  // An edge belongs to one boundary.
  bool claim(const BoundaryInput& input, const std::vector<SelectedEdge>& edges) {
    for (const SelectedEdge& e : edges) {
      const auto [it, fresh] = owner_.insert({{e.block, e.edge}, &input});
      if (fresh) continue;
      error(input, input.where,
            fmt::format("takes an edge of \"{}\" at ({:g}, {:g}) that belongs to boundary \"{}\"",
                        name(e.block), 0.5 * (e.from + e.to).x, 0.5 * (e.from + e.to).y, it->second->name),
            "an edge has one boundary: shorten one of the two");
      return false;
    }
    return true;
  }

  std::string name(int block) const { return layout_.blocks[block].name; }

  void add_ties(int boundary, const std::vector<SelectedEdge>& edges) {
    const BoundaryInput& input = model_.boundaries[boundary];
    const std::vector<SelectedEdge> opposite = outer_edges(layout_, input.opposite).edges;
    if (opposite.empty() || !claim(input, opposite)) return;
    const auto more = tie_sides(model_, layout_, blocks_, boundary, edges, opposite, findings_);
    set_.ties.insert(set_.ties.end(), more.begin(), more.end());
  }

  // The medium behind must have wave speeds.
  bool has_medium(const BoundaryInput& input, const std::vector<SelectedEdge>& edges) {
    for (const SelectedEdge& e : edges) {
      const int material = material_behind(input, layout_, e.block);
      if (material < 0) return false;  // told by the reader
      const Material& m = model_.materials[material];
      if (!std::isnan(m.young) && !std::isnan(m.poisson)) continue;
      error(input, input.material >= 0 ? input.where_material : input.where,
            fmt::format("has material \"{}\" behind it, which has no {}", m.name,
                        std::isnan(m.young) ? "young" : "poisson"),
            fmt::format("give it in [material.{}], or another material = \"NAME\" here", m.name));
      return false;
    }
    return true;
  }

  void add_edges(int boundary, std::vector<SelectedEdge> edges) {
    const BoundaryInput& input = model_.boundaries[boundary];
    std::erase_if(edges, [this](const SelectedEdge& e) { return !blocks_.moves_freely(e.block); });
    if (edges.empty()) {
      error(input, input.where, "lies on fixed or driven blocks only: it does nothing",
            "let it end at blocks that move");
      return;
    }
    if (!has_medium(input, edges)) return;
    int column = -1;
    if (input.kind == BoundaryKind::kFreeField) {
      const size_t before = set_.free_field.columns.size();
      add_column(model_, layout_, boundary, edges, set_.free_field, findings_);
      if (set_.free_field.columns.size() == before) return;
      column = static_cast<int>(before);
    }
    for (const SelectedEdge& e : edges) {
      add_point(boundary, column, e, e.from, e.to);
      add_point(boundary, column, e, e.to, e.from);
    }
  }

  void add_point(int boundary, int column, const SelectedEdge& e, Vec2 end, Vec2 other) {
    const BoundaryInput& input = model_.boundaries[boundary];
    const Impedance z = impedance(model_, material_behind(input, layout_, e.block));
    // as printed there is no area: 1 m2 for each edge of a block (theory 5.9)
    const double area =
        model_.formulation == Formulation::kAsPrinted ? 0.5 : 0.5 * e.length() * model_.thickness;
    BoundaryPoint p;
    p.boundary = boundary, p.block = e.block, p.column = column;
    p.arm = end - blocks_.centroid[e.block];
    p.normal = e.normal();
    p.dashpot[0] = z.pressure * area, p.dashpot[1] = z.shear * area;
    p.height = end.y;
    if (column >= 0) {
      const FreeField& field = set_.free_field;
      p.beside = shares_of_segment(field, field.columns[column], end, other);
      for (auto& [element, length] : p.beside) length *= model_.thickness;
    }
    set_.points.push_back(std::move(p));
  }

  // A support that holds every corner of a boundary leaves it nothing to do.
  void warn_held() {
    std::set<std::pair<int, std::pair<double, double>>> held;
    for (const SupportInput& s : model_.supports) {
      if (s.x.kind == Motion::kFree || s.y.kind == Motion::kFree) continue;
      for (const SelectedCorner& c : selected_corners(layout_, s))
        held.insert({c.block, {c.point.x, c.point.y}});
    }
    if (held.empty()) return;
    for (size_t i = 0; i < model_.boundaries.size(); ++i) {
      const BoundaryInput& b = model_.boundaries[i];
      if (entry(b.kind).two_sided) continue;
      const std::vector<SelectedEdge> edges = outer_edges(layout_, b).edges;
      const bool all = std::all_of(edges.begin(), edges.end(), [&held](const SelectedEdge& e) {
        return held.count({e.block, {e.from.x, e.from.y}}) && held.count({e.block, {e.to.x, e.to.y}});
      });
      if (all && !edges.empty())
        findings_.warning(b.where, "boundary." + b.name,
                          "is held by supports along its whole length: nothing passes it",
                          "leave out the support; static = \"fixed\" holds the edge in static stages");
    }
  }

  const Model& model_;
  const Layout& layout_;
  const BlockSet& blocks_;
  Findings& findings_;
  BoundarySet set_;
  std::map<std::pair<int, int>, const BoundaryInput*> owner_;  // of block edges
};

// The traction of the free field on a point: stress times normal times area [N] (theory 4.12).
Vec2 free_field_force(const BoundarySet& set, const BoundaryPoint& p, const ColumnMotion& columns) {
  const FreeField& field = set.free_field;
  Vec2 force;
  for (const auto& [element, area] : p.beside) {
    const auto s = column_stress(field, field.columns[p.column], element, columns.displacement);
    force += area * Vec2{s[0] * p.normal.x + s[2] * p.normal.y, s[2] * p.normal.x + s[1] * p.normal.y};
  }
  return force;
}

// Velocity of the medium behind the point as it would be without the blocks (theory 4.11, 4.12).
Vec2 medium_velocity(const Model& model, const BoundarySet& set, const BoundaryPoint& p,
                     const StepClock& clock, const ColumnMotion& columns) {
  if (p.column >= 0)
    return at_height(set.free_field, set.free_field.columns[p.column], p.height, columns.velocity);
  const BoundaryInput& b = model.boundaries[p.boundary];
  const auto value = [&](int history) {
    return history < 0 ? 0.0 : model.histories[history].value_at(clock.history_time);
  };
  // the bare half-space moves at twice the upgoing wave
  return (b.outcrop ? 1.0 : 2.0) * Vec2{value(b.history_x), value(b.history_y)};
}

}  // namespace

BoundarySet build_boundaries(const Model& model, const Layout& layout, const BlockSet& blocks,
                             Findings& findings) {
  return BoundaryMaker(model, layout, blocks, findings).make();
}

// Theory 4.11.
void enter_stage(const BoundarySet& set, bool was_static, bool is_static, State& state) {
  TALUS_ASSERT(state.boundaries.size() == set.points.size());
  for (size_t i = 0; i < set.points.size(); ++i) {
    const BoundaryPoint& p = set.points[i];
    if (is_static) {
      state.boundaries[i].hold = displacement_at(state, p.block, p.arm);
      state.boundaries[i].kept = {0, 0};
    } else if (was_static) {
      state.boundaries[i].kept = state.boundaries[i].force;  // none of a boundary that begins to act
    }
  }
  if (!is_static) return;
  // what the free field still pushes is part of the reactions from here on
  std::fill(state.column_displacement.begin(), state.column_displacement.end(), Vec2{});
  std::fill(state.column_rate.begin(), state.column_rate.end(), Vec2{});
}

// Eq. 4.3.
void add_boundary_rows(const BlockSet& blocks, const Model& model, const BoundarySet& set, const State& state,
                       const std::vector<BlockRate>& before, const StepClock& clock,
                       const ColumnMotion& columns, RowSet& rows) {
  TALUS_ASSERT(state.boundaries.size() == set.points.size() &&
               columns.velocity.size() == state.column_rate.size());
  for (int i = 0; i < count_of(set.points); ++i) {
    const BoundaryPoint& point = set.points[i];
    if (!point.active) continue;
    const int block = point.block;
    PointRows p;
    p.block_a = point.block;
    p.arm_a = acting_arm(blocks, state, block, point.arm);
    p.normal = point.normal;
    const Vec2 axis[2] = {point.normal, turn_right(point.normal)};
    if (!clock.dynamic) {
      const StaticHold hold = model.boundaries[point.boundary].hold;
      const Vec2 off = displacement_at(state, block, point.arm) - state.boundaries[i].hold;
      for (size_t k = 0; k < 2; ++k) {
        p.row[k].bias = dot(axis[k], off) / clock.dt;
      }
      if (hold == StaticHold::kFree) p.lower = p.upper = 0;
      if (hold != StaticHold::kFixed) p.cohesion = 0;
    } else {
      const auto u = relative_velocity(p, before);
      const Vec2 target = medium_velocity(model, set, point, clock, columns),
                 push = free_field_force(set, point, columns);
      for (size_t k = 0; k < 2; ++k) {
        const double z = point.dashpot[k], force = state.boundaries[i].kept[k] + dot(axis[k], push);
        // the velocity of the new half step alone (theory 5.9)
        if (model.formulation == Formulation::kAsPrinted) {
          p.row[k].compliance = 1 / (z * clock.dt_kick);
          p.row[k].bias = -force / z;
          continue;
        }
        p.row[k].compliance = 2 / (z * clock.dt_kick);
        p.row[k].bias = u[k] - 2 * dot(axis[k], target) - 2 * force / z;
      }
    }
    rows.add(p, {state.boundaries[i].force[0] * clock.dt_kick, state.boundaries[i].force[1] * clock.dt_kick},
             {Family::kBoundary, i});
  }
}

}  // namespace talus
