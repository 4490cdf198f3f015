#include "talus/maps/clean.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "talus/base/index.h"

namespace talus::maps {

namespace {

constexpr int kMostPasses = 8;         // of joining ends; each may bring one end within reach of another
constexpr double kShareOfLine = 1e-9;  // of a segment: round-off

double length_of(const Polyline& line) {
  double sum = 0;
  for (size_t k = 0; k + 1 < line.size(); ++k) sum += norm(line[k + 1] - line[k]);
  return sum;
}

Vec2 nearest_on(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  const double length2 = dot(d, d);
  const double t = length2 > 0 ? std::clamp(dot(p - a, d) / length2, 0.0, 1.0) : 0;
  return a + t * d;
}

// Where the segments a-b and c-d cross, as share of a-b; NaN: nowhere.
double crossing(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const Vec2 u = b - a, v = d - c;
  const double turn = cross(u, v);
  if (turn == 0) return std::nan("");
  const double s = cross(c - a, v) / turn, t = cross(c - a, u) / turn;
  return s >= 0 && s <= 1 && t >= 0 && t <= 1 ? s : std::nan("");
}

class Cleaner {
 public:
  Cleaner(std::vector<MapLine>& lines, const CleanLimits& limits) : lines_(lines), limits_(limits) {}

  std::vector<Mend> clean() {
    drop_crumbs();
    drop_doubles();
    for (int pass = 0; pass < kMostPasses; ++pass)
      if (!join_ends()) break;
    drop_short_lines();
    return std::move(mends_);
  }

 private:
  // --- crumbs ---

  void drop_crumbs() {
    const double least = std::max(limits_.shortest, limits_.round);
    for (MapLine& line : lines_) {
      if (line.fixed) continue;
      Polyline kept{line.points.front()};
      for (size_t k = 1; k < line.points.size(); ++k) {
        const bool last = k + 1 == line.points.size();
        if (norm(line.points[k] - kept.back()) >= least) {
          kept.push_back(line.points[k]);
          continue;
        }
        // the ends of a line stay where they are: the point before the last one goes instead
        if (last && kept.size() > 1) {
          note(Mend::kPoint, line, kept.back());
          kept.back() = line.points[k];
        } else {
          note(Mend::kPoint, line, line.points[k]);
        }
      }
      if (kept.size() < 2 || length_of(kept) < least) {
        note(Mend::kCrumb, line, line.points.front());
        kept.clear();
      }
      line.points = std::move(kept);
    }
    forget_empty();
  }

  // Lines that joining made too short, and points that it put on each other. Corners and joined points stay.
  void drop_short_lines() {
    for (MapLine& line : lines_) {
      if (line.fixed) continue;
      line.points.erase(std::unique(line.points.begin(), line.points.end()), line.points.end());
      if (line.points.size() > 1 && length_of(line.points) >= std::max(limits_.shortest, limits_.round))
        continue;
      note(Mend::kCrumb, line, line.points.front());
      line.points.clear();
    }
    forget_empty();
  }

  // --- doubles ---

  void drop_doubles() {
    const double reach = std::max(limits_.snap, limits_.round);
    std::vector<double> length;
    for (const MapLine& line : lines_) length.push_back(length_of(line.points));
    std::vector<std::pair<int, int>> pairs = close_pairs(boxes_of_lines(), reach);
    for (const auto& [i, j] : pairs) {
      // what other bodies meet at must not lose its joint: lines along outlines and openings stay
      if (lines_[at(i)].fixed || lines_[at(j)].fixed) continue;
      // the more important, then the longer one stays, of equal ones the first
      const int more = lines_[at(i)].rank - lines_[at(j)].rank;
      const bool first_stays = more != 0 ? more > 0 : length[at(i)] >= length[at(j)] - reach;
      MapLine& stays = lines_[at(first_stays ? i : j)];
      MapLine& goes = lines_[at(first_stays ? j : i)];
      if (goes.points.empty() || stays.points.empty()) continue;
      if (!lies_along(goes.points, stays.points, reach)) continue;
      note(Mend::kDouble, goes, 0.5 * (goes.points.front() + goes.points.back()));
      goes.points.clear();
    }
    forget_empty();
  }

