#pragma once
// Random networks of lines that are hard to cut: nearly parallel, coincident, through corners and common
// points, ending on each other exactly or almost.

#include <numbers>

#include "support/cut_case.h"
#include "talus/base/index.h"
#include "talus/base/random.h"
#include "talus/geometry/shapes.h"

namespace talus::test {

class NetworkMaker {
 public:
  explicit NetworkMaker(uint64_t seed) : random_(seed) {}

  Model make() {
    make_outline();
    model_ = rock_model(outline_);
    model_.cut.seed = random_.next();
    for (size_t k = 0; k < outline_.size(); ++k)
      lines_.emplace_back(outline_[k], outline_[(k + 1) % outline_.size()]);
    if (chance(0.15)) add_pencil();
    const int parts = 2 + below(5);
    for (int i = 0; i < parts && budget_ > 0; ++i) add_part();
    while (chance(0.3)) add_random_opening();
    if (chance(0.1))
      add_region(model_, "inner", circle_polygon(inside(), between(0.1, 0.6) * size_, 3 + below(9)));
    return model_;
  }

 private:
  double between(double a, double b) { return a + (b - a) * random_.uniform(); }
  bool chance(double p) { return random_.uniform() < p; }
  int below(int n) { return static_cast<int>(random_.next() % static_cast<uint64_t>(n)); }
  double any_angle() { return between(0, std::numbers::pi); }
  double tiny(double from, double to) { return std::pow(10, between(from, to)) * (chance(0.5) ? 1 : -1); }
  static Vec2 direction(double angle) { return {std::cos(angle), std::sin(angle)}; }
  Vec2 inside() {
    const Box box = bounding_box(outline_);
    return {between(box.min.x, box.max.x), between(box.min.y, box.max.y)};
  }
  std::pair<Vec2, Vec2> some_line() { return lines_[below(count_of(lines_))]; }
  Vec2 some_corner() { return outline_[below(count_of(outline_))]; }

  void make_outline() {
    size_ = std::pow(10, between(0.3, 2.5));
    const double w = size_, h = size_ * between(0.3, 1);
    const int kind = below(5);
    if (kind == 0) outline_ = box_polygon(0, 0, w, h);
    if (kind == 1) outline_ = {{0, 0}, {w, 0}, {w, h / 3}, {w / 3, h / 3}, {w / 3, h}, {0, h}};
    if (kind == 2)
      outline_ = {{0, 0},       {w, 0}, {w, h}, {0.7 * w, h}, {0.7 * w, 0.2 * h}, {0.4 * w, 0.2 * h},
                  {0.4 * w, h}, {0, h}};
    if (kind >= 3) {
      const int n = 3 + below(9);
      for (int i = 0; i < n; ++i)
        outline_.push_back(between(0.2, 1) * (size_ / 2) *
                           direction(2 * std::numbers::pi * (i + between(0, 0.8)) / n));
    }
    const double angle = chance(0.5) ? 0 : any_angle();
    Vec2 shift{};
    if (chance(0.4)) shift = {between(-1000, 1000), between(-1000, 1000)};
    if (chance(0.2)) shift = {between(4e6, 6e6), between(4e6, 6e6)};
    for (Vec2& p : outline_)
      p = shift + Vec2{dot(p, direction(-angle)), dot(p, direction(0.5 * std::numbers::pi - angle))};
  }

  void add_line(Vec2 a, Vec2 b) {
    lines_.emplace_back(a, b);
    add_fault(model_, {a, b});
    --budget_;
  }
  void add_through(Vec2 p, double angle) {
    const Vec2 arm = 2 * size_ * direction(angle);
    add_line(p - arm, p + arm);
  }

  // forty lines through one point: inside, at a corner or on a side
  void add_pencil() {
    const int where = below(3);
    const auto [a, b] = some_line();
    const Vec2 p = where == 0 ? inside() : where == 1 ? some_corner() : a + random_.uniform() * (b - a);
    const double span = chance(0.5) ? std::numbers::pi : std::pow(10, between(-6, -1)), first = any_angle();
    for (int i = 0; i < 40; ++i) add_through(p, first + span * i / 40);
    budget_ = 3;
  }

