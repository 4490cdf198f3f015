#pragma once
// Cases for the cutter: a model of one region and lines, in memory or from a model text, and checks of what
// it is cut into. Corners are multiples of the grid: areas and crossings are exact in integers, nothing is
// rounded.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <compare>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "support/box_polygon.h"
#include "talus/base/index.h"
#include "talus/cut/cut.h"
#include "talus/geometry/polygon_check.h"
#include "talus/model/read_model.h"

namespace talus::test {

__extension__ typedef __int128 Int128;

// --- making models ---

inline void add_region(Model& model, const std::string& name, const Polygon& outline) {
  RegionInput r;
  r.name = name;
  r.polygon = outline;
  for (size_t i = 0; i < outline.size(); ++i) r.sides.push_back(fmt::format("{}-{}", name, i + 1));
  r.material = 0;
  model.regions.push_back(r);
}

/// One region called "rock", the sliver limits of the schema, joint 0 for what is glued.
inline Model rock_model(const Polygon& outline) {
  Model model;
  model.file = "case.toml";
  model.materials.push_back({"stone", 2000, 1e9, 0.2});
  JointProperty glue;
  glue.name = "(glued)";
  glue.bonded = true;
  model.joints.push_back(glue);
  model.bonded_joint = 0;
  model.cut.sliver_area_share = 0.02;
  model.cut.sliver_width_share = 0.3;
  add_region(model, "rock", outline);
  return model;
}

inline void add_fault(Model& model, const std::vector<Vec2>& points) {
  FaultInput f;
  f.name = fmt::format("fault{}", model.faults.size());
  f.points = points;
  model.faults.push_back(f);
}

inline void add_opening(Model& model, const Polygon& polygon, bool kept) {
  OpeningInput o;
  o.name = fmt::format("opening{}", model.openings.size());
  o.polygon = polygon;
  o.kept = kept;
  model.openings.push_back(o);
}

inline JointSetInput joint_set(const std::string& name, double angle, double spacing) {
  JointSetInput s;
  s.name = name;
  s.angle.mean = angle;
  s.spacing.mean = spacing;
  return s;
}

/// A model from the sections of a model file; material "stone" and the first line are there already.
inline Model model_of(const std::string& sections) {
  const std::string text =
      "talus = 1\n[material.stone]\ndensity = \"2000 kg/m3\"\nyoung = \"1 GPa\"\npoisson = 0.2\n" + sections +
      "\n[[stage]]\nname = \"go\"\nkind = \"dynamic\"\nduration = \"1 s\"\n";
  Findings findings("case.toml", text);
  Model model = read_model("case.toml", text, {}, findings);
  INFO(findings.render());
  REQUIRE_FALSE(findings.has_errors());
  return model;
}

inline Cut cut_of(const Model& model) {
  Findings findings("case.toml", "");
  Cut cut = cut_model(model, findings);
  INFO(findings.render());
  REQUIRE_FALSE(findings.has_errors());
  return cut;
}

// --- exact geometry on the grid ---

struct Cell {
  int64_t x = 0, y = 0;
  auto operator<=>(const Cell&) const = default;
};

using CellRing = std::vector<Cell>;

inline Int128 cross(Cell o, Cell a, Cell b) {
  return Int128{a.x - o.x} * (b.y - o.y) - Int128{a.y - o.y} * (b.x - o.x);
}

inline int turn(Cell o, Cell a, Cell b) {
  const Int128 c = cross(o, a, b);
  return c > 0 ? 1 : c < 0 ? -1 : 0;
}

/// Twice the area, > 0 for counter-clockwise order.
inline Int128 twice_area(const CellRing& ring) {
  Int128 sum = 0;
  for (size_t k = 1; k + 1 < ring.size(); ++k) sum += cross(ring[0], ring[k], ring[k + 1]);
  return sum;
}

/// Whether the closed segments a-b and c-d share a point.
inline bool meet(Cell a, Cell b, Cell c, Cell d) {
  if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) ||
      std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y))
    return false;
  return turn(a, b, c) * turn(a, b, d) <= 0 && turn(c, d, a) * turn(c, d, b) <= 0;
}

/// No edges meet but at the corner between them, and none folds back.
inline bool is_simple(const CellRing& r) {
  const size_t n = r.size();
  if (n < 3) return false;
  for (size_t i = 0; i < n; ++i) {
    const Cell a = r[i], b = r[(i + 1) % n], c = r[(i + 2) % n];
    const Int128 forward = Int128{b.x - a.x} * (c.x - b.x) + Int128{b.y - a.y} * (c.y - b.y);
    if (a == b || (turn(a, b, c) == 0 && forward <= 0)) return false;
    for (size_t j = i + 2; j < n; ++j)
      if ((j + 1) % n != i && meet(a, b, r[j], r[(j + 1) % n])) return false;
  }
  return true;
}

/// A cut in whole cells of its grid.
class CellCut {
 public:
  explicit CellCut(const Cut& cut) : cut_(cut) {
    // dividing by a power of two is exact: any remainder is that of the corner
    for (const Vec2 p : cut.point) {
      const double x = p.x / cut.grid, y = p.y / cut.grid;
      on_grid_ = on_grid_ && x == std::floor(x) && y == std::floor(y) && std::abs(x) < 0x1p53 &&
                 std::abs(y) < 0x1p53;
      cells_.push_back({static_cast<int64_t>(x), static_cast<int64_t>(y)});
    }
  }