  // Whether every point of `line` lies within `reach` of `other`.
  static bool lies_along(const Polyline& line, const Polyline& other, double reach) {
    for (size_t k = 0; k + 1 < line.size(); ++k)
      if (!is_covered(line[k], line[k + 1], other, reach)) return false;
    return true;
  }

  // The points of a-b within `reach` of one segment form an interval, since what lies within reach of a
  // segment is convex; together the intervals must cover all of it.
  static bool is_covered(Vec2 a, Vec2 b, const Polyline& other, double reach) {
    std::vector<std::pair<double, double>> parts;
    for (size_t k = 0; k + 1 < other.size(); ++k) {
      const auto distance = [&](double t) {
        return distance_to_segment(a + t * (b - a), other[k], other[k + 1]);
      };
      const double nearest = least_of(distance);
      if (distance(nearest) <= reach)
        parts.emplace_back(edge_of(distance, nearest, 0, reach), edge_of(distance, nearest, 1, reach));
    }
    std::sort(parts.begin(), parts.end());
    double covered = 0;
    for (const auto& [from, to] : parts)
      if (from <= covered + kShareOfLine) covered = std::max(covered, to);
    return covered >= 1 - kShareOfLine;
  }

  // Where a convex function on [0, 1] is least.
  template <class Function>
  static double least_of(const Function& f) {
    double low = 0, high = 1;
    while (high - low > kShareOfLine) {
      const double third = (high - low) / 3;
      if (f(low + third) <= f(high - third))
        high -= third;
      else
        low += third;
    }
    const double middle = 0.5 * (low + high);
    if (f(0) <= f(middle)) return 0;
    return f(1) < f(middle) ? 1 : middle;
  }

  // How far from `inside` towards `end` the function stays at or below `limit`.
  template <class Function>
  static double edge_of(const Function& f, double inside, double end, double limit) {
    if (f(end) <= limit) return end;
    double outside = end;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (inside + outside);
      if (f(middle) <= limit)
        inside = middle;
      else
        outside = middle;
    }
    return inside;
  }

  // --- ends ---

  struct Segment {
    int line = 0;
    int first = 0;  // point
  };

  // A point that a line gets.
  struct Extra {
    int line = 0, segment = 0;
    Vec2 point;
  };

  struct Target {
    double distance = std::numeric_limits<double>::infinity();
    Vec2 point;
    int line = -1, segment = -1;  // that get the point; -1: it is one of theirs already
    bool crosses = false;
  };

  // One pass over all ends against the lines as they were before it. Returns whether any moved.
  bool join_ends() {
    segments_.clear();
    std::vector<Box> boxes;
    for (int i = 0; i < count_of(lines_); ++i) {
      const Polyline& p = lines_[i].points;
      for (int k = 0; k + 1 < count_of(p); ++k) {
        segments_.push_back({i, k});
        boxes.push_back(bounding_box(std::vector<Vec2>{p[k], p[k + 1]}));
      }
    }
    const size_t first_end = boxes.size();
    const double reach = std::max(limits_.snap, limits_.round);
    std::vector<std::pair<int, bool>> ends;  // line, whether its last point
    for (int i = 0; i < count_of(lines_); ++i) {
      const Polyline& p = lines_[i].points;
      if (lines_[i].fixed || p.front() == p.back()) continue;
      for (const bool last : {false, true}) {
        ends.push_back({i, last});
        const Vec2 end = last ? p.back() : p.front();
        boxes.push_back({end, end});
      }
    }
    std::vector<std::vector<int>> near(ends.size());
    for (const auto& [s, e] : close_pairs(boxes, 2 * reach))
      if (at(s) < first_end && at(e) >= first_end) near[at(e) - first_end].push_back(s);

    bool moved = false;
    std::vector<Extra> extras;
    std::vector<Target> targets;
    for (size_t e = 0; e < ends.size(); ++e)
      targets.push_back(target_of(ends[e].first, ends[e].second, near[e], reach));
    const auto key = [](Vec2 p) { return std::pair(p.x, p.y); };
    std::set<std::pair<double, double>> held, left;  // points that ends came to, and went from, in this pass
    for (size_t e = 0; e < ends.size(); ++e) {
      const Target& t = targets[e];
      if (!std::isfinite(t.distance)) continue;
      MapLine& line = lines_[at(ends[e].first)];
      Vec2& end = ends[e].second ? line.points.back() : line.points.front();
      // two ends that were each other's target would change places: the second waits for the next pass
      if (end != t.point && (held.count(key(end)) > 0 || left.count(key(t.point)) > 0)) {
        moved = true;
        continue;
      }
      if (t.segment >= 0) extras.push_back({t.line, t.segment, t.point});
      held.insert(key(t.point));
      if (end == t.point) continue;
      left.insert(key(end));
      if (norm(end - t.point) > limits_.round) note(t.crosses ? Mend::kOvershoot : Mend::kGap, line, t.point);
      end = t.point;
      moved = true;
    }
    add_points(std::move(extras));
    return moved;
  }