  void add_part() {
    const int kind = below(10);
    const auto [a, b] = some_line();
    const Vec2 along = b - a, normal = turn_left(along) / norm(along);
    const int n = 1 + below(4);
    switch (kind) {
      case 0:  // a set and one nearly parallel to it
      case 1: {
        const double angle = any_angle(), spacing = size_ / between(2, 6);
        const Vec2 origin = inside();
        for (int i = 0; i < 2 && budget_ > 0; ++i, budget_ -= 4) {
          JointSetInput s = joint_set(fmt::format("set{}", model_.joint_sets.size()), angle, spacing);
          s.origin = origin;
          if (i == 1 && kind == 0) s.angle.mean += tiny(-7, -1);
          if (i == 1 && kind == 1) s.angle.mean = any_angle();
          if (chance(0.3)) {
            s.trace_length = {Scattered::kUniform, size_ / 3, size_ / 6};
            s.gap.mean = chance(0.5) ? 0 : size_ / 10;
            s.start = {Scattered::kUniform, 0, size_};
          }
          if (chance(0.2)) s.spacing.kind = Scattered::kExponential, s.spacing.mean *= 2;
          model_.joint_sets.push_back(s);
        }
        break;
      }
      case 2:  // nearly parallel to a line, through a point near it
        for (int i = 0; i < n; ++i)
          add_through(a + random_.uniform() * along, std::atan2(along.y, along.x) + tiny(-7, -1));
        break;
      case 3: {  // coincident: the whole line, backwards, or a piece of it
        double s = random_.uniform(), t = random_.uniform();
        if (chance(0.5)) s = below(2), t = 1 - s;
        add_line(a + s * along, a + t * along);
        break;
      }
      case 4:  // shifted by next to nothing
        for (int i = 0; i < n; ++i) {
          const Vec2 shift = tiny(-9, -5) * normal;
          add_line(a + shift, b + shift);
        }
        break;
      case 5:  // through corners of the outline, or almost
        for (int i = 0; i < n; ++i) {
          const Vec2 p = some_corner(), q = chance(0.5) ? some_corner() : inside();
          const Vec2 d = p == q ? Vec2{1, 0} : q - p;
          add_through(p + (chance(0.3) ? tiny(-9, -5) : 0) * turn_left(d) / norm(d), std::atan2(d.y, d.x));
        }
        break;
      case 6:  // ends on another line, or almost
        for (int i = 0; i < n; ++i) {
          const Vec2 from = inside(), end = a + random_.uniform() * along;
          const Vec2 more = chance(0.5) ? Vec2{} : tiny(-9, -6) / norm(end - from) * (end - from);
          add_line(from, end + more);
          add_line(end, inside());
        }
        break;
      case 7: {  // a bent fault
        std::vector<Vec2> points;
        for (int i = 0; i < 3 + n; ++i) points.push_back(inside());
        add_fault(model_, points);
        budget_ -= 2 + n;
        break;
      }
      case 8:  // ends somewhere
        for (int i = 0; i < 2 * n; ++i) add_line(inside(), inside());
        break;
      default:  // through-going
        for (int i = 0; i < n; ++i) add_through(inside(), any_angle());
    }
  }

  void add_random_opening() {
    const double d = size_ * std::pow(10, between(-1.3, -0.3));
    const auto [a, b] = some_line();
    Vec2 center = inside();
    // next to a line, within a hair
    if (chance(0.3))
      center = a + random_.uniform() * (b - a) + (0.5 * d + tiny(-9, -3)) / norm(b - a) * turn_left(b - a);
    const int kind = below(3);
    add_opening(model_,
                kind == 0 ? circle_polygon(center, d, 3 + below(30))
                : kind == 1
                    ? horseshoe_polygon(center, d, between(0.5, 1.5) * d, 2 + below(10))
                    : Polygon{center, center + Vec2{d, 0}, center + Vec2{d / 3, d / 3}, center + Vec2{0, d}},
                chance(0.5));
  }

  Random random_;
  Model model_;
  Polygon outline_;
  double size_ = 1;  // [m]
  int budget_ = 14;  // lines that may still be added
  std::vector<std::pair<Vec2, Vec2>> lines_;
};

}  // namespace talus::test
