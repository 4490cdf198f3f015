#include "talus/audit/watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/audit/shapes.h"
#include "talus/base/index.h"

namespace talus::audit {

namespace {

constexpr double kSamePlace = 1e-3;  // of the smaller block: points this near are one place
constexpr double kOverlap = 1e-5;    // of the smaller block: less is the error of a followed point
constexpr double kFirm = 1e-4;       // of the smaller block: what a force that counts is not lost over
constexpr double kCounts = 0.1;      // of the mean force
constexpr double kDeep = 1e-3;       // of the smaller block: what it may not lose a force over
constexpr double kWeighty = 1e-3;    // of the mean force: less is round-off of redundant points
constexpr double kThrough = 0.25;    // of the least mean thickness: a depth on a block's way through

std::pair<int, int> pair_of(const StepPoint& p) { return std::minmax(p.block_a, p.block_b); }

double least_thickness(const Polygon& p) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < p.size(); ++k) {
    const Vec2 side = p[(k + 1) % p.size()] - p[k];
    least = std::min(least, mean_thickness(p, side / norm(side)));
  }
  return least;
}

// How fast the sides of a block turn or stretch at most [1/s].
double turning(const Block& block, std::vector<Vec2> Block::*velocity) {
  const Polygon& p = block.polygon;
  const std::vector<Vec2>& v = block.*velocity;
  double most = 0;
  for (size_t k = 0; k < v.size(); ++k) {
    const size_t after = (k + 1) % p.size();
    most = std::max(most, norm(v[after] - v[k]) / norm(p[after] - p[k]));
  }
  return most;
}

// Where on the way p to q the polygon's sides are crossed, as shares of the way, from 0 to 1.
std::vector<double> crossings(const Polygon& polygon, Vec2 p, Vec2 q) {
  std::vector<double> at{0, 1};
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k], side = polygon[(k + 1) % polygon.size()] - a, way = q - p;
    const double d = cross(way, side);
    if (d == 0) continue;
    const double t = cross(a - p, side) / d, s = cross(a - p, way) / d;
    if (t > 0 && t < 1 && s >= 0 && s <= 1) at.push_back(t);
  }
  std::sort(at.begin(), at.end());
  return at;
}

}  // namespace

void Watch::look(const Step& step, Report& report) {
  if (known_) {
    forces_gone(step, report);
    blocks_through(step, report);
    ++report.steps;
  }
  known_ = true;
  before_.clear();
  for (const StepPoint& p : step.points)
    if (p.normal_force > 0) before_.push_back(p);
  centroid_before_ = step.centroid;
}

// Most points are the same as before: the two lists are walked side by side, and only what has no force any
// more is looked at.
void Watch::forces_gone(const Step& step, Report& report) const {
  double mean = 0;
  for (const StepPoint& p : before_) mean += p.normal_force;
  if (!before_.empty()) mean /= static_cast<double>(before_.size());
  size_t now = 0;
  for (const StepPoint& p : before_) {
    while (now < step.points.size() && pair_of(step.points[now]) < pair_of(p)) ++now;
    const StepPoint* same = nullptr;
    for (size_t k = now; k < step.points.size() && pair_of(step.points[k]) == pair_of(p); ++k)
      if (step.points[k].same_place(p)) same = &step.points[k];
    if (p.normal_force <= kWeighty * mean || (same && same->normal_force > 0)) continue;
    if (same && same->gap >= 0) continue;
    judge(step, p, same, mean, report);
  }
}

