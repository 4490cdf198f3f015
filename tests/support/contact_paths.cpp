#include "support/contact_paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "support/box_polygon.h"
#include "talus/audit/shapes.h"
#include "talus/base/angle.h"
#include "talus/base/error.h"
#include "talus/base/random.h"
#include "talus/blocks/state.h"

namespace talus::test {

namespace {

constexpr double kWhole = 2 * std::numbers::pi;
constexpr double kLeastClosure = 1e-5;  // [m]

// Draws, one a statement: C++ leaves open which of two in one expression comes first.
class Draw {
 public:
  Draw(char family, uint64_t seed, double deepest)
      : random_(stream_seed(seed, std::string_view(&family, 1))), deepest_(deepest) {}

  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  bool chance(double share) { return random_.uniform() < share; }
  double sign(double share_negative = 0.5) { return chance(share_negative) ? -1 : 1; }
  double scale(double low, double high) { return low * std::exp(random_.uniform() * std::log(high / low)); }
  double closure() { return scale(kLeastClosure, deepest_); }
  double angle() { return between(0, kWhole); }
  /// Of a joint that rises to either hand [rad].
  double slant() {
    const double steep = between(15, 90) * kDegree;
    return chance(0.5) ? steep : std::numbers::pi - steep;
  }
  int below(int n) { return std::min(n - 1, static_cast<int>(random_.uniform() * n)); }

