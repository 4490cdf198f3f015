#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/supports/free_field.h"
#include "talus/supports/medium.h"
#include "talus/supports/ties.h"

namespace talus {

namespace {

// Nodes nearer to the one below than this share of the median edge are left out, unless the rock changes
// there: the column must not ask for shorter steps than the blocks.
constexpr double kShortElement = 0.3;

class ColumnMaker {
 public:
  ColumnMaker(const Model& model, const Layout& layout, int boundary, const std::vector<SelectedEdge>& edges,
              Findings& findings)
      : model_(model),
        layout_(layout),
        input_(model.boundaries[boundary]),
        boundary_(boundary),
        edges_(edges),
        findings_(findings) {}

  void make(FreeField& field) {
    std::vector<double> heights, rises;
    Vec2 foot = edges_[0].from, head = foot;
    for (const SelectedEdge& e : edges_) {
      for (const Vec2 p : {e.from, e.to}) {
        heights.push_back(p.y);
        if (p.y < foot.y) foot = p;
        if (p.y > head.y) head = p;
      }
      rises.push_back(std::abs(e.to.y - e.from.y));
    }
    std::sort(heights.begin(), heights.end());
    std::sort(rises.begin(), rises.end());
    tolerance_ = kHeightShare * (heights.back() - heights.front());
    if (rises.back() <= layout_.touching || tolerance_ == 0) {
      error("is level: a column of free field stands beside a side that rises",
            "for a base use kind = \"viscous\"");
      return;
    }
    const std::vector<double> nodes = chosen_nodes(heights, rises[rises.size() / 2]);
    if (failed_) return;
    GroundColumn c;
    c.boundary = boundary_;
    c.first_node = static_cast<int>(field.height.size());
    c.first_element = static_cast<int>(field.elements.size());
    c.elements = static_cast<int>(nodes.size()) - 1;
    c.base = base_under(foot);
    set_top(head, c);
    field.columns.push_back(c);
    field.height.insert(field.height.end(), nodes.begin(), nodes.end());
    for (size_t i = 0; i + 1 < nodes.size(); ++i) {
      const int block = block_between(nodes[i], nodes[i + 1]);
      if (failed_) return;
      std::string trouble;
      const Ground g =
          ground_at(model_, layout_, shape_of(block), material_behind(input_, layout_, block), trouble);
      if (!trouble.empty())
        error(
            fmt::format("stands beside \"{}\", whose joints have stiffness but no one direction and spacing",
                        trouble),
            "make those joints bonded, or use kind = \"tied\"");
      field.elements.push_back({nodes[i + 1] - nodes[i], g.density, g.stiffness, block});
    }
  }

 private:
  void error(const std::string& text, const std::string& hint) {
    if (!failed_) findings_.error(input_.where, "boundary." + input_.name, text, hint);
    failed_ = true;
  }

  // Heights of the corners, without those too near to each other.
  std::vector<double> chosen_nodes(const std::vector<double>& heights, double median) {
    std::vector<double> all{heights[0]}, kept{heights[0]};
    for (const double y : heights)
      if (y - all.back() > tolerance_) all.push_back(y);
    bool needed = true;  // the last of `kept`
    for (size_t i = 1; i < all.size(); ++i) {
      const bool end = i + 1 == all.size();
      const bool change =
          end || !same_rock(block_between(all[i - 1], all[i]), block_between(all[i], all[i + 1]));
      if (failed_) return {};
      const bool near = all[i] - kept.back() < kShortElement * median;
      if (near && !change) continue;
      if (near && !needed) kept.pop_back();
      kept.push_back(all[i]);
      needed = change;
    }
    return kept;
  }

  const BlockShape& shape_of(int block) const { return layout_.blocks[block]; }

  bool same_rock(int a, int b) const {
    if (a < 0 || b < 0) return true;  // told already
    std::string ignored;
    const Ground p = ground_at(model_, layout_, shape_of(a), material_behind(input_, layout_, a), ignored);
    const Ground q = ground_at(model_, layout_, shape_of(b), material_behind(input_, layout_, b), ignored);
    return p.density == q.density && p.stiffness == q.stiffness;
  }