  bool on_grid() const { return on_grid_; }

  CellRing ring(const CutBlock& b) const {
    CellRing out;
    for (const int p : b.point) out.push_back(cells_[p]);
    return out;
  }

  Int128 twice_area_of(const std::vector<CutBlock>& blocks) const {
    Int128 sum = 0;
    for (const CutBlock& b : blocks) sum += twice_area(ring(b));
    return sum;
  }

  struct Use {
    int block = -1, origin = -1;
  };
  using Uses = std::map<std::pair<Cell, Cell>, Use>;  // directed edges

  /// What is wrong with `blocks` as a set of blocks, "" when nothing is. On return `uses` holds their edges.
  std::string block_defect(const std::vector<CutBlock>& blocks, Uses& uses) const {
    if (!on_grid_) return "a corner lies off the grid";
    for (int i = 0; i < count_of(blocks); ++i) {
      const CutBlock& b = blocks[i];
      const std::string name = cut_.name(b);
      const CellRing r = ring(b);
      if (b.edge.size() != b.point.size()) return name + " has not one edge per corner";
      if (!is_simple(r)) return name + " is not simple";
      if (twice_area(r) <= 0) return name + " is not counter-clockwise";
      for (size_t k = 0; k < r.size(); ++k) {
        const auto& ends = cut_.edge[b.edge[k]];
        const int p = b.point[k], q = b.point[(k + 1) % r.size()];
        if (std::minmax(ends[0], ends[1]) != std::minmax(p, q))
          return name + " has an edge between other corners";
        const int origin = cut_.edge_origin[b.edge[k]];
        if (!uses.insert({{r[k], r[(k + 1) % r.size()]}, {i, origin}}).second)
          return name + " lies on one side of an edge with another block";
      }
    }
    return "";
  }

  /// Twice the area inside the edges that one block alone has; `defect` tells when they make no closed rings
  /// or one of them comes from something that `may_end_rock` does not allow.
  Int128 twice_area_of_rings(const Uses& uses, const auto& may_end_rock, std::string& defect) const {
    Int128 sum = 0;
    std::map<Cell, int> balance;  // edges that leave less edges that arrive
    for (const auto& [edge, use] : uses) {
      const auto& [a, b] = edge;
      if (const auto other = uses.find({b, a}); other != uses.end()) {
        if (other->second.origin != use.origin) defect = "an edge has two origins";
        continue;
      }
      if (!may_end_rock(cut_.origins[use.origin].kind))
        defect = fmt::format("an edge of {} has no block on its other side", cut_.origins[use.origin].name);
      sum += cross(uses.begin()->first.first, a, b);
      ++balance[a], --balance[b];
    }
    for (const auto& [cell, n] : balance)
      if (n != 0) defect = "the outer edges make no closed rings";
    return sum;
  }

 private:
  const Cut& cut_;
  std::vector<Cell> cells_;
  bool on_grid_ = true;
};

/// Twice an area in cells as m2.
inline double area_of(Int128 twice_cells, double grid) {
  return 0.5 * static_cast<double>(twice_cells) * grid * grid;
}

inline double perimeter(const Polygon& p) {
  double sum = 0;
  for (size_t k = 0; k < p.size(); ++k) sum += norm(p[(k + 1) % p.size()] - p[k]);
  return sum;
}

/// What is wrong with a cut as a partition of its regions before and after slivers and openings were treated;
/// "" when nothing is. @pre nothing was deleted
inline std::string partition_defect(const Cut& cut) {
  const CellCut cells(cut);
  const bool has_openings = !cut.openings.empty();
  // the edges of an opening that reaches the outline take its name before that of the side
  const auto ends_rock = [&](OriginKind kind) {
    return kind == OriginKind::kSide || (has_openings && kind == OriginKind::kOpening);
  };
  for (const auto* blocks : {&cut.whole, &cut.blocks}) {
    CellCut::Uses uses;
    std::string defect = cells.block_defect(*blocks, uses);
    if (!defect.empty()) return defect;
    const Int128 inside = cells.twice_area_of_rings(uses, ends_rock, defect);
    if (!defect.empty()) return defect;
    if (inside != cells.twice_area_of(*blocks)) return "the areas do not sum to that inside the outer edges";
  }
  return "";
}

/// Number of corners of a polygon at which it turns.
inline int real_corners(const Cut& cut, const CutBlock& block) {
  const CellRing r = CellCut(cut).ring(block);
  int n = 0;
  for (size_t k = 0; k < r.size(); ++k) n += turn(r[k], r[(k + 1) % r.size()], r[(k + 2) % r.size()]) != 0;
  return n;
}

/// The block of a list that holds the point, -1: none.
inline int block_at(const Cut& cut, const std::vector<CutBlock>& blocks, Vec2 point) {
  for (int i = 0; i < count_of(blocks); ++i)
    if (contains(cut.polygon(blocks[i]), point)) return i;
  return -1;
}

inline double degrees(double deg) { return deg * 3.14159265358979323846 / 180; }

}  // namespace talus::test