 private:
  Random random_;
  double deepest_;
};

Vec2 towards(double angle) { return {std::cos(angle), std::sin(angle)}; }

Vec2 turned(Vec2 v, double angle) { return v + rotation_minus_identity(angle) * v; }

Polygon turned(Polygon polygon, double angle) {
  for (Vec2& v : polygon) v = turned(v, angle);
  return polygon;
}

Polygon shifted(Polygon polygon, Vec2 by) {
  for (Vec2& v : polygon) v += by;
  return polygon;
}

Vec2 centroid_of(const Polygon& polygon) { return polygon_moments(polygon).centroid; }

Polygon posed(const Polygon& polygon, Vec2 centroid, const PathPose& pose) {
  Polygon out;
  for (const Vec2 v : polygon) out.push_back(centroid + pose.displacement + turned(v - centroid, pose.turn));
  return out;
}

// How far rays from the corners of one polygon go until the other's sides, at least.
double free_way(const Polygon& from, Vec2 direction, const Polygon& to) {
  double least = HUGE_VAL;
  for (const Vec2 corner : from)
    for (size_t k = 0; k < to.size(); ++k) {
      const Vec2 side = to[(k + 1) % to.size()] - to[k], r = to[k] - corner;
      const double slope = cross(direction, side);
      if (std::abs(slope) < 1e-15 * norm(side)) continue;
      const double along = cross(r, direction) / slope;
      if (along >= 0 && along <= 1) least = std::min(least, cross(r, side) / slope);
    }
  return least;
}

// How far `moving` goes along `direction` until it touches `other`.
double way_until_touch(const Polygon& moving, Vec2 direction, const Polygon& other) {
  return std::min(free_way(moving, direction, other), free_way(other, -direction, moving));
}

void measure(ContactPath& path) {
  path.centroid.clear();
  path.size = HUGE_VAL;
  for (const Polygon& p : path.blocks) {
    path.centroid.push_back(centroid_of(p));
    path.size = std::min(path.size, std::sqrt(signed_area(p)));
  }
}

// The whole path turned about the origin.
void turn_path(double angle, ContactPath& path) {
  for (Polygon& p : path.blocks) p = turned(p, angle);
  path.pose = [angle, pose = std::move(path.pose)](double s) {
    std::vector<PathPose> all = pose(s);
    for (PathPose& p : all) p.displacement = turned(p.displacement, angle);
    return all;
  };
}

/*            \ third  :  fourth?
      third    \       :            the corner passes the joint
  --------------o---------------
      first    /     second
              /                  */
ContactPath corner_over_joint(Draw& draw) {
  constexpr double kHigh = 0.6, kBed = 4, kLong = 1.2;
  const double joint = draw.slant();
  double side = draw.slant();
  if (draw.chance(0.3)) side = joint;  // one line through all four
  const bool fourth = draw.chance(0.5);
  const double foot = -kHigh / std::tan(joint), head = kHigh / std::tan(side);
  const double left = std::min(0.0, head) - kLong, right = std::max(0.0, head) + kLong;
  ContactPath path;
  path.blocks = {{{-kBed, 0}, {-kBed, -kHigh}, {foot, -kHigh}, {0, 0}},
                 {{0, 0}, {foot, -kHigh}, {kBed, -kHigh}, {kBed, 0}},
                 {{left, 0}, {0, 0}, {head, kHigh}, {left, kHigh}}};
  if (fourth) path.blocks.push_back({{0, 0}, {right, 0}, {right, kHigh}, {head, kHigh}});

  const double bed = draw.closure(), behind = draw.closure();
  double below = draw.closure();
  below *= draw.sign(0.2);  // some joints stand open
  const double tilt = 0.2 * bed * draw.between(-1, 1);
  const double way = 12 * std::max({bed, std::abs(below), 1e-3});
  const Vec2 across_joint = turn_right(towards(joint)), across_side = turn_right(towards(side));
  path.pose = [=](double s) {
    const Vec2 slid{way * (2 * s - 1), -bed};
    std::vector<PathPose> all{{}, {-below * across_joint, 0}, {slid, tilt}};
    if (fourth) all.push_back({slid - behind * across_side, tilt});
    return all;
  };
  return path;
}

ContactPath sheared_crossing(Draw& draw) {
  const Vec2 first{1, 0}, second = towards(draw.slant());
  const double long_1 = draw.between(0.7, 1.5), long_2 = draw.between(0.7, 1.5);
  ContactPath path;
  for (const double j : {-1.0, 0.0})
    for (const double i : {-1.0, 0.0}) {
      const Vec2 from = i * long_1 * first + j * long_2 * second;
      path.blocks.push_back(
          {from, from + long_1 * first, from + long_1 * first + long_2 * second, from + long_2 * second});
    }
  const double close_1 = draw.closure(), close_2 = draw.closure();
  const bool along_first = draw.chance(0.5);
  const double way = 12 * std::max({close_1, close_2, 1e-3});
  std::vector<PathPose> off(4);
  for (PathPose& p : off) {
    p.displacement.x = 0.1 * close_1 * draw.between(-1, 1);
    p.displacement.y = 0.1 * close_1 * draw.between(-1, 1);
    p.turn = 0.1 * close_1 * draw.between(-1, 1);
  }
  path.pose = [=](double s) {
    std::vector<PathPose> all = off;
    const double slid = way * (2 * s - 1);
    for (size_t k = 0; k < 4; ++k) {
      const bool above = k >= 2, beside = k % 2 == 1;
      Vec2& u = all[k].displacement;
      if (above) u -= close_1 * turn_left(first);
      if (beside) u -= close_2 * turn_right(second);
      if (along_first && above) u += slid * first;
      if (!along_first && beside) u += slid * second;
    }
    return all;
  };
  return path;
}

// Height at which a block turned by `turn` overlaps what is below y = 0 by `area`.
double height_of(const Polygon& block, Vec2 centroid, double turn, double area) {
  double low = -0.5, high = 0.5;
  for (int k = 0; k < 60; ++k) {
    const double y = 0.5 * (low + high);
    const Polygon below = audit::cut_below(posed(block, centroid, {{0, y}, turn}), {}, {0, 1});
    (below.size() > 2 && signed_area(below) > area ? low : high) = y;
  }
  return 0.5 * (low + high);
}

ContactPath rocking_block(Draw& draw) {
  const double wide = draw.between(0.6, 1.5), high = 1 / wide;
  const double area = wide * draw.scale(kLeastClosure, 5e-3);
  double off = draw.between(-0.01, 0.01);
  if (draw.chance(0.5)) off = 0;
  const double joint = wide * draw.between(-0.45, 0.45), closure = draw.scale(kLeastClosure, 1e-3);
  const int bed = draw.below(3);
  ContactPath path;
  if (bed == 0) path.blocks = {box_polygon(-3, -1, 3, 0)};
  if (bed == 1) path.blocks = {box_polygon(-0.5 * wide, -1, 0.5 * wide, 0)};
  if (bed == 2) path.blocks = {box_polygon(-3, -1, joint, 0), box_polygon(joint, -1, 3, 0)};
  const Polygon block = box_polygon(off - 0.5 * wide, 0, off + 0.5 * wide, high);
  path.blocks.push_back(block);
  const size_t count = path.blocks.size();
  const double times = draw.between(0.5, 1.5), phase = draw.angle();
  path.pose = [=, centroid = centroid_of(block)](double s) {
    std::vector<PathPose> all(count);
    if (bed == 2) all[1].displacement.x = -closure;
    const double turn = 0.2 * std::sin(kWhole * times * s + phase);
    all.back() = {{0, height_of(block, centroid, turn, area)}, turn};
    return all;
  };
  return path;
}

/*      third  |
  -------------o----------      the second one rises past the first, or the third slides over
      first   /   second        a step between them */
ContactPath passing_level(Draw& draw) {
  double foot = draw.between(-0.577, 0.577), lean = draw.between(-0.5, 0.5);
  if (draw.chance(0.5)) foot = 0;
  if (draw.chance(0.5)) lean = 0;
  ContactPath path;
  path.blocks = {{{-2, 0}, {-2, -1}, {foot, -1}, {0, 0}},
                 {{0, 0}, {foot, -1}, {2, -1}, {2, 0}},
                 {{-1, 0}, {0, 0}, {lean, 1}, {-1, 1}}};
  const double bed = draw.closure();
  double beside = draw.closure();
  beside *= draw.sign(0.3);
  double over = draw.scale(0.1 * bed, 0.5);
  over *= draw.sign();
  double tilt = bed * draw.between(-1, 1);
  if (draw.chance(0.5)) tilt = 0;
  const double step = 3 * bed * draw.between(-1, 1);
  const bool rises = draw.chance(0.5);
  path.pose = [=](double s) {
    const double t = 2 * s - 1;
    std::vector<PathPose> all(3);
    all[1].displacement = {-beside, rises ? 3 * bed * t : step};
    all[2] = {{rises ? over : 20 * bed * t, -bed}, tilt};
    return all;
  };
  return path;
}

// A corner of `angle` at the origin that points up, on a body of about 1 m; of wide ones the body is a box.
Polygon upward_corner(double angle) {
  const double half = std::tan(0.5 * angle);
  if (angle < 125 * kDegree) return {{0, 0}, {-half, -1}, {half, -1}};
  constexpr double kHalf = 0.8, kDeep = 1.2;
  const double shoulder = -kHalf / half;
  return {{0, 0}, {-kHalf, shoulder}, {-kHalf, -kDeep}, {kHalf, -kDeep}, {kHalf, shoulder}};
}

// A notch of `angle`, its ground at the origin, open upwards.
Polygon notched(double angle) {
  const double x = std::sin(0.5 * angle), y = std::cos(0.5 * angle);
  constexpr double kRim = 0.3, kDeep = 0.7;
  return {{0, 0}, {-x, y}, {-x - kRim, -kDeep}, {x + kRim, -kDeep}, {x, y}};
}

ContactPath corner_on_corner(Draw& draw) {
  const bool notch = draw.chance(0.4);
  const double tip = draw.between(15, 120) * kDegree;
  const double other = (notch ? draw.between(70, 170) : draw.between(20, 150)) * kDegree;
  const double room = notch ? 0.45 * std::max(0.0, other - tip) : 60 * kDegree;
  const double lean = room * draw.between(-1, 1), half = std::tan(0.5 * tip);
  const Polygon moving = turned(Polygon{{0, 0}, {half, 1}, {-half, 1}}, lean);
  const Polygon resting = notch ? notched(other) : upward_corner(other);
  ContactPath path;
  path.blocks = {resting, moving};
  const double deep = draw.scale(1e-4, kDeepestClosure), spin = draw.between(-0.05, 0.05);
  const double phase = draw.angle(), side = (notch ? 0.3 : 4) * deep * draw.between(0.8, 1.2);
  path.pose = [=, centroid = centroid_of(moving)](double s) {
    // from side to side, at each place by `in` further down than the first touch
    constexpr double kAbove = 5;
    const double wave = kWhole * s + phase, turn = spin * std::sin(wave), x = side * (2 * s - 1);
    const double in = deep * (0.6 + 0.4 * std::cos(wave));
    const Polygon raised = posed(moving, centroid, {{x, kAbove}, turn});
    const double way = way_until_touch(raised, {0, -1}, resting);
    return std::vector<PathPose>{{}, {{x, kAbove - way - in}, turn}};
  };
  return path;
}

// Corners on an ellipse, counter-clockwise about the origin.
Polygon random_convex(Draw& draw, int corners, double radius) {
  const double flat = draw.between(0.5, 1), lie = draw.between(0, std::numbers::pi), first = draw.angle();
  Polygon out;
  for (int k = 0; k < corners; ++k) {
    const double angle = first + kWhole * (k + draw.between(-0.35, 0.35)) / corners;
    out.push_back(turned({radius * std::cos(angle), radius * flat * std::sin(angle)}, lie));
  }
  return out;
}

// The same with one corner drawn in beyond the line between its neighbours.
Polygon random_notched(Draw& draw, int corners, double radius) {
  Polygon out = random_convex(draw, corners, radius);
  const Vec2 middle = centroid_of(out);
  const int n = corners, k = draw.below(corners);
  const Vec2 mouth = 0.5 * (out[(k + n - 1) % n] + out[(k + 1) % n]);
  out[k] = mouth + draw.between(0.1, 0.6) * (middle - mouth);
  return out;
}

ContactPath random_polygons(Draw& draw) {
  const bool joint = draw.chance(0.5), notch = draw.chance(0.4);
  const int least = notch || joint ? 4 : 3;
  const int of_resting = std::max(least, 3 + draw.below(5)),
            of_moving = std::max(notch ? 4 : 3, 3 + draw.below(5));
  const double radius = joint ? 1.0 : 0.7;
  const Polygon resting =
      notch && !joint ? random_notched(draw, of_resting, radius) : random_convex(draw, of_resting, radius);
  const Polygon moving = notch ? random_notched(draw, of_moving, 0.6) : random_convex(draw, of_moving, 0.6);
  const Vec2 middle = centroid_of(resting), centroid = centroid_of(moving);
  const Vec2 across = towards(draw.angle());
  Vec2 closed = draw.scale(kLeastClosure, 5e-3) * across;
  ContactPath path;
  if (joint)
    path.blocks = {audit::cut_below(resting, middle, across), audit::cut_below(resting, middle, -across)};
  else
    path.blocks = {resting}, closed = {};
  std::vector<Polygon> bed = path.blocks;
  bed[0] = shifted(bed[0], closed);
  path.blocks.push_back(moving);

  const double deep = draw.scale(1e-4, kDeepestClosure), from = draw.angle(), phase = draw.angle();
  double round = draw.between(0.3, 1.2);
  round *= draw.sign();
  const double turn_0 = draw.angle(), turn_1 = draw.between(-1, 1);
  path.pose = [=](double s) {
    // round the bed, at each place by `in` nearer than the first touch on the way to its middle
    const Vec2 out = towards(from + round * s);
    const double turn = turn_0 + turn_1 * s, in = deep * (0.7 + 0.3 * std::cos(kWhole * s + phase));
    const Vec2 away = middle + 5 * out - centroid;
    const Polygon far = posed(moving, centroid, {away, turn});
    double way = HUGE_VAL;
    for (const Polygon& p : bed) way = std::min(way, way_until_touch(far, -out, p));
    std::vector<PathPose> all(bed.size() + 1);
    all[0].displacement = closed;
    all.back() = {away - (way + in) * out, turn};
    return all;
  };
  return path;
}

ContactPath drawn_path(char family, Draw& draw) {
  switch (family) {
    case 'a':
      return corner_over_joint(draw);
    case 'b':
      return sheared_crossing(draw);
    case 'c':
      return rocking_block(draw);
    case 'd':
      return passing_level(draw);
    case 'e':
      return corner_on_corner(draw);
    default:
      TALUS_ASSERT(family == 'f');
      return random_polygons(draw);
  }
}

}  // namespace

std::vector<Polygon> ContactPath::placed(double s) const {
  const std::vector<PathPose> at = pose(s);
  std::vector<Polygon> out;
  for (size_t i = 0; i < blocks.size(); ++i) out.push_back(posed(blocks[i], centroid[i], at[i]));
  return out;
}

ContactPath contact_path(char family, uint64_t seed, double deepest) {
  Draw draw(family, seed, deepest);
  ContactPath path = drawn_path(family, draw);
  path.family = family;
  // a bed as a model file has it, exactly level, is a case of its own; random polygons lie anyhow
  if (family != 'c' && family != 'f') turn_path(draw.angle(), path);
  measure(path);
  return path;
}

}  // namespace talus::test