  // A block at the side half way between two heights.
  int block_between(double below, double above) {
    const double y = 0.5 * (below + above);
    int found = -1;
    for (const SelectedEdge& e : edges_) {
      if (std::min(e.from.y, e.to.y) > y || std::max(e.from.y, e.to.y) < y) continue;
      if (found >= 0 && material_behind(input_, layout_, found) != material_behind(input_, layout_, e.block))
        error(fmt::format("has two materials at the height {:.6g} m: not level ground", y),
              "give material = \"NAME\", or let the side run through the layers once");
      found = e.block;
    }
    if (found < 0)
      error(fmt::format("has no block edge at the height {:.6g} m", y),
            "let its edges go up without a gap; another side is another [[boundary]]");
    return found;
  }

  double corner_tolerance() const {
    return std::max({tolerance_, layout_.touching, point_tolerance(layout_)});
  }

  // The block of a level edge of the place that ends at an end of the side, -1: none.
  int level_edge_at(Vec2 end, const Selection& place) const {
    if (place.along.empty() && !place.is_edge) return -1;
    for (const SelectedEdge& e : selected_edges(layout_, place))
      if (std::abs(e.normal().y) > 0.5 &&
          (norm(e.from - end) <= corner_tolerance() || norm(e.to - end) <= corner_tolerance()))
        return e.block;
    return -1;
  }

  // A viscous edge over the side takes waves out of the column as it does out of the blocks.
  void set_top(Vec2 head, GroundColumn& c) const {
    for (const BoundaryInput& b : model_.boundaries) {
      const int block = b.kind == BoundaryKind::kViscous ? level_edge_at(head, b) : -1;
      if (block < 0) continue;
      const Impedance z = impedance(model_, material_behind(b, layout_, block));
      c.top_impedance[0] = z.shear, c.top_impedance[1] = z.pressure;
    }
  }

  // What the foot of the side stands on: a viscous base, a support, or a block that is fixed or driven.
  ColumnBase base_under(Vec2 foot) {
    ColumnBase base;
    for (const BoundaryInput& b : model_.boundaries) {
      const int block = b.kind == BoundaryKind::kViscous ? level_edge_at(foot, b) : -1;
      if (block < 0) continue;
      const Impedance z = impedance(model_, material_behind(b, layout_, block));
      base.viscous = true;
      base.impedance[0] = z.shear, base.impedance[1] = z.pressure;
      base.history[0] = b.history_x, base.history[1] = b.history_y;
      base.incoming = b.outcrop ? 1 : 2;
      return base;
    }
    for (const SupportInput& s : model_.supports) {
      if (level_edge_at(foot, s) < 0) continue;
      base.motion[0] = s.x, base.motion[1] = s.y;
      return base;
    }
    for (const int i : blocks_at(layout_, foot, corner_tolerance())) {
      const BlockShape& b = layout_.blocks[i];
      if (b.kind == BlockKind::kDriven) base.motion[0] = b.motion_x, base.motion[1] = b.motion_y;
      if (b.kind == BlockKind::kDriven || b.kind == BlockKind::kFixed) return base;
    }
    findings_.warning(
        input_.where, "boundary." + input_.name,
        fmt::format("stands on nothing at ({:g}, {:g}): its column is held there", foot.x, foot.y),
        "let a viscous base or a support end at the foot of the side");
    return base;
  }

  const Model& model_;
  const Layout& layout_;
  const BoundaryInput& input_;
  const int boundary_;
  const std::vector<SelectedEdge>& edges_;
  Findings& findings_;
  double tolerance_ = 0;  // [m]
  bool failed_ = false;
};

}  // namespace

// Theory 4.12.
void add_column(const Model& model, const Layout& layout, int boundary,
                const std::vector<SelectedEdge>& edges, FreeField& field, Findings& findings) {
  ColumnMaker(model, layout, boundary, edges, findings).make(field);
}

}  // namespace talus
