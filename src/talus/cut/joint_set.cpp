#include "talus/cut/joint_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "talus/base/error.h"
#include "talus/base/random.h"

namespace talus {

namespace {

constexpr double kMostTraces = 5e6;

// Planes within this angle [rad] of the section have no trace.
constexpr double kParallel = 1e-3;

double draw(const Scattered& s, Random& random) {
  switch (s.kind) {
    case Scattered::kConstant:
      return s.mean;
    case Scattered::kNormal:
      return s.mean + s.spread * random.normal();
    case Scattered::kUniform:
      return s.mean + s.spread * (2 * random.uniform() - 1);
    case Scattered::kExponential:
      return s.mean * random.exponential();
  }
  return s.mean;
}

// How far from the mean a drawn value may lie; rarer ones, less than one in a hundred million, may be missed
// at the edge of the regions.
double largest_spread(const Scattered& s) {
  switch (s.kind) {
    case Scattered::kConstant:
      return 0;
    case Scattered::kNormal:
      return 6 * s.spread;
    case Scattered::kUniform:
      return s.spread;
    case Scattered::kExponential:
      return 19 * s.mean;
  }
  return 0;
}

// Until it is positive.
double draw_positive(const Scattered& s, Random& random) {
  double v = draw(s, random);
  while (!(v > 0)) v = draw(s, random);
  return v;
}

// Joints that turn further than this [rad] from the mean are looked for as if they turned by this much.
constexpr double kLargestTurn = 1.4;

struct Vec3 {
  double x, y, z;
};

// Angle of the trace of a plane with pole p (east, north, up) in the section.
double trace_angle(Vec3 p, double azimuth) {
  const double along = p.x * std::sin(azimuth) + p.y * std::cos(azimuth);
  return std::atan2(-along, p.z);
}

// A pole scattered about that of the set by the Fisher distribution (theory 10.1).
Vec3 fisher_pole(const JointSetInput& set, Random& random) {
  const double sd = std::sin(set.dip), cd = std::cos(set.dip);
  const double sa = std::sin(set.dip_direction), ca = std::cos(set.dip_direction);
  const Vec3 mean{sd * sa, sd * ca, cd}, down{cd * sa, cd * ca, -sd}, strike{ca, -sa, 0};
  // cos of the angle from the mean, by the inverse of its distribution
  const double u = 1 - random.uniform();
  const double c = 1 + std::log(u + (1 - u) * std::exp(-2 * set.fisher)) / set.fisher;
  const double s = std::sqrt(std::max(0.0, 1 - c * c)), turn = 2 * std::numbers::pi * random.uniform();
  const double a = s * std::cos(turn), b = s * std::sin(turn);
  return {c * mean.x + a * down.x + b * strike.x, c * mean.y + a * down.y + b * strike.y,
          c * mean.z + a * down.z + b * strike.z};
}

class LineMaker {
 public:
  LineMaker(const JointSetInput& set, const JointSetNote& note, const CutInput& cut, const Box& box)
      : set_(set), note_(note), cut_(cut) {
    along_ = {std::cos(note.angle), std::sin(note.angle)};
    across_ = turn_left(along_);
    const Vec2 corner[4] = {box.min, {box.max.x, box.min.y}, box.max, {box.min.x, box.max.y}};
    for (const Vec2 c : corner) {
      const double s = dot(c - set.origin, across_), u = dot(c - set.origin, along_);
      lo_s_ = std::min(lo_s_, s), hi_s_ = std::max(hi_s_, s);
      lo_u_ = std::min(lo_u_, u), hi_u_ = std::max(hi_u_, u);
    }
    // lines that turn reach in from outside
    const double turn = std::min(
        set.fisher > 0 ? 6 / std::sqrt(set.fisher) * note.widening : largest_spread(set.angle), kLargestTurn);
    if (turn == 0) return;
    // a through-going line turns about its foot below the origin, a trace about its middle
    const double half = 0.5 * (set.trace_length.mean + largest_spread(set.trace_length));
    const double arm = is_through() ? std::max(std::abs(lo_u_), std::abs(hi_u_)) : half;
    const double reach_s = arm * (is_through() ? std::tan(turn) : std::sin(turn));
    lo_s_ -= reach_s, hi_s_ += reach_s;
    if (!is_through()) lo_u_ -= half, hi_u_ += half;
  }

  std::vector<std::pair<Vec2, Vec2>> make() {
    Random first(stream_seed(cut_.seed, set_.name));
    const double offset = draw(set_.offset, first);
    const double spacing = set_.spacing.mean * note_.widening;
    if (set_.spacing.kind == Scattered::kConstant) {
      const auto last = static_cast<int64_t>(std::floor((hi_s_ - offset) / spacing));
      for (auto k = static_cast<int64_t>(std::ceil((lo_s_ - offset) / spacing)); k <= last; ++k)
        add_line(k, offset + spacing * static_cast<double>(k));
      return std::move(lines_);
    }
    // outwards from line 0, each way with numbers of its own
    Random up(stream_seed(cut_.seed, set_.name + "+")), down(stream_seed(cut_.seed, set_.name + "-"));
    double s = offset;
    for (int64_t k = 0; s <= hi_s_; ++k, s += note_.widening * draw_positive(set_.spacing, up))
      if (s >= lo_s_) add_line(k, s);
    s = offset - note_.widening * draw_positive(set_.spacing, down);
    for (int64_t k = -1; s >= lo_s_; --k, s -= note_.widening * draw_positive(set_.spacing, down))
      if (s <= hi_s_) add_line(k, s);
    return std::move(lines_);
  }

