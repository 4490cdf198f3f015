#include "talus/audit/overlap_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "talus/audit/shapes.h"

namespace talus::audit {

namespace {

constexpr double kStep = 1e-3;       // of the width of the overlap: errors of 1e-6, and 1e3 of round-off
constexpr double kSameLine = 1e-12;  // sine of the angle between two sides that are one

// A line with the outline on its left.
struct Line {
  Vec2 at, outward;
  double depth(Vec2 x) const { return dot(outward, at - x); }
};

std::vector<Line> lines_of(const Polygon& p) {
  std::vector<Line> out;
  for (size_t k = 0; k < p.size(); ++k) {
    const Vec2 side = p[(k + 1) % p.size()] - p[k];
    if (norm(side) == 0) continue;
    const Line line{p[k], turn_right(side) / norm(side)};
    const auto same = [&line](const Line& o) {
      return dot(o.outward, line.outward) > 0 && std::abs(cross(o.outward, line.outward)) <= kSameLine;
    };
    if ((out.empty() || !same(out.back())) && (out.empty() || !same(out.front()))) out.push_back(line);
  }
  return out;
}

// What of a convex polygon lies no deeper below `line` than below `other`.
Polygon nearer(const Polygon& polygon, const Line& line, const Line& other) {
  Polygon out;
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 p = polygon[k], q = polygon[(k + 1) % polygon.size()];
    const double hp = line.depth(p) - other.depth(p), hq = line.depth(q) - other.depth(q);
    if (hp <= 0) out.push_back(p);
    if ((hp < 0 && hq > 0) || (hp > 0 && hq < 0)) out.push_back(p + hp / (hp - hq) * (q - p));
  }
  return out;
}

// Integral over a convex polygon of the depth below a line, triangle by triangle.
double integral(const Polygon& polygon, const Line& line) {
  double sum = 0;
  for (size_t k = 1; k + 1 < polygon.size(); ++k) {
    const Vec2 &p = polygon[0], &q = polygon[k], &r = polygon[k + 1];
    sum += 0.5 * cross(q - p, r - p) * (line.depth(p) + line.depth(q) + line.depth(r)) / 3;
  }
  return sum;
}

double depth_integral(const Polygon& region, std::vector<Line> lines) {
  // sides that are nearest nowhere: always deeper than another one is at most
  const auto low = [&region](const Line& l) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec2 p : region) least = std::min(least, l.depth(p));
    return least;
  };
  const auto high = [&region](const Line& l) {
    double most = 0;
    for (const Vec2 p : region) most = std::max(most, l.depth(p));
    return most;
  };
  double bound = std::numeric_limits<double>::infinity();
  for (const Line& l : lines) bound = std::min(bound, high(l));
  lines.erase(std::remove_if(lines.begin(), lines.end(),
                             [&](const Line& l) { return lines.size() > 1 && low(l) > bound; }),
              lines.end());
  double sum = 0;
  for (size_t j = 0; j < lines.size(); ++j) {
    Polygon cell = region;
    for (size_t i = 0; i < lines.size() && cell.size() > 2; ++i)
      if (i != j) cell = nearer(cell, lines[j], lines[i]);
    if (cell.size() > 2) sum += integral(cell, lines[j]);
  }
  return sum;
}

Polygon common_region(const Polygon& a, const std::vector<Line>& of_b) {
  Polygon out = a;
  for (const Line& l : of_b) {
    if (out.size() < 3) return {};
    out = cut_below(out, l.at, l.outward);
  }
  return out.size() < 3 ? Polygon{} : out;
}

double energy_of(const Polygon& region, const Polygon& a, const std::vector<Line>& of_b) {
  return region.empty() ? 0 : 0.5 * (depth_integral(region, lines_of(a)) + depth_integral(region, of_b));
}

Polygon moved(const Polygon& p, Vec2 by) {
  Polygon out = p;
  for (Vec2& x : out) x += by;
  return out;
}

double extent(const Polygon& region, Vec2 along) {
  double low = 0, high = 0;
  for (const Vec2 p : region) {
    const double s = dot(along, p - region[0]);
    low = std::min(low, s), high = std::max(high, s);
  }
  return high - low;
}

}  // namespace

double overlap_energy(const Polygon& a, const Polygon& b) {
  const Vec2 origin = b[0];
  const Polygon near_a = moved(a, -origin);
  const std::vector<Line> of_b = lines_of(moved(b, -origin));
  return energy_of(common_region(near_a, of_b), near_a, of_b);
}

// Eq. 12.1.
OverlapForce overlap_force(const Polygon& a, const Polygon& b) {
  const Vec2 origin = b[0];
  const Polygon near_a = moved(a, -origin);
  const std::vector<Line> of_b = lines_of(moved(b, -origin));
  const Polygon region = common_region(near_a, of_b);
  OverlapForce out;
  if (region.empty()) return out;
  out.area = std::max(0.0, signed_area(region));
  double around = 0;
  for (size_t k = 0; k < region.size(); ++k) around += norm(region[(k + 1) % region.size()] - region[k]);
  if (!(out.area > 0)) return out;
  const double h = kStep * 2 * out.area / around;
  const auto slope = [&](Vec2 along) {
    const auto at = [&](double s) {
      const Polygon there = moved(near_a, s * along);
      return energy_of(common_region(there, of_b), there, of_b);
    };
    return (at(h) - at(-h)) / (2 * h);
  };
  out.force = -Vec2{slope({1, 0}), slope({0, 1})};
  if (norm(out.force) > 0) out.chord = extent(region, turn_right(out.force) / norm(out.force));
  return out;
}

}  // namespace talus::audit