  // Where an end belongs: an own crossing near it, else the nearest line.
  Target target_of(int i, bool last, const std::vector<int>& near, double reach) const {
    const Polyline& own = lines_[at(i)].points;
    const Vec2 end = last ? own.back() : own.front();
    const Vec2 inner = last ? own[own.size() - 2] : own[1];
    const double room = 0.5 * norm(end - inner);
    Target best;
    for (const int s : near) {
      const Segment segment = segments_[at(s)];
      if (segment.line == i) continue;
      const Polyline& other = lines_[at(segment.line)].points;
      const Vec2 a = other[at(segment.first)], b = other[at(segment.first) + 1];
      Target t;
      t.line = segment.line, t.segment = segment.first;
      const double share = crossing(end, inner, a, b);
      if (std::isfinite(share) && share * norm(inner - end) <= reach) {
        t.point = end + share * (inner - end);
        t.crosses = true;
      } else if (distance_to_segment(end, a, b) <= reach) {
        // straight on, where that meets the line soon enough; else the nearest point of it
        const Vec2 ahead = end + (reach / norm(end - inner)) * (end - inner);
        const double on = crossing(end, ahead, a, b);
        t.point = std::isfinite(on) ? end + on * (ahead - end) : nearest_on(end, a, b);
      } else {
        continue;
      }
      // a point of the line near by is better than one more
      const Vec2 corner = norm(a - t.point) <= norm(b - t.point) ? a : b;
      if (norm(corner - t.point) <= reach) t.point = corner, t.line = t.segment = -1;
      t.distance = norm(t.point - end);
      if (t.distance > std::max(room, limits_.round)) continue;  // it would turn the line about
      // joined already is best; a crossing before a gap; then the nearest
      if (t.distance == 0 && t.segment < 0) return t;
      if (std::pair(!t.crosses, t.distance) < std::pair(!best.crosses, best.distance)) best = t;
    }
    return best;
  }

  void add_points(std::vector<Extra> extras) {
    const auto place = [this](const Extra& x) {
      const Polyline& p = lines_[at(x.line)].points;
      return norm(x.point - p[at(x.segment)]);
    };
    std::stable_sort(extras.begin(), extras.end(), [&](const Extra& a, const Extra& b) {
      return std::tuple(a.line, -a.segment, -place(a)) < std::tuple(b.line, -b.segment, -place(b));
    });
    // from the end of each line: earlier segments keep their numbers
    for (const Extra& x : extras) {
      Polyline& p = lines_[at(x.line)].points;
      const auto after = p.begin() + x.segment + 1;
      if (*after == x.point || *(after - 1) == x.point) continue;
      p.insert(after, x.point);
    }
  }

  // --- helpers ---

  static size_t at(int i) { return i; }

  std::vector<Box> boxes_of_lines() const {
    std::vector<Box> boxes;
    for (const MapLine& line : lines_) boxes.push_back(bounding_box(line.points));
    return boxes;
  }

  void note(Mend::Kind kind, const MapLine& line, Vec2 where) {
    mends_.push_back({kind, line.source, where});
  }

  void forget_empty() {
    std::erase_if(lines_, [](const MapLine& line) { return line.points.empty(); });
  }

  std::vector<MapLine>& lines_;
  CleanLimits limits_;
  std::vector<Segment> segments_;
  std::vector<Mend> mends_;
};

}  // namespace

std::vector<Mend> clean_lines(std::vector<MapLine>& lines, const CleanLimits& limits) {
  return Cleaner(lines, limits).clean();
}

}  // namespace talus::maps