// A point without its force: has another point at the same place taken it over, or do the two still overlap?
void Watch::judge(const Step& step, const StepPoint& before, const StepPoint* now, double mean,
                  Report& report) const {
  const int a = before.block_a, b = before.block_b;
  if (step.blocks[a].hold == Hold::kRemoved || step.blocks[b].hold == Hold::kRemoved) return;
  const double size = std::min(step.blocks[a].size, step.blocks[b].size);
  const Block shape_a = step.shape(before.block_a), shape_b = step.shape(before.block_b);
  if (before.edge < -1) return judge_patch(step, before, now, mean, shape_a, shape_b, report);
  const Vec2 place = shape_a.polygon[before.corner];
  const size_t e = before.edge, next = (e + 1) % shape_b.polygon.size();
  const Vec2 side = shape_b.polygon[next] - shape_b.polygon[e], normal = turn_right(side) / norm(side);
  const double inside = depth_in(shape_b.polygon, place);
  const double depth = now ? -now->gap : std::min(inside, -dot(normal, place - shape_b.polygon[e]));
  // within the step the two may still part
  const double along = std::clamp(dot(place - shape_b.polygon[e], side) / dot(side, side), 0.0, 1.0);
  const auto moves = [&](std::vector<Vec2> Block::*velocity) {
    return moves_against(shape_a, before.corner, shape_b, e, along, velocity);
  };
  const double speed = std::max(norm(moves(&Block::velocity)), norm(moves(&Block::next)));
  const double allowed = (kOverlap + rules_.slop) * size + 2 * rules_.tolerance +
                         rules_.give * before.normal_force + 3 * step.step * speed;
  if (depth <= allowed) return;
  // hard, and kept its overlap at birth: it lets go
  if (now && now->hard && dot(normal, moves(&Block::next)) > 0) return;
  const double near = kSamePlace * size + step.step * speed;
  for (const StepPoint& p : step.points) {
    if (p.normal_force <= 0) continue;
    const bool of_pair = pair_of(p) == pair_of(before);
    // an end of a side that turns away: the corner across bears on that side now, as far as it is closed
    if (of_pair && p.block_b == before.block_a &&
        (before.corner == p.edge || before.corner == (p.edge + 1) % count_of(shape_a.polygon)))
      return;
    // over a crossing the force passes to the neighbour
    if (!of_pair && p.block_a != before.block_a) continue;
    const Vec2 there = p.block_a == before.block_a   ? shape_a.polygon[p.corner]
                       : p.block_a == before.block_b ? shape_b.polygon[p.corner]
                                                     : place;
    if (norm(there - place) <= near) return;
  }
  const bool invalid = depth > kDeep * size || (depth > kFirm * size && before.normal_force > kCounts * mean);
  report.add(
      {Defect::kForceVanished, invalid, before.block_a, before.block_b, step.time, place, depth / size,
       fmt::format("a force of {:.4g} N is gone from one step to the next, while the two overlap by {:.3g} m",
                   before.normal_force, depth)});
}

// A patch without its force: do the two still overlap where they have carried it to, and does nothing else push them apart?
void Watch::judge_patch(const Step& step, const StepPoint& before, const StepPoint* now, double mean,
                        const Block& a, const Block& b, Report& report) const {
  const double size = std::min(step.blocks[before.block_a].size, step.blocks[before.block_b].size);
  const Vec2 place = before.place + 0.5 * step.step *
                                        (velocity_at(a, before.place, &Block::velocity) +
                                         velocity_at(b, before.place, &Block::velocity));
  const auto moves = [&](std::vector<Vec2> Block::*velocity) {
    return velocity_at(a, place, velocity) - velocity_at(b, place, velocity);
  };
  const double speed = std::max(norm(moves(&Block::velocity)), norm(moves(&Block::next)));
  const double allowed = (kOverlap + rules_.slop) * size + 2 * rules_.tolerance +
                         rules_.give * before.normal_force + 3 * step.step * speed;
  const double parting =
      std::max({0.0, dot(before.normal, moves(&Block::velocity)), dot(before.normal, moves(&Block::next))});
  // both surfaces must lie that deep in the other block
  const double depth = depth_in(a.polygon, place) + depth_in(b.polygon, place);
  if (depth <= allowed + before.damping_time * parting) return;
  // hard, and keeps the overlap that it has: it lets go, but for the arc by which corners leave their tangent in a step
  const auto arc = [&](const Block& x, int block) {
    const double turn = step.step * turning(x, &Block::next);
    return 0.5 * turn * turn * step.blocks[block].radius;
  };
  // the normal has turned with one of the two; one of another way is another contact
  const double turned = step.step * (turning(a, &Block::velocity) + turning(b, &Block::velocity));
  const bool same_way = now && norm(now->normal - before.normal) <= turned;
  if (before.hard && step.step * dot(same_way ? now->normal : before.normal, moves(&Block::next)) >
                         -(2 * rules_.tolerance + arc(a, before.block_a) + arc(b, before.block_b)))
    return;
  const double near = kSamePlace * size + step.step * speed;
  for (const StepPoint& p : step.points) {
    if (p.normal_force <= 0) continue;
    if (pair_of(p) == pair_of(before)) return;
    if ((p.block_a == before.block_a || p.block_b == before.block_a) && norm(p.place - place) <= near) return;
  }
  const bool invalid = depth > kDeep * size || (depth > kFirm * size && before.normal_force > kCounts * mean);
  report.add(
      {Defect::kForceVanished, invalid, before.block_a, before.block_b, step.time, place, depth / size,
       fmt::format("a force of {:.4g} N is gone from one step to the next, while the two overlap by {:.3g} m",
                   before.normal_force, depth)});
}

