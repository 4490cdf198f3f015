#include "talus/cut/regions.h"

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

// A side this near [share of the model] to that of another region lies on it, not inside the region.
constexpr double kOnSide = 1e-9;

Box united(const Box& a, const Box& b) {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y)}};
}

bool holds(const Box& box, Vec2 p, double margin) {
  return p.x >= box.min.x - margin && p.x <= box.max.x + margin && p.y >= box.min.y - margin &&
         p.y <= box.max.y + margin;
}

CutRegion from_input(const RegionInput& in) {
  CutRegion r{in.name, in.polygon, in.sides, in.material, in.joint, in.kind, in.where};
  if (signed_area(r.polygon) < 0) {
    // the edge from corner n-1 to corner 0 stays last when the others turn round
    std::reverse(r.polygon.begin(), r.polygon.end());
    std::reverse(r.sides.begin(), r.sides.end() - 1);
  }
  return r;
}

CutRegion from_arch(const ArchInput& in) {
  CutRegion r{in.name, arch_polygon(in), {}, in.material, in.joint, in.kind, in.where};
  const int n = in.voussoirs;
  r.sides.assign(n, in.name + "-intrados");
  r.sides.push_back(in.name + "-start");
  r.sides.insert(r.sides.end(), n, in.name + "-extrados");
  r.sides.push_back(in.name + "-end");
  return r;
}

// Where along p + t (q - p) the segment meets the edge a-b; nothing when they are parallel.
void add_crossing(Vec2 p, Vec2 q, Vec2 a, Vec2 b, std::vector<double>& t) {
  const Vec2 d = q - p, e = b - a;
  const double det = cross(d, e);
  if (det == 0) return;
  const double along = cross(a - p, e) / det, on_edge = cross(a - p, d) / det;
  if (along > 0 && along < 1 && on_edge >= -1e-9 && on_edge <= 1 + 1e-9) t.push_back(along);
}

}  // namespace

Polygon arch_polygon(const ArchInput& arch) {
  const int n = arch.voussoirs;
  const auto at = [&](double radius, int i) {
    const double angle = arch.from + (arch.to - arch.from) * i / n;
    return arch.center + radius * Vec2{std::cos(angle), std::sin(angle)};
  };
  Polygon polygon;
  for (int i = n; i >= 0; --i) polygon.push_back(at(arch.radius, i));
  for (int i = 0; i <= n; ++i) polygon.push_back(at(arch.radius + arch.thickness, i));
  return polygon;
}

RegionMap::RegionMap(const Model& model) {
  for (const RegionInput& r : model.regions) regions_.push_back(from_input(r));
  for (const ArchInput& a : model.arches) regions_.push_back(from_arch(a));
  for (const CutRegion& r : regions_) boxes_.push_back(bounding_box(r.polygon));
}

int RegionMap::region_at(Vec2 point, double tolerance) const {
  for (size_t i = regions_.size(); i-- > 0;)
    if (holds(boxes_[i], point, tolerance) && contains(regions_[i].polygon, point, tolerance))
      return static_cast<int>(i);
  return -1;
}

Box RegionMap::box(int region) const {
  if (region >= 0) return boxes_[region];
  Box all = boxes_[0];
  for (const Box& b : boxes_) all = united(all, b);
  return all;
}

// Parts of the segment, between its crossings with the sides of all regions, whose middle is wanted.
template <class Wanted>
std::vector<std::vector<Vec2>> RegionMap::parts(Vec2 from, Vec2 to, const Wanted& wanted) const {
  std::vector<double> t{0, 1};
  for (const CutRegion& r : regions_)
    for (size_t k = 0; k < r.polygon.size(); ++k)
      add_crossing(from, to, r.polygon[k], r.polygon[(k + 1) % r.polygon.size()], t);
  std::sort(t.begin(), t.end());
  const auto at = [&](double s) { return s == 1 ? to : from + s * (to - from); };
  std::vector<std::vector<Vec2>> list;
  bool joined = false;  // the last part ends where this one begins
  for (size_t i = 0; i + 1 < t.size(); ++i) {
    if (t[i] == t[i + 1]) continue;
    const bool here = wanted(at(0.5 * (t[i] + t[i + 1])));
    if (here && joined) list.back().back() = at(t[i + 1]);
    if (here && !joined) list.push_back({at(t[i]), at(t[i + 1])});
    joined = here;
  }
  return list;
}

std::vector<std::vector<Vec2>> RegionMap::clip(Vec2 from, Vec2 to, int region) const {
  return parts(from, to, [&](Vec2 middle) {
    const int here = region_at(middle);
    return region < 0 ? here >= 0 : here == region;
  });
}

std::vector<std::vector<Vec2>> RegionMap::uncovered(Vec2 from, Vec2 to, int region) const {
  const Box all = box();
  const double near = kOnSide * norm(all.max - all.min);
  const auto well_inside = [near](const Polygon& polygon, Vec2 p) {
    if (!contains(polygon, p)) return false;
    for (size_t k = 0; k < polygon.size(); ++k)
      if (distance_to_segment(p, polygon[k], polygon[(k + 1) % polygon.size()]) <= near) return false;
    return true;
  };
  return parts(from, to, [&](Vec2 middle) {
    for (size_t later = region + 1; later < regions_.size(); ++later)
      if (holds(boxes_[later], middle, 0) && well_inside(regions_[later].polygon, middle)) return false;
    return true;
  });
}

}  // namespace talus
