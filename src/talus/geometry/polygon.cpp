#include "talus/geometry/polygon.h"

#include <algorithm>
#include <cstdint>

#include "talus/base/error.h"
#include "talus/base/index.h"

namespace talus {

double signed_area(std::span<const Vec2> polygon) {
  double twice = 0;
  const Vec2 origin = polygon[0];
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    twice += cross(polygon[i] - origin, polygon[i + 1] - origin);
  }
  return 0.5 * twice;
}

PolygonMoments polygon_moments(std::span<const Vec2> polygon) {
  // signed triangles (0, a, b): integral 1 = c/2, integral x = c (a + b)/6,
  // integral x x^T = c/24 ((a + b)(a + b)^T + a a^T + b b^T), c = a x b
  const Vec2 origin = polygon[0];
  double area = 0;
  Vec2 first;
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vec2 a = polygon[i] - origin, b = polygon[i + 1] - origin;
    const double c = cross(a, b);
    area += c / 2;
    first += (c / 6) * (a + b);
  }
  TALUS_ASSERT(area != 0);
  // second moments from the centroid itself: from a corner they would be a difference of large numbers
  const Vec2 arm = first / area;
  Mat2 second;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i] - origin - arm, b = polygon[(i + 1) % polygon.size()] - origin - arm, s = a + b;
    second += (cross(a, b) / 24) * (outer(s, s) + outer(a, a) + outer(b, b));
  }
  if (area < 0) area = -area, second = -1.0 * second;
  return {area, origin + arm, second};
}

Vec2 interior_point(const Polygon& polygon) {
  TALUS_ASSERT(signed_area(polygon) != 0);
  // between the heights of two corners no corner is met; the roomiest of all stretches there
  std::vector<double> height;
  for (const Vec2 p : polygon) height.push_back(p.y);
  std::sort(height.begin(), height.end());
  Vec2 best = polygon[0];
  double room = -1;
  for (size_t h = 0; h + 1 < height.size(); ++h) {
    const double y = 0.5 * (height[h] + height[h + 1]), tall = height[h + 1] - height[h];
    if (!(tall > 0)) continue;
    std::vector<double> crossing;
    for (size_t i = 0; i < polygon.size(); ++i) {
      const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      if ((a.y > y) != (b.y > y)) crossing.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    std::sort(crossing.begin(), crossing.end());
    for (size_t i = 0; i + 1 < crossing.size(); i += 2) {
      const double here = std::min(tall, crossing[i + 1] - crossing[i]);
      if (here > room) room = here, best = {0.5 * (crossing[i] + crossing[i + 1]), y};
    }
  }
  return best;
}

double distance_to_segment(Vec2 point, Vec2 a, Vec2 b) {
  const Vec2 along = b - a;
  const double length2 = dot(along, along);
  const double s = length2 > 0 ? std::clamp(dot(point - a, along) / length2, 0.0, 1.0) : 0.0;
  return norm(point - a - s * along);
}

double polygon_width(const PolygonMoments& moments) {
  const Mat2& m = moments.second;
  const double s1 = 0.5 * (m.xx + m.yy) + std::hypot(0.5 * (m.xx - m.yy), m.xy);
  return std::sqrt(12 * std::max(det(m) / s1, 0.0) / moments.area);
}

bool contains(std::span<const Vec2> polygon, Vec2 point, double tolerance) {
  bool inside = false;
  for (size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vec2 a = polygon[j], b = polygon[i];
    if (distance_to_segment(point, a, b) <= tolerance) return true;
    if ((a.y > point.y) != (b.y > point.y)) {
      const double x = a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y);
      if (point.x < x) inside = !inside;
    }
  }
  return inside;
}

Box bounding_box(std::span<const Vec2> points) {
  TALUS_ASSERT(!points.empty());
  Box box{points[0], points[0]};
  for (const Vec2 p : points) {
    box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y)};
    box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y)};
  }
  return box;
}

std::vector<std::pair<int, int>> close_pairs(const std::vector<Box>& boxes, double margin) {
  return some_close_pairs(boxes, margin, SIZE_MAX).pairs;
}

SomePairs some_close_pairs(const std::vector<Box>& boxes, double margin, size_t most) {
  SomePairs out;
  std::vector<std::pair<int, int>>& pairs = out.pairs;
  if (boxes.size() < 2) return out;

  // cells of the mean box size; one very large box then fills many cells, which costs time, never pairs
  double mean = 0;
  for (const Box& b : boxes) mean += std::max(b.max.x - b.min.x, b.max.y - b.min.y);
  Box all = boxes[0];
  for (const Box& b : boxes) {
    all.min = {std::min(all.min.x, b.min.x), std::min(all.min.y, b.min.y)};
    all.max = {std::max(all.max.x, b.max.x), std::max(all.max.y, b.max.y)};
  }
  const double span = std::max(all.max.x - all.min.x, all.max.y - all.min.y) + margin;
  const double count = static_cast<double>(boxes.size());
  const double cell = std::max({mean / count + margin, span / (4 * std::sqrt(count) + 4), 1e-300});

  struct Entry {
    int64_t cell;
    int box;
  };
  std::vector<Entry> entries;
  const auto index = [cell](double x, double x0) {
    return static_cast<int64_t>(std::floor((x - x0) / cell));
  };
  const int64_t columns = index(all.max.x + margin, all.min.x - margin) + 2;
  for (int i = 0; i < count_of(boxes); ++i) {
    const Box& b = boxes[i];
    const int64_t x0 = index(b.min.x - margin / 2, all.min.x - margin),
                  x1 = index(b.max.x + margin / 2, all.min.x - margin);
    const int64_t y0 = index(b.min.y - margin / 2, all.min.y - margin),
                  y1 = index(b.max.y + margin / 2, all.min.y - margin);
    for (int64_t y = y0; y <= y1; ++y)
      for (int64_t x = x0; x <= x1; ++x) entries.push_back({y * columns + x, i});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.box < b.box;
  });

  for (size_t begin = 0; begin < entries.size() && pairs.size() < most;) {
    size_t end = begin;
    while (end < entries.size() && entries[end].cell == entries[begin].cell) ++end;
    for (size_t i = begin; i < end && pairs.size() < most; ++i) {
      for (size_t j = i + 1; j < end; ++j) {
        const Box &a = boxes[entries[i].box], &b = boxes[entries[j].box];
        if (a.min.x <= b.max.x + margin && b.min.x <= a.max.x + margin && a.min.y <= b.max.y + margin &&
            b.min.y <= a.max.y + margin) {
          pairs.emplace_back(entries[i].box, entries[j].box);
        }
      }
    }
    begin = end;
  }
  out.all = pairs.size() < most;
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return out;
}

}  // namespace talus
