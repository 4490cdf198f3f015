// What must hold for any network of lines: a closed partition without loss of area, before and after slivers
// are merged.

#include <doctest/doctest.h>

#include <set>

#include "support/random_network.h"
#include "talus/base/index.h"
#include "talus/cut/layout.h"
#include "talus/cut/slivers.h"

namespace test_cut_properties {

using namespace talus;
using namespace talus::test;

namespace {

// Shares of a cell: how far noding moves a line (half a diagonal to a corner, round-off on top), and how near
// a point may lie to an edge before it is open which side it belongs to.
constexpr double kMoved = 1.5, kDoubt = 2;

bool is_removed(const Model& model, const CutBlock& b) {
  return b.opening >= 0 && !model.openings[b.opening].kept;
}

std::vector<CutBlock> not_removed(const Model& model, const std::vector<CutBlock>& blocks) {
  std::vector<CutBlock> out;
  for (const CutBlock& b : blocks)
    if (!is_removed(model, b)) out.push_back(b);
  return out;
}

double distance_to(const Polyline& line, Vec2 p) {
  double d = 1e300;
  for (size_t k = 0; k + 1 < line.size(); ++k) d = std::min(d, distance_to_segment(p, line[k], line[k + 1]));
  return d;
}

Polyline edge_of(const Cut& cut, int e) {
  const auto& [a, b] = cut.edge[e];
  return {cut.point[a], cut.point[b]};
}

// Area of the outlines, and what of it may be lost where their corners go to the grid and lines bend: a strip
// of less than two cells along them. (Coordinates of 5e6 m carry 1e-9 m, less than a cell of any model above
// 0.1 m.)
std::string outline_area_defect(const Model& model, const Cut& cut) {
  double area = 0, length = 0;
  for (const RegionInput& r : model.regions) {
    area += std::abs(signed_area(r.polygon)), length += perimeter(r.polygon);
    if (&r != &model.regions[0]) area -= polygon_overlap(model.regions[0].polygon, r.polygon).area;
  }
  const double sum = area_of(CellCut(cut).twice_area_of(cut.whole), cut.grid);
  const double allowed = 2 * cut.grid * length + 1e-12 * area;  // and round-off of the sums
  if (std::abs(sum - area) <= allowed) return "";
  return fmt::format("area {:.17g} differs from that of the outline {:.17g} by more than {:.2g}", sum, area,
                     allowed);
}

// Points here and there lie in just the block of the region and opening that hold them.
std::string point_defect(const Model& model, const Cut& cut, Random& random) {
  const Box box = RegionMap(model).box();
  const auto last_of = [](const auto& list, Vec2 p) {
    int found = -1;
    for (int i = 0; i < count_of(list); ++i)
      if (contains(list[i].polygon, p)) found = i;
    return found;
  };
  for (int i = 0; i < 40; ++i) {
    const Vec2 p{box.min.x + (1.1 * random.uniform() - 0.05) * (box.max.x - box.min.x),
                 box.min.y + (1.1 * random.uniform() - 0.05) * (box.max.y - box.min.y)};
    int holders = 0, holder = -1;
    bool doubt = false;
    for (const CutBlock& b : cut.whole) {
      const Polygon polygon = cut.polygon(b);
      Polyline ring = polygon;
      ring.push_back(ring[0]);
      doubt = doubt || distance_to(ring, p) < kDoubt * cut.grid;
      if (contains(polygon, p)) ++holders, holder = b.id;
    }
    if (doubt) continue;
    const int region = last_of(model.regions, p);
    const std::string at = fmt::format(" at ({:.9g}, {:.9g})", p.x, p.y);
    if (holders != (region >= 0 ? 1 : 0)) return fmt::format("{} blocks", holders) + at;
    if (holder < 0) continue;
    const CutBlock& b = cut.whole[holder];
    if (b.region != region) return "wrong region" + at;
    if (b.opening != last_of(model.openings, p)) return "wrong opening" + at;
  }
  return "";
}

// Every edge runs along a trace of its origin, and every trace along edges or dead ends.
std::string trace_defect(const Model& model, const Cut& cut) {
  Findings findings("case.toml", "");
  const TraceSet traces = make_traces(model, RegionMap(model), findings);
  const double near = kMoved * cut.grid;
  std::set<int> in_use;
  for (const CutBlock& b : cut.whole) in_use.insert(b.edge.begin(), b.edge.end());
  for (const int e : in_use) {
    const int origin = cut.edge_origin[e];
    const Polyline ends = edge_of(cut, e);
    const bool along = std::any_of(traces.traces.begin(), traces.traces.end(), [&](const Trace& t) {
      return t.origin == origin && distance_to(t.line, ends[0]) <= near &&
             distance_to(t.line, ends[1]) <= near;
    });
    const Origin& o = cut.origins[origin];
    if (!along && o.kind != OriginKind::kConstruction) return "an edge lies off its origin " + o.name;
  }
  for (const Trace& t : traces.traces) {
    for (int i = 0; i <= 4; ++i) {
      const Vec2 p = t.line[0] + i / 4.0 * (t.line[1] - t.line[0]);
      bool found = false;
      for (const int e : in_use) found = found || distance_to(edge_of(cut, e), p) <= near;
      for (const Polyline& line : cut.dead_ends) found = found || distance_to(line, p) <= near;
      if (!found) return "part of a trace is lost: " + cut.origins[t.origin].name;
    }
  }
  return "";
}

// Whether two blocks make one simple polygon: they touch along one stretch and nowhere else.
bool make_one_polygon(const CutBlock& a, const CutBlock& b) {
  const std::set<int> points(b.point.begin(), b.point.end()), edges(b.edge.begin(), b.edge.end());
  const size_t n = a.point.size();
  size_t stretches = 0, shared = 0;
  for (size_t k = 0; k < n; ++k) {
    const bool before = edges.count(a.edge[(k + n - 1) % n]) > 0, after = edges.count(a.edge[k]) > 0;
    shared += after;
    if (points.count(a.point[k]) && !before) ++stretches;  // one begins here, or is this corner alone
  }
  return stretches == 1 && shared > 0;
}

// Points of free faces: of edges with rock that stays on one side only, or along openings.
std::vector<bool> free_points(const Cut& cut) {
  std::map<int, std::vector<const CutBlock*>> beside;
  for (const CutBlock& b : cut.whole)
    for (const int e : b.edge) beside[e].push_back(&b);
  std::vector<bool> out(cut.point.size(), false);
  for (const auto& [e, blocks] : beside) {
    const OriginKind kind = cut.origins[cut.edge_origin[e]].kind;
    if (blocks.size() == 1 || kind == OriginKind::kOpening || blocks[0]->opening != blocks[1]->opening)
      for (const int p : cut.edge[e]) out[p] = true;
  }
  return out;
}

bool is_of_set(const Cut& cut, int e) {
  return cut.origins[cut.edge_origin[e]].kind == OriginKind::kJointSet;
}

// Merged is along joint sets away from free faces only; and no block inside is left below the limits, or
// thinner than 1e-5 of its length, that a neighbour beyond such edges could take.
std::string sliver_defect(const Model& model, const Cut& cut) {
  const std::vector<bool> is_free = free_points(cut);
  const auto touches = [&is_free](int p) { return is_free[p]; };
  const auto is_inside = [&](const CutBlock& b) {
    return std::none_of(b.point.begin(), b.point.end(), touches);
  };
  for (const int e : cut.slivers.opened) {
    const auto& [p, q] = cut.edge[e];
    if (!is_of_set(cut, e)) return "merged across something else than a joint set";
    if (touches(p) || touches(q)) return "merged across an edge that ends at a free face";
  }
  int kept = 0;
  for (const CutBlock& b : cut.blocks) {
    const PolygonMoments m = polygon_moments(cut.polygon(b));
    const double width = polygon_width(m), length = m.area / width;
    const SliverLimits& limits = cut.slivers.limits[b.region];
    if (m.area >= limits.area && width >= limits.width && width >= std::max(1e-5 * length, 4 * cut.grid))
      continue;
    ++kept;
    if (!is_inside(b)) continue;
    for (const CutBlock& other : cut.blocks) {
      if (other.id == b.id || other.region != b.region || other.opening != b.opening || !is_inside(other) ||
          !make_one_polygon(b, other))
        continue;
      const std::set<int> edges(other.edge.begin(), other.edge.end());
      if (std::all_of(b.edge.begin(), b.edge.end(),
                      [&](int e) { return !edges.count(e) || is_of_set(cut, e); }))
        return fmt::format("{} could be merged into {}", cut.name(b), cut.name(other));
    }
  }
  const SliverTable& table = cut.slivers;
  if (kept != table.kept) return fmt::format("{} slivers are left, the table says {}", kept, table.kept);
  const size_t whole = not_removed(model, cut.whole).size();
  if (cut.blocks.size() + static_cast<size_t>(table.merged + table.needles) != whole)
    return "blocks were lost in merging";
  if (table.rows.size() != static_cast<size_t>(table.merged + table.needles + table.kept))
    return "not one row per sliver";
  return "";
}

// What becomes of the blocks under the other two policies.
std::string policy_defect(Model model) {
  Findings findings("case.toml", "");
  const auto ids = [](const std::vector<CutBlock>& blocks) {
    std::set<int> out;
    for (const CutBlock& b : blocks) out.insert(b.id);
    return out;
  };
  model.cut.slivers = SliverPolicy::kKeep;
  const Cut keep = cut_model(model, findings);
  std::set<int> needles, expected = ids(not_removed(model, keep.whole));
  for (const Sliver& row : keep.slivers.rows)
    if (row.action == SliverAction::kNeedle) needles.insert(row.id), expected.erase(row.id);
  if (ids(keep.blocks) != expected) return "keep does not keep";
  model.cut.slivers = SliverPolicy::kDelete;
  const Cut cut = cut_model(model, findings);
  const std::set<int> left = ids(cut.blocks);
  Int128 missing = 0;
  const CellCut cells(cut);
  for (const CutBlock& b : keep.blocks)
    if (!left.count(b.id)) missing += twice_area(cells.ring(b));
  // every deleted area and their sum is rounded, by less than 1e-15 of itself and the height of its corners
  const double area = area_of(missing, cut.grid), told = cut.slivers.deleted_area;
  if (std::abs(area - told) > 1e-9 * area + 1e-15 * cut.slivers.limits[0].median_area)
    return fmt::format("{} m2 are missing, deleted were {}", area, told);
  if (cut.slivers.rows.size() != keep.slivers.rows.size() || cut.slivers.kept + cut.slivers.merged > 0 ||
      keep.slivers.kept != cut.slivers.deleted)
    return "delete and keep judge different blocks";
  return "";
}

// The blocks of the layout: simple, and what flat corners take away is less than a strip of one cell.
std::string shape_defect(const Model& model, const Cut& cut) {
  const std::vector<BlockShape> shapes = shapes_of(model, cut, cut.blocks);
  if (shapes.size() != cut.blocks.size()) return "not one shape per block";
  std::set<int> kept;  // slivers that nothing could take, however thin
  for (const Sliver& row : cut.slivers.rows)
    if (row.action == SliverAction::kKept) kept.insert(row.id);
  for (size_t i = 0; i < shapes.size(); ++i) {
    const Polygon whole = cut.polygon(cut.blocks[i]), shape = shapes[i].polygon;
    std::string defect = polygon_defect(shape);
    if (kept.count(cut.blocks[i].id) && defect.starts_with("has no area")) defect.clear();
    if (!defect.empty()) return shapes[i].name + " " + defect;
    if (std::abs(signed_area(shape) - signed_area(whole)) > cut.grid * perimeter(whole))
      return shapes[i].name + " lost area with its flat corners";
    if (shapes[i].edge_origin.size() != shape.size() || shapes[i].edge_joint.size() != shape.size())
      return shapes[i].name + " has not one origin and joint per edge";
  }
  return "";
}

bool same(const std::vector<CutBlock>& a, const std::vector<CutBlock>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const CutBlock& x, const CutBlock& y) {
    return x.id == y.id && x.region == y.region && x.opening == y.opening && x.point == y.point &&
           x.edge == y.edge;
  });
}

