#include "talus/audit/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/geometry/geos.h"
#include "talus/geometry/polygon_check.h"

namespace talus::audit {

bool is_convex(std::span<const Vec2> p) {
  constexpr double kFlat = -1e-12;  // corners of straight sides turn by round-off either way
  const size_t n = p.size();
  for (size_t k = 0; k < n; ++k) {
    const Vec2 before = p[(k + 1) % n] - p[k], after = p[(k + 2) % n] - p[(k + 1) % n];
    if (cross(before, after) < kFlat * norm(before) * norm(after)) return false;
  }
  return true;
}

Vec2 moves_against(const Block& a, size_t corner, const Block& b, size_t edge, double along,
                   std::vector<Vec2> Block::*velocity) {
  const auto of = [velocity](const Block& block, size_t k) {
    return (block.*velocity).empty() ? Vec2{} : (block.*velocity)[k];
  };
  return of(a, corner) - ((1 - along) * of(b, edge) + along * of(b, (edge + 1) % b.polygon.size()));
}

Vec2 velocity_at(const Block& block, Vec2 place, std::vector<Vec2> Block::*velocity) {
  const std::vector<Vec2>& v = block.*velocity;
  if (v.empty()) return {};
  const Polygon& p = block.polygon;
  // the widest of the triangles at the first corner
  size_t j = 1, k = 2;
  for (size_t i = 1; i + 1 < p.size(); ++i)
    if (std::abs(cross(p[i] - p[0], p[i + 1] - p[0])) > std::abs(cross(p[j] - p[0], p[k] - p[0])))
      j = i, k = i + 1;
  const double area = cross(p[j] - p[0], p[k] - p[0]);
  if (area == 0) return v[0];
  const double s = cross(place - p[0], p[k] - p[0]) / area, t = cross(p[j] - p[0], place - p[0]) / area;
  return v[0] + s * (v[j] - v[0]) + t * (v[k] - v[0]);
}

Polygon cut_below(std::span<const Vec2> polygon, Vec2 point, Vec2 normal) {
  Polygon out;
  const size_t n = polygon.size();
  for (size_t k = 0; k < n; ++k) {
    const Vec2 p = polygon[k], q = polygon[(k + 1) % n];
    const double hp = dot(normal, p - point), hq = dot(normal, q - point);
    if (hp <= 0) out.push_back(p);
    if ((hp < 0 && hq > 0) || (hp > 0 && hq < 0)) out.push_back(p + hp / (hp - hq) * (q - p));
  }
  return out;
}

Common common_part(const Polygon& a, const Polygon& b) {
  const bool by_b = is_convex(b);
  // a clip of a polygon with notches may fall into parts joined by edges without width: areas stay exact
  if (!by_b && !is_convex(a)) {
    const Overlap o = polygon_overlap(a, b);
    return {o.area, o.at};
  }
  const Polygon &clipped = by_b ? a : b, &window = by_b ? b : a;
  const Vec2 origin = window[0];
  Polygon part;
  for (const Vec2 p : clipped) part.push_back(p - origin);
  for (size_t k = 0; k < window.size() && part.size() > 2; ++k) {
    const Vec2 side = window[(k + 1) % window.size()] - window[k];
    part = cut_below(part, window[k] - origin, turn_right(side) / norm(side));
  }
  if (part.size() < 3) return {};
  const double area = signed_area(part);
  if (area <= 0) return {};
  Vec2 at;
  for (const Vec2 p : part) at += p / static_cast<double>(part.size());
  return {area, origin + at};
}

double depth_in(std::span<const Vec2> polygon, Vec2 point) {
  double near = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < polygon.size(); ++k)
    near = std::min(near, distance_to_segment(point, polygon[k], polygon[(k + 1) % polygon.size()]));
  return contains(polygon, point) ? near : -near;
}

double distance_between(std::span<const Vec2> a, std::span<const Vec2> b) {
  double near = std::numeric_limits<double>::infinity();
  for (const auto& [corners, outline] : {std::pair(a, b), std::pair(b, a)})
    for (const Vec2 p : corners)
      for (size_t k = 0; k < outline.size(); ++k)
        near = std::min(near, distance_to_segment(p, outline[k], outline[(k + 1) % outline.size()]));
  return near;
}

double mean_thickness(std::span<const Vec2> polygon, Vec2 tangent) {
  double low = 0, high = 0;
  for (const Vec2 p : polygon) {
    const double s = dot(tangent, p - polygon[0]);
    low = std::min(low, s), high = std::max(high, s);
  }
  return std::abs(signed_area(polygon)) / (high - low);
}

std::vector<Side> outline_near(const std::vector<const Polygon*>& polygons, Vec2 place, double reach,
                               double closing) {
  const Geos& g = geos();
  const auto context = g.context();
  // only what lies in the square counts: blocks may be large and have many corners
  const Polygon square{place + Vec2{-reach, -reach}, place + Vec2{reach, -reach}, place + Vec2{reach, reach},
                       place + Vec2{-reach, reach}};
  const auto window = g.make_polygon(square, place);
  Geos::Handle all = g.own(GEOSGeom_createEmptyPolygon_r(context));
  for (const Polygon* p : polygons) {
    const auto whole = g.make_polygon(*p, place);
    auto part = g.own(GEOSIntersection_r(context, whole.get(), window.get()));
    if (!part) continue;
    all = g.own(GEOSUnion_r(context, all.get(), part.get()));
    if (!all) return {};
  }
  // mitred corners: a square notch stays one
  constexpr int kQuarter = 4;
  constexpr double kMitre = 20;
  for (const double by : {closing, -closing}) {
    all = g.own(GEOSBufferWithStyle_r(context, all.get(), by, kQuarter, GEOSBUF_CAP_FLAT, GEOSBUF_JOIN_MITRE,
                                      kMitre));
    if (!all) return {};
  }
  std::vector<Side> out;
  const auto add_ring = [&](const GEOSGeometry* ring, bool hole) {
    if (!ring) return;
    std::vector<Vec2> p = g.corners_of(ring);
    if (p.size() < 4) return;
    const bool left = signed_area(std::span<const Vec2>(p.data(), p.size() - 1)) > 0;
    if (left == hole) std::reverse(p.begin(), p.end());
    for (size_t k = 0; k + 1 < p.size(); ++k) out.push_back({place + p[k], place + p[k + 1]});
  };
  for (int i = 0; i < GEOSGetNumGeometries_r(context, all.get()); ++i) {
    const GEOSGeometry* part = GEOSGetGeometryN_r(context, all.get(), i);
    if (GEOSGeomTypeId_r(context, part) != GEOS_POLYGON || GEOSisEmpty_r(context, part) == 1) continue;
    add_ring(GEOSGetExteriorRing_r(context, part), false);
    for (int h = 0; h < GEOSGetNumInteriorRings_r(context, part); ++h)
      add_ring(GEOSGetInteriorRingN_r(context, part, h), true);
  }
  return out;
}

}  // namespace talus::audit