void Watch::blocks_through(const Step& step, Report& report) const {
  double fastest = 0, thinnest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < step.centroid.size(); ++i) {
    if (step.blocks[i].hold == Hold::kRemoved) continue;
    fastest = std::max(fastest, norm(step.centroid[i] - centroid_before_[i]));
    thinnest = std::min(thinnest, step.blocks[i].thin);
  }
  if (fastest <= kThrough * thinnest) return;  // nothing can go through anything
  std::vector<Box> boxes;
  std::vector<int> block;
  for (int i = 0; i < count_of(step.centroid); ++i) {
    if (step.blocks[i].hold == Hold::kRemoved) continue;
    const Vec2 now = step.centroid[i], was = centroid_before_[i];
    const Vec2 r{step.blocks[i].radius, step.blocks[i].radius};
    boxes.push_back({Vec2{std::min(now.x, was.x), std::min(now.y, was.y)} - r,
                     Vec2{std::max(now.x, was.x), std::max(now.y, was.y)} + r});
    block.push_back(i);
  }
  for (const auto& [x, y] : close_pairs(boxes, 0)) {
    const int i = block[x], j = block[y];
    const Vec2 moved = (step.centroid[i] - centroid_before_[i]) - (step.centroid[j] - centroid_before_[j]);
    if (norm(moved) <= kThrough * std::min(step.blocks[i].thin, step.blocks[j].thin)) continue;
    Vec2 at;
    if (!went_through(step, i, j, at) && !went_through(step, j, i, at)) continue;
    report.add({Defect::kCrossed, true, i, j, step.time, at,
                norm(moved) / std::min(step.blocks[i].thin, step.blocks[j].thin),
                fmt::format(
                    "they move by {:.3g} m against each other in one step, through more than half of what is "
                    "in the way",
                    norm(moved))});
  }
}

// Whether a corner or the centroid of block i went through block j within the step, block j standing still.
bool Watch::went_through(const Step& step, int i, int j, Vec2& at) const {
  const Vec2 moved = (step.centroid[i] - centroid_before_[i]) - (step.centroid[j] - centroid_before_[j]);
  const Polygon polygon = step.shape(j).polygon;
  const double thin = least_thickness(polygon);
  Polygon corners = step.shape(i).polygon;
  corners.push_back(step.centroid[i]);
  for (const Vec2 now : corners) {
    const Vec2 was = now - moved;
    if (contains(polygon, was, 1e-3 * thin)) continue;
    const std::vector<double> cut = crossings(polygon, was, now);
    for (size_t k = 0; k + 1 < cut.size(); ++k) {
      // the way inside is as deep as its middle, or its end where it stays inside
      for (const double share : {0.5 * (cut[k] + cut[k + 1]), cut[k + 1]}) {
        const Vec2 here = was + share * moved;
        if (depth_in(polygon, here) <= kThrough * thin) continue;
        at = here;
        return true;
      }
    }
  }
  return false;
}

template <class X, class Self>
void Watch::exchange(X& x, Self& self, const std::string& name) {
  x(name + ".known", self.known_);
  x.each(name + ".before", self.before_, [](auto& field, auto& p) {
    field("block_a", p.block_a), field("corner", p.corner), field("block_b", p.block_b),
        field("edge", p.edge);
    field("normal_force", p.normal_force), field("gap", p.gap);
    field("hard", p.hard), field("place", p.place), field("normal", p.normal);
  });
  x(name + ".centroid_before", self.centroid_before_);
}

void Watch::save(Saver& to, const std::string& name) const { exchange(to, *this, name); }
void Watch::load(Loader& from, const std::string& name) { exchange(from, *this, name); }

bool Watch::fits(const std::vector<int>& corners) const {
  const auto is_corner = [&corners](int block, int corner) {
    return block >= 0 && block < count_of(corners) && corner >= 0 && corner < corners[block];
  };
  return (!known_ || centroid_before_.size() == corners.size()) &&
         std::all_of(before_.begin(), before_.end(), [&](const StepPoint& p) {
           if (p.edge < -1)
             return is_corner(p.block_a, 0) && is_corner(p.block_b, 0) && is_finite(p.place) &&
                    is_finite(p.normal);
           return is_corner(p.block_a, p.corner) && is_corner(p.block_b, p.edge);
         });
}

}  // namespace talus::audit