// What is counted over many networks, to see that they are worth the name.
struct Seen {
  size_t blocks = 0, most = 0;
  int merged = 0, kept = 0, pairs = 0;
};

std::string partition(const Model& model, const Cut& cut, Random& random, Seen& seen) {
  seen.blocks += cut.whole.size(), seen.most = std::max(seen.most, cut.whole.size());
  std::string defect = partition_defect(cut);
  if (defect.empty()) defect = outline_area_defect(model, cut);
  if (defect.empty()) defect = point_defect(model, cut, random);
  for (int i = 0; i < count_of(cut.whole); ++i)
    if (cut.whole[i].id != i) defect = "blocks are not numbered in their order";
  return defect;
}

std::string merging(Model model, const Cut& kept_cut, Seen& seen) {
  model.cut.slivers = SliverPolicy::kMerge;
  for (const JointSetInput& set : model.joint_sets) model.cut.merge_along.push_back(set.name);
  const Cut cut = with_slivers(model, kept_cut);
  // in every region and opening by itself
  const CellCut cells(cut);
  std::map<std::pair<int, int>, Int128> lost;
  for (const CutBlock& b : not_removed(model, cut.whole))
    lost[{b.region, b.opening}] += twice_area(cells.ring(b));
  for (const CutBlock& b : cut.blocks) lost[{b.region, b.opening}] -= twice_area(cells.ring(b));
  for (const auto& [group, area] : lost)
    if (area != 0) return "area was lost or went to another region or opening";
  seen.merged += cut.slivers.merged, seen.kept += cut.slivers.kept;
  return sliver_defect(model, cut);
}