 private:
  bool is_through() const { return set_.trace_length.mean == 0; }

  double draw_angle(Random& random) const {
    if (set_.fisher > 0) {
      // a trace has no sense of direction: the angle nearest to the mean
      const double angle = trace_angle(fisher_pole(set_, random), cut_.section_azimuth);
      return note_.angle + std::remainder(angle - note_.angle, std::numbers::pi);
    }
    return set_.in_space ? note_.angle : draw(set_.angle, random);
  }

  // A trace of the line at distance s, between u0 and u1 along it before it turns about its middle.
  void add_trace(double s, double u0, double u1, Random& random) {
    const Vec2 middle = set_.origin + s * across_ + 0.5 * (u0 + u1) * along_;
    const double angle = draw_angle(random), half = 0.5 * (u1 - u0);
    const Vec2 arm = half * Vec2{std::cos(angle), std::sin(angle)};
    lines_.emplace_back(middle - arm, middle + arm);
  }

  void add_line(int64_t k, double s) {
    Random random(stream_seed(cut_.seed, set_.name + "#", k));
    if (is_through()) {
      // long enough to leave the box however it turns
      const double half =
          2 * (std::max(std::abs(lo_u_), std::abs(hi_u_)) + std::max(std::abs(lo_s_), std::abs(hi_s_)));
      add_trace(s, -half, half, random);
      return;
    }
    const double start = draw(set_.start, random);
    Random forth(random.next()), back(random.next());
    for (double u = start; u <= hi_u_;) {
      const double end = u + draw_positive(set_.trace_length, forth);
      if (end >= lo_u_) add_trace(s, u, end, forth);
      u = end + std::max(draw(set_.gap, forth), 0.0);
    }
    for (double u = start; u >= lo_u_;) {
      const double end = u - std::max(draw(set_.gap, back), 0.0);
      u = end - draw_positive(set_.trace_length, back);
      if (u <= hi_u_) add_trace(s, u, end, back);
    }
  }

  const JointSetInput& set_;
  const JointSetNote& note_;
  const CutInput& cut_;
  Vec2 along_, across_;
  double lo_s_ = 1e300, hi_s_ = -1e300, lo_u_ = 1e300, hi_u_ = -1e300;
  std::vector<std::pair<Vec2, Vec2>> lines_;
};

}  // namespace

// Eq. 10.1.
ApparentDip apparent_dip(double dip, double dip_direction, double section_azimuth) {
  // components of the pole in the section: along +x and upwards
  const double x = std::sin(dip) * std::cos(dip_direction - section_azimuth), z = std::cos(dip);
  const double length = std::hypot(x, z);
  ApparentDip out;
  out.angle = std::atan2(-x, z);
  out.widening = length > 0 ? 1 / length : std::numeric_limits<double>::infinity();
  return out;
}

JointSetNote describe(const JointSetInput& set, double section_azimuth) {
  JointSetNote note;
  note.name = set.name;
  note.angle = set.angle.mean;
  note.in_space = set.in_space;
  if (set.in_space) {
    const ApparentDip a = apparent_dip(set.dip, set.dip_direction, section_azimuth);
    note.angle = a.angle;
    note.widening = a.widening;
    note.apparent_dip = -a.angle;
  }
  note.spacing = set.spacing.mean * note.widening;
  return note;
}

JointSetDefect joint_set_defect(const JointSetInput& set, const JointSetNote& note, const Box& box) {
  if (set.in_space && !(note.widening < 1 / kParallel))
    return {"dip_direction", "is parallel to the section: its joints have no trace in it", set.where};
  const double diagonal = norm(box.max - box.min);
  const double lines = diagonal / note.spacing, length = set.trace_length.mean + set.gap.mean;
  const bool in_traces = set.trace_length.mean > 0;
  const double traces = lines * (in_traces ? diagonal / length + 1 : 1);
  if (!(traces <= kMostTraces)) {
    const bool spacing = !(lines <= std::sqrt(kMostTraces)) || !in_traces;
    return {spacing ? "spacing" : "trace_length",
            fmt::format("makes about {:.2g} traces, more than {:g}; is a unit missing?", traces, kMostTraces),
            spacing ? set.where_spacing : set.where_length};
  }
  // what is drawn on the way from the origin to the box counts too
  const double away = norm(0.5 * (box.min + box.max) - set.origin) + std::abs(set.offset.mean) +
                      std::abs(set.start.mean) + set.offset.spread + set.start.spread;
  const double drawn = (set.spacing.kind != Scattered::kConstant ? away / note.spacing : 0) +
                       (in_traces ? lines * away / length : 0);
  if (!(drawn <= kMostTraces))
    return {
        "origin",
        fmt::format(
            "begins {:.2g} m from the middle of its regions, about {:.2g} joints away; give origin, offset "
            "and start near them",
            away, drawn),
        set.where};
  return {};
}

std::vector<std::pair<Vec2, Vec2>> joint_set_lines(const JointSetInput& set, const JointSetNote& note,
                                                   const CutInput& cut, const Box& box) {
  TALUS_ASSERT(joint_set_defect(set, note, box).text.empty());
  return LineMaker(set, note, cut, box).make();
}

}  // namespace talus