std::string cut_again(const Model& model, const Cut& cut) {
  Findings findings("case.toml", "");
  const Cut again = cut_model(model, findings);
  const bool equal = cut.point == again.point && cut.edge == again.edge &&
                     cut.edge_origin == again.edge_origin && same(cut.whole, again.whole) &&
                     same(cut.blocks, again.blocks);
  return equal ? "" : "cut again it gives other blocks";
}

std::string sound_shapes(const Model& model, const Cut& cut, Random& random, Seen& seen) {
  std::string defect = shape_defect(model, cut);
  std::vector<Box> boxes;
  for (const CutBlock& b : cut.blocks) boxes.push_back(bounding_box(cut.polygon(b)));
  for (const auto& [i, j] : close_pairs(boxes, 0)) {
    if (random.uniform() > 0.05) continue;
    const Polygon a = cut.polygon(cut.blocks[i]), b = cut.polygon(cut.blocks[j]);
    ++seen.pairs;
    if (polygon_overlap(a, b).area > 0) defect = "blocks overlap";
  }
  return defect;
}

// Cuts the networks from `first` to the one before `last` once each, and looks at all that must hold of any:
// a closed partition, every edge along its origin and no trace lost, merging without loss and complete,
// deleting as told, the same bits again, sound shapes that do not overlap.
void check_networks(int first, int last) {
  Seen seen;
  for (int i = first; i < last; ++i) {
    CAPTURE(i);
    const Model model = NetworkMaker(static_cast<uint64_t>(i)).make();
    Findings findings("case.toml", "");
    Random points(static_cast<uint64_t>(i) + 1000000), pairs(static_cast<uint64_t>(i) + 2000000);
    std::string defect;
    try {
      const Cut cut = cut_model(model, findings);
      defect = partition(model, cut, points, seen);
      if (defect.empty()) defect = trace_defect(model, cut);
      if (defect.empty()) defect = merging(model, cut, seen);
      if (defect.empty()) defect = policy_defect(model);
      if (defect.empty()) defect = cut_again(model, cut);
      if (defect.empty()) defect = sound_shapes(model, cut, pairs, seen);
    } catch (const std::exception& e) {
      defect = e.what();
    }
    CHECK(defect == "");
  }
  const int networks = last - first;
  CHECK(seen.blocks > 20 * static_cast<size_t>(networks));
  CHECK(seen.most > 100);
  CHECK(seen.merged > networks / 4);
  CHECK(seen.pairs > networks);
  MESSAGE(seen.blocks, " blocks, at most ", seen.most, "; ", seen.merged, " slivers merged, ", seen.kept,
          " kept");
}

}  // namespace

TEST_CASE("a hundred random networks: a cut has all its properties") { check_networks(0, 100); }

TEST_CASE("nine hundred random networks more" * doctest::test_suite("optimised")) {
  check_networks(100, 1000);
}

}  // namespace test_cut_properties
