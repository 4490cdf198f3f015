#include "talus/audit/check_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "talus/audit/overlap_energy.h"
#include "talus/audit/shapes.h"
#include "talus/audit/tip.h"
#include "talus/base/index.h"

namespace talus::audit {

namespace {

// Limits beyond which a frame warns, and is no longer valid. None can be set: a threshold that can be moved
// certifies nothing.
constexpr double kOverlapWarns = 1e-4, kOverlapInvalid = 1e-2;  // unexplained, of the smaller block's area
constexpr double kPrescribed = 1e-6;                            // overlap of prescribed blocks, the same
constexpr double kClosureWarns = 0.05, kClosureInvalid = 0.25;  // of the smaller mean thickness
constexpr double kHairGap = 1e-4;  // half the width of joints closed before that, of the smaller block
constexpr double kFace = 1e-2;     // of the smaller block: length of a face that speaks for its side
constexpr double kAside = 5 * 3.14159265358979323846 / 180;  // a normal off the outline [rad]
// forces below the first share of the mean one are round-off of redundant points; a wrong one above the
// second is more than the error of a force
constexpr double kForceSeen = 1e-4, kForceInvalid = 1e-2;
// of the smaller block: what the foot and the gap of a followed point may be off by
constexpr double kPlace = 1e-5;
// a resultant above its limit by this share; solvers put forces on their cone to some digits
constexpr double kLawSlack = 1e-3;
// elastic normal force against stiffness x overlap: a closure that is linear along a face, one end of which
// has opened, is off by up to 2
constexpr double kNormalWarns = 2, kNormalInvalid = 4;
// force against the energy of the overlap, as share of the larger: rows are exact to the tolerance of the solver, finite
// differences to 1e-6. Compared only where the former is below the first share too
constexpr double kEnergyWarns = 1e-2, kEnergyInvalid = 3e-2;
// A comparison takes about 10 us: so many a frame take some 5 ms.
constexpr int kMostByEnergy = 500;
// What coordinates are rounded to, and distances seen from a corner nearby, times what differences make of it.
constexpr double kRoundOff = 1e-15, kRoundOffNear = 1e-12;
// of the mean force: what the joint of an overlap without a point would push with
constexpr double kPushWarns = 1e-2, kPushInvalid = 0.1;
constexpr double kBeside = 0.1;     // of the smaller block: where what a corner stands on ends near it
constexpr double kOtherWay = 0.9;   // cosine of the angle between normals of two sides of a corner, at most
constexpr double kAlongside = 0.1;  // sides that make an interface are antiparallel within [rad]

struct Pair {
  int a, b;        // a < b
  int begin, end;  // of its points, in PairIndex::order
};

class Check {
 public:
  Check(const Rules& rules, const Frame& frame, int64_t turn) : rules_(rules), frame_(frame) {
    const size_t n = frame.blocks.size();
    size_.assign(n, 0), area_.assign(n, 0);
    for (size_t i = 0; i < n; ++i) {
      if (frame.blocks[i].hold == Hold::kRemoved) continue;
      area_[i] = std::abs(signed_area(frame.blocks[i].polygon));
      size_[i] = std::sqrt(area_[i]);
    }
    take_points();
    list_pairs();
    choose_by_energy(turn);
  }

  FrameResult run(const Workers& workers) {
    std::vector<FrameResult> part(pairs_.size());
    constexpr size_t kGrain = 64;
    workers.for_chunks(pairs_.size(), kGrain, [&](size_t begin, size_t end) {
      for (size_t q = begin; q < end; ++q) check_pair(pairs_[q], part[q]);
    });
    FrameResult all;
    for (const Point& p : frame_.points) {
      const double force = std::abs(p.normal_force);
      all.slack +=
          force * (rules_.slop * size_of(p.block_a, p.block_b) + 2 * rules_.tolerance + rules_.give * force);
    }
    for (FrameResult& r : part) {
      all.findings.insert(all.findings.end(), r.findings.begin(), r.findings.end());
      if (r.unexplained_share > all.unexplained_share)
        all.unexplained_share = r.unexplained_share, all.unexplained_area = r.unexplained_area;
      all.closure_share = std::max(all.closure_share, r.closure_share);
      all.patches_by_energy += r.patches_by_energy;
    }
    return all;
  }

 private:
  // A point with what the polygons say of it.
  struct Seen {
    Vec2 place, normal;  // from block b into block a
    double depth = 0;    // of positions, 0: apart [m]
    double gap = 0;
    double approach = 0;  // the larger of the speeds against each other before and after the kick [m/s]
    double closing = 0;   // the most they may close a gap at within the step [m/s]
  };

  const Polygon& polygon(int i) const { return frame_.blocks[i].polygon; }
  double size_of(int a, int b) const { return std::min(size_[a], size_[b]); }
  double extent(const Polygon& p) const {
    const Box box = bounding_box(p);
    return norm(box.max - box.min);
  }
  double area_of(int a, int b) const { return std::min(area_[a], area_[b]); }
  bool prescribed(int i) const { return frame_.blocks[i].hold == Hold::kPrescribed; }
  const Law* law_of(const Point& p) const { return p.joint < 0 ? nullptr : &rules_.laws[p.joint]; }

  void take_points() {
    const size_t n = frame_.points.size();
    seen_.resize(n), tied_.assign(frame_.blocks.size(), false);
    bool corners = false;
    double sum = 0;
    int forces = 0;
    for (size_t i = 0; i < n; ++i) {
      const Point& p = frame_.points[i];
      const double force = std::hypot(p.normal_force, p.shear_force);
      if (force > 0) sum += force, ++forces;
      seen_[i] = p.bond() ? see_bond(p) : p.patch() ? see_patch(p) : see_contact(p);
      if (p.bond()) tied_[p.block_a] = tied_[p.block_b] = true;
      corners = corners || !(p.bond() || p.patch());
    }
    if (!corners && rules_.joints_everywhere && !rules_.changes) softest_ = softest();
    mean_force_ = forces > 0 ? sum / forces : 0;
  }

  // The least stiffness across any joint [Pa/m]; 0 where one is hard.
  double softest() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Law& law : rules_.laws)
      if (!law.bonded) least = std::min(least, law.normal_stiffness);
    return std::isfinite(least) ? least : 0;
  }

  double stiffest() const {
    double most = 0;
    for (const Law& law : rules_.laws)
      if (!law.bonded) most = std::max(most, law.normal_stiffness);
    return most;
  }

  Seen see_patch(const Point& p) const {
    Seen s;
    s.place = p.place, s.normal = p.normal, s.gap = p.gap, s.depth = std::max(0.0, -p.gap);
    const Block &a = frame_.blocks[p.block_a], &b = frame_.blocks[p.block_b];
    const auto moves = [&](std::vector<Vec2> Block::*velocity) {
      return velocity_at(a, p.place, velocity) - velocity_at(b, p.place, velocity);
    };
    const Vec2 now = moves(&Block::velocity);
    s.approach = std::abs(dot(s.normal, now));
    // by what the frame tells of the step, the same in the run and from its folder
    const bool told = std::isfinite(p.closing) && frame_.step > 0;
    if (told) s.approach = std::max(s.approach, std::abs(p.closing) / frame_.step);
    s.closing = told ? s.approach : norm(now);
    return s;
  }

  Seen see_contact(const Point& p) const {
    const Polygon &a = polygon(p.block_a), &b = polygon(p.block_b);
    const size_t v = p.corner, e = p.edge, next = (e + 1) % b.size();
    Seen s;
    const Vec2 side = b[next] - b[e];
    s.place = a[v], s.normal = turn_right(side) / norm(side);
    s.gap = p.gap, s.depth = std::max(0.0, -p.gap);
    const double along = std::clamp(dot(a[v] - b[e], side) / dot(side, side), 0.0, 1.0);
    const Block &block_a = frame_.blocks[p.block_a], &block_b = frame_.blocks[p.block_b];
    const auto moves = [&](std::vector<Vec2> Block::*velocity) {
      return moves_against(block_a, v, block_b, e, along, velocity);
    };
    const Vec2 now = moves(&Block::velocity);
    s.approach = std::abs(dot(s.normal, now));
    // elastic laws look at the velocities before and after the kick
    const bool known = !block_a.next.empty() || !block_b.next.empty();
    if (known) s.approach = std::max(s.approach, std::abs(dot(s.normal, moves(&Block::next))));
    s.closing = known ? s.approach : norm(now);
    return s;
  }

  // The end of a glued face is a place on block a: its gap is that over the side of b which lies along the
  // face.
  Seen see_bond(const Point& p) const {
    Seen s;
    s.place = p.place;
    if (p.partner < 0) return s;
    const Vec2 other = frame_.points[p.partner].place;
    const Vec2 face = other - p.place, middle = p.place + 0.5 * face;
    const double length = norm(face);
    if (length == 0) return s;
    const Polygon& b = polygon(p.block_b);
    double nearest = length;  // farther off there is no face
    for (size_t k = 0; k < b.size(); ++k) {
      const Vec2 side = b[(k + 1) % b.size()] - b[k];
      const double l = norm(side);
      if (l == 0 || std::abs(cross(face, side)) > kAlongside * length * l) continue;
      const double off = distance_to_segment(middle, b[k], b[(k + 1) % b.size()]);
      if (off >= nearest) continue;
      nearest = off;
      s.normal = turn_right(side) / l;
      s.gap = dot(s.normal, p.place - b[k]);
    }
    s.depth = std::max(0.0, -s.gap);
    return s;
  }

  // Pairs whose boxes overlap, and pairs that have points.
  void list_pairs() {
    std::vector<Box> boxes;
    std::vector<int> block;
    for (int i = 0; i < count_of(frame_.blocks); ++i) {
      if (frame_.blocks[i].hold == Hold::kRemoved) continue;
      boxes.push_back(bounding_box(frame_.blocks[i].polygon));
      block.push_back(i);
    }
    // neighbours across a hair gap too
    double margin = 0;
    for (const int i : block) margin += 2 * kHairGap * size_[i] / static_cast<double>(block.size());
    std::vector<std::pair<int, int>> list;
    for (const auto& [i, j] : close_pairs(boxes, margin)) list.emplace_back(block[i], block[j]);
    const auto pair_of = [this](int i) {
      const Point& p = frame_.points[i];
      return std::minmax(p.block_a, p.block_b);
    };
    for (int i = 0; i < count_of(frame_.points); ++i) {
      order_.push_back(i);
      list.emplace_back(pair_of(i));
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    std::stable_sort(order_.begin(), order_.end(), [&](int x, int y) {
      return std::pair<int, int>(pair_of(x)) < std::pair<int, int>(pair_of(y));
    });
    size_t next = 0;
    neighbours_.resize(frame_.blocks.size());
    for (const auto& [a, b] : list) {
      Pair pair{a, b, static_cast<int>(next), 0};
      while (next < order_.size() && std::pair<int, int>(pair_of(order_[next])) == std::pair{a, b}) ++next;
      pair.end = static_cast<int>(next);
      neighbours_[a].push_back({b, count_of(pairs_)});
      neighbours_[b].push_back({a, count_of(pairs_)});
      pairs_.push_back(pair);
    }
  }

  // Pairs whose force is known from the energy of their overlap alone: one patch of one elastic joint, closed along its
  // whole chord, nothing kept from the start or by a rise, no cut and no tied side. Of too many, every so manyth.
  void choose_by_energy(int64_t turn) {
    by_energy_.assign(pairs_.size(), false);
    if (rules_.in_situ || rules_.changes) return;
    std::vector<size_t> fit;
    for (size_t q = 0; q < pairs_.size(); ++q)
      if (has_energy(pairs_[q])) fit.push_back(q);
    const size_t every = std::max<size_t>(1, (fit.size() + kMostByEnergy - 1) / kMostByEnergy);
    for (size_t k = turn % every; k < fit.size(); k += every) by_energy_[fit[k]] = true;
  }

  bool has_energy(const Pair& pair) const {
    if (pair.end - pair.begin != 2 || tied_[pair.a] || tied_[pair.b]) return false;
    double normal = 0;
    for (int k = pair.begin; k < pair.end; ++k) {
      const int i = order_[k];
      const Point& p = frame_.points[i];
      const Law* law = law_of(p);
      if (!p.patch() || p.partner < 0 || !law || law->normal_stiffness <= 0 || law->dilates ||
          !std::isfinite(p.closing) || p.normal_force <= 0)
        return false;
      normal += p.normal_force;
    }
    return normal > kForceInvalid * mean_force_;
  }

  Finding finding(Defect defect, bool invalid, int a, int b, Vec2 place, double share,
                  std::string text) const {
    return {defect, invalid, a, b, frame_.time, place, share, std::move(text)};
  }

  void check_pair(const Pair& pair, FrameResult& out) const {
    check_overlap(pair, out);
    if (by_energy_[&pair - pairs_.data()]) check_energy(pair, out);
    check_tip(pair, out);
    for (int k = pair.begin; k < pair.end; ++k) {
      const int i = order_[k];
      const Point& p = frame_.points[i];
      check_closure(p, seen_[i], out);
      check_shear(i, out);
      if (p.bond() || std::hypot(p.normal_force, p.shear_force) <= kForceSeen * mean_force_) continue;
      check_gap(p, seen_[i], out);
      check_joint(p, seen_[i], out);
      if (!p.patch()) check_side(p, seen_[i], out);
    }
  }

  // Check 1 and 6: what the two have in common against what their points account for.
  void check_overlap(const Pair& pair, FrameResult& out) const {
    const int a = pair.a, b = pair.b;
    const Common common = common_part(polygon(a), polygon(b));
    if (common.area <= 0 && pair.begin == pair.end) return;
    const double smaller = area_of(a, b);
    if (prescribed(a) && prescribed(b)) {
      const double share = common.area / smaller;
      if (share > kPrescribed)
        out.findings.push_back(finding(Defect::kPrescribedOverlap, true, a, b, common.at, share,
                                       fmt::format("two fixed or driven blocks overlap by {:.3g} m2, {:.2g} "
                                                   "% of the smaller; nothing keeps them apart",
                                                   common.area, 100 * share)));
      return;
    }
    const double explained = explained_by_points(pair);
    const double left = common.area - explained;
    if (left > 1e-9 * smaller) {
      const double rest = std::max(0.0, left - crossing_product(pair, common));
      const double share = rest / smaller;
      if (share > out.unexplained_share) out.unexplained_share = share, out.unexplained_area = rest;
      if (share > kOverlapWarns)
        out.findings.push_back(finding(Defect::kUnexplainedOverlap,
                                       share > kOverlapInvalid && is_felt(pair, rest), a, b, common.at, share,
                                       fmt::format("they overlap by {:.3g} m2, {:.3g} m2 of it ({:.2g} % of "
                                                   "the smaller block) at no point that the run knows of",
                                                   common.area, rest, 100 * share)));
    }
    if (pair.begin == pair.end) check_push(pair, common, out);
    if (common.area <= 0) check_apart(pair, out);
    check_normal(pair, common, out);
  }

  // Whether an overlap would push with a force that tells beside the others: of a crumb that is hardly larger than what joints
  // close by it does not. Hard and unknown joints push with anything.
  bool is_felt(const Pair& pair, double area) const {
    if (pair.begin == pair.end && softest() == 0) return true;
    double stiffness = pair.begin == pair.end ? stiffest() : 0;
    for (int k = pair.begin; k < pair.end; ++k) {
      const Law* law = law_of(frame_.points[order_[k]]);
      if (!law || law->normal_stiffness == 0) return true;
      stiffness = std::max(stiffness, law->normal_stiffness);
    }
    return !(stiffness * rules_.thickness * area <= kPushWarns * mean_force_);
  }

  // An overlap without any point, by the force that the softest joint would make of it: what is a share of 1e-4 of a block is
  // a large force where joints are stiff. Not asked beside bonds: behind a tied side there is no way out.
  void check_push(const Pair& pair, const Common& common, FrameResult& out) const {
    if (softest_ == 0 || mean_force_ == 0 || tied_[pair.a] || tied_[pair.b]) return;
    const double area = std::max(0.0, common.area - crossing_product(pair, common));
    const double push = softest_ * rules_.thickness * area, share = push / mean_force_;
    if (share <= kPushWarns) return;
    out.findings.push_back(finding(
        Defect::kUnexplainedOverlap, share > kPushInvalid, pair.a, pair.b, common.at,
        area / area_of(pair.a, pair.b),
        fmt::format(
            "they overlap by {:.3g} m2 at no point that the run knows of, where a joint would push with {:.4g} N",
            area, push)));
  }

  // Check 2, by the outlines: patches that press though the two are apart. They may be so by what closes the gap before the
  // force acts, by rise and by what the ground has closed; what of the latter lies in sides that did not face each other at
  // the start no patch tells.
  void check_apart(const Pair& pair, FrameResult& out) const {
    double normal = 0, may = 0;
    Vec2 place;
    for (int k = pair.begin; k < pair.end; ++k) {
      const int i = order_[k];
      const Point& p = frame_.points[i];
      if (!p.patch()) return;
      if (p.normal_force > 0) normal += p.normal_force, place = seen_[i].place;
      const double closing = std::isfinite(p.closing) ? p.closing : 3 * frame_.step * seen_[i].closing;
      may = std::max(may, std::max(0.0, closing) + p.rise + 2 * p.in_situ);
      if (rules_.in_situ && p.in_situ == 0) return;
    }
    const double size = size_of(pair.a, pair.b);
    const double allowed = may + (kPlace + rules_.slop) * size + 2 * rules_.tolerance;
    if (normal <= kForceSeen * mean_force_ || !std::isfinite(allowed)) return;
    const double apart = distance_between(polygon(pair.a), polygon(pair.b));
    if (apart <= allowed) return;
    out.findings.push_back(finding(
        Defect::kForceAcrossGap, normal > kForceInvalid * mean_force_, pair.a, pair.b, place,
        (apart - allowed) / size,
        fmt::format("a force of {:.4g} N between outlines that are {:.3g} m apart, where {:.2g} m may be",
                    normal, apart, allowed)));
  }

  // Check 4, exactly: the force of a patch is minus the gradient of the energy of the overlap, taken by finite differences,
  // and what its stiffness makes of the way to where the force belongs.
  void check_energy(const Pair& pair, FrameResult& out) const {
    const int i = order_[pair.begin];
    const Point &p = frame_.points[i], &q = frame_.points[p.partner];
    const Polygon &a = polygon(p.block_a), &b = polygon(p.block_b);
    if (!is_convex(a) || !is_convex(b)) return;
    const OverlapForce overlap = overlap_force(a, b);
    const double moves = norm(overlap.force);
    const double stiffness = law_of(p)->normal_stiffness * rules_.thickness;
    const double wanted = stiffness * (moves + overlap.chord * 0.5 * (p.closing + q.closing));
    const double found = p.normal_force + q.normal_force;
    double far = 0;
    for (const Vec2 x : {p.place, q.place}) far = std::max({far, std::abs(x.x), std::abs(x.y)});
    // what its own overlap is rounded to says nothing of a patch
    const double rounding = kRoundOff * far + kRoundOffNear * std::max(extent(a), extent(b));
    if (!(moves > 100 * rounding * overlap.chord)) return;
    const double slack = stiffness * overlap.chord * (2 * rules_.tolerance + rounding);
    const double larger = std::max(std::abs(wanted), found);
    if (slack > kEnergyWarns * larger) return;
    ++out.patches_by_energy;
    const double off = norm(found * seen_[i].normal - wanted / moves * overlap.force) - slack;
    if (off <= kEnergyWarns * larger) return;
    out.findings.push_back(finding(
        Defect::kEnergyLaw, off > kEnergyInvalid * larger, pair.a, pair.b, seen_[i].place, off / larger,
        fmt::format(
            "a normal force of {:.6g} N, where the energy of what the two have in common asks for {:.6g} N",
            found, wanted)));
  }

  // The trapezium of the two ends of each face and the cells at these, the wedge of each corner alone, and what the solver
  // may leave.
  double explained_by_points(const Pair& pair) const {
    const double size = size_of(pair.a, pair.b);
    const double left = rules_.slop * size + rules_.tolerance;
    double sum = 0;
    for (int k = pair.begin; k < pair.end; ++k) {
      const int i = order_[k];
      const Point& p = frame_.points[i];
      const Seen& s = seen_[i];
      if (p.partner >= 0) {
        if (p.partner < i) continue;  // counted with its other end
        const Seen& o = seen_[p.partner];
        const double length = norm(o.place - s.place);
        sum += trapezium(s.gap, o.gap, length) + left * length;
        if (p.patch()) sum += end_cell(s.gap) + end_cell(o.gap);
      } else if (!p.bond() && !p.patch()) {
        sum += wedge(p, s, s.depth + left);
      }
    }
    return sum;
  }

  // What of an overlap is at an end of a patch nearer to the sides beside the face than to it, and pushes along it.
  static double end_cell(double gap) { return gap < 0 ? gap * gap : 0; }

  // Area below zero of a gap that is linear along a face.
  static double trapezium(double gap_0, double gap_1, double length) {
    const double low = -std::min(gap_0, gap_1), high = -std::max(gap_0, gap_1);
    if (low <= 0) return 0;
    if (high >= 0) return 0.5 * (low + high) * length;
    return 0.5 * low * length * low / (low - high);
  }

  // What of a corner lies below a line at its depth, between the ends of the side it acts on.
  double wedge(const Point& p, const Seen& s, double depth) const {
    if (depth <= 0) return 0;
    const Polygon &a = polygon(p.block_a), &b = polygon(p.block_b);
    const int v = p.corner, e = p.edge;
    const Polygon legs{a[v], a[(v + 1) % a.size()], a[(v + a.size() - 1) % a.size()]};
    if (signed_area(legs) <= 0) return 0;  // a notch bears nothing
    const Vec2 from = b[e], to = b[(e + 1) % b.size()], side = (to - from) / norm(to - from);
    Polygon part = cut_below(legs, a[v] + depth * s.normal, s.normal);
    if (part.size() > 2) part = cut_below(part, from, -side);
    if (part.size() > 2) part = cut_below(part, to, side);
    return part.size() > 2 ? std::abs(signed_area(part)) : 0;
  }

  // At a crossing of joints the blocks across the corner overlap by the product of the closures of the two
  // joints that each has with a neighbour of both. Twice that: the joints need not be at right angles.
  double crossing_product(const Pair& pair, const Common& common) const {
    double most = 0;
    const double reach = 3 * std::sqrt(common.area) + kPlace * size_of(pair.a, pair.b);
    const auto& of_a = neighbours_[pair.a];
    const auto& of_b = neighbours_[pair.b];
    for (size_t x = 0, y = 0; x < of_a.size() && y < of_b.size();) {
      if (of_a[x].block != of_b[y].block) {
        of_a[x].block < of_b[y].block ? ++x : ++y;
        continue;
      }
      const double closure_a = closure_near(of_a[x].pair, common.at, reach),
                   closure_b = closure_near(of_b[y].pair, common.at, reach);
      most = std::max(most, 2 * closure_a * closure_b);
      ++x, ++y;
    }
    return most;
  }

  // The deepest closure of a pair at points within `reach` of a place, counted with its own depth.
  double closure_near(int pair, Vec2 place, double reach) const {
    const Pair& q = pairs_[pair];
    double most = rules_.slop * size_of(q.a, q.b) + rules_.tolerance;
    for (int k = q.begin; k < q.end; ++k) {
      const Seen& s = seen_[order_[k]];
      if (norm(s.place - place) <= reach + 3 * s.depth) most = std::max(most, s.depth);
    }
    return most;
  }

  // Check 8: closure, less the rise of the joint over its roughness, against the thinner of the two blocks.
  void check_closure(const Point& p, const Seen& s, FrameResult& out) const {
    const double closure = p.rise - s.gap;
    if (closure <= 0 || norm(s.normal) == 0) return;
    const Vec2 along = turn_right(s.normal);
    const double thickness =
        std::min(mean_thickness(polygon(p.block_a), along), mean_thickness(polygon(p.block_b), along));
    const double share = closure / thickness;
    if (s.depth > 0) out.closure_share = std::max(out.closure_share, share);
    if (share <= kClosureWarns || s.depth <= 0) return;
    out.findings.push_back(
        finding(Defect::kDeepClosure, share > kClosureInvalid, p.block_a, p.block_b, s.place, share,
                fmt::format("they have closed by {:.3g} m, {:.2g} % of the smaller mean thickness{}", closure,
                            100 * share,
                            p.in_situ > 0 && std::isfinite(p.in_situ)
                                ? fmt::format(", besides {:.3g} m by the stress of the ground", p.in_situ)
                                : "")));
  }

  // Check 2. A force acts over the step: it may close the gap that the two cross within it. Beyond that a gap
  // may be off by what a followed point is (kPlace of the smaller block) and by the error of the solver.
  void check_gap(const Point& p, const Seen& s, FrameResult& out) const {
    const double size = size_of(p.block_a, p.block_b);
    const double allowed = p.rise + p.in_situ + kPlace * size + rules_.slop * size + 2 * rules_.tolerance +
                           3 * frame_.step * s.closing;
    if (s.gap <= allowed) return;
    // an elastic face that has closed at its other end pushes with its whole length
    const Law* law = law_of(p);
    const bool soft = p.joint == kUnknownJoint || (law && law->normal_stiffness > 0);
    if (soft && p.partner >= 0) {
      const int other = p.partner;
      // or is closing there within the step
      if (seen_[other].gap <
          frame_.points[other].in_situ + frame_.points[other].rise + 3 * frame_.step * seen_[other].closing)
        return;
    }
    const double share = (s.gap - allowed) / size;
    out.findings.push_back(
        finding(Defect::kForceAcrossGap, std::abs(p.normal_force) > kForceInvalid * mean_force_, p.block_a,
                p.block_b, s.place, share,
                fmt::format("a force of {:.4g} N across a gap of {:.3g} m, where {:.2g} m may be",
                            p.normal_force, s.gap, allowed)));
  }

  void check_joint(const Point& p, const Seen& s, FrameResult& out) const {
    if (p.joint != kNoJoint || !rules_.joints_everywhere) return;
    out.findings.push_back(
        finding(Defect::kNoJoint, false, p.block_a, p.block_b, s.place, p.normal_force / mean_force_,
                fmt::format("a force of {:.4g} N at a point without a joint", p.normal_force)));
  }

  // Check 3: the normal against the outline of what lies around the corner, the corner's own body left out.
  // Joints that are hair gaps are closed first, else they hide that a side is covered; a corner that has
  // fallen deeper into such a gap than the overlap bears on its side, and only gaps up to the overlap are
  // closed. Sides of the outline shorter than the overlap are none: a corner that stands deeper than a step
  // is high is past it.
  void check_side(const Point& p, const Seen& s, FrameResult& out) const {
    const double size = size_of(p.block_a, p.block_b);
    const int a = p.block_a;
    // along a face the side is exposed to the corner's own block: nothing else can cover it there
    if (p.partner >= 0) {
      const Seen& o = seen_[p.partner];
      if (norm(o.place - s.place) > kFace * size &&
          std::max(std::abs(o.gap), std::abs(s.gap)) < 0.1 * kFace * size)
        return;
    }
    if (stands_before_step(p, s)) return;
    double overlap = std::max(s.depth, std::abs(s.gap)) + kPlace * size;
    for (const Neighbour& n : neighbours_[a])
      overlap = std::max(overlap, closure_near(n.pair, s.place, 0.02 * size));
    overlap = std::min(overlap, 0.05 * size);
    const double hair = std::max(overlap, kHairGap * size);
    // only where another block lies on the far side of this one
    std::vector<const Polygon*> around{&polygon(p.block_b)};
    const std::vector<int> own = glued_to(p.block_a, p.block_b);
    bool covered = false;
    const Vec2 ahead = s.place + (overlap - s.gap) * s.normal;
    for (const Neighbour& n : neighbours_[p.block_b]) {
      if (std::find(own.begin(), own.end(), n.block) != own.end()) continue;
      around.push_back(&polygon(n.block));
      covered = covered || depth_in(polygon(n.block), ahead) > -2 * hair;
    }
    if (!covered) return;
    const double reach = 10 * std::max(2 * overlap, hair);
    for (const double closing : {hair, overlap}) {
      double along = 0, nearest = reach;  // length of the outline that faces as the normal does
      for (const Side& side : outline_near(around, s.place, reach, closing)) {
        const double off = distance_to_segment(s.place, side.from, side.to);
        nearest = std::min(nearest, off);
        const Vec2 d = side.to - side.from;
        if (off > 4 * overlap || norm(d) == 0) continue;
        const double turned = std::atan2(cross(s.normal, turn_right(d)), dot(s.normal, turn_right(d)));
        if (std::abs(turned) <= kAside) along += norm(d);
      }
      if (along > overlap) return;
      if (nearest <= 2 * overlap) break;  // at the surface
    }
    const double share = std::abs(p.normal_force) / mean_force_;
    out.findings.push_back(finding(
        Defect::kCoveredSide, share > kForceInvalid, p.block_a, p.block_b, s.place, share,
        fmt::format("a corner of \"{}\" bears with {:.4g} N on a side of \"{}\" that the next block "
                    "covers (normal {:.2g}, {:.2g})",
                    rules_.names[a], p.normal_force, rules_.names[p.block_b], s.normal.x, s.normal.y)));
  }

  // Check 3 of patches: a force that pushes out through a side behind which third blocks lie. Of a tip between two blocks
  // such a side is no way out.
  void check_tip(const Pair& pair, FrameResult& out) const {
    // in the first step what presses has not closed anything yet
    if (frame_.time == 0) return;
    for (int k = pair.begin; k < pair.end; ++k) {
      const int i = order_[k];
      const Point& p = frame_.points[i];
      if (!p.patch() || p.partner < i) continue;
      const Point& q = frame_.points[p.partner];
      const double force = p.normal_force + q.normal_force, share = force / mean_force_;
      if (!(share > kPushWarns)) continue;
      const Seen &s = seen_[i], &o = seen_[p.partner];
      const Pressed at{
          (p.normal_force * s.place + q.normal_force * o.place) / force, 0.5 * (s.place + o.place),
          std::max(s.depth, o.depth) + kPlace * size_of(pair.a, pair.b), norm(o.place - s.place)};
      const double off = std::max(through_thirds(p.block_b, p.block_a, s.normal, at),
                                  through_thirds(p.block_a, p.block_b, -s.normal, at));
      if (off * share <= kPushWarns) continue;
      out.findings.push_back(finding(
          Defect::kCoveredSide, off * share > kPushInvalid, pair.a, pair.b, at.place, off * share,
          fmt::format(
              "the tip of one is pressed with {:.4g} N in a corner between blocks, against what the next block is in the way "
              "of: {:.2g} of that force has a wrong direction, and those beside it are off by as much",
              force, off)));
    }
  }

  double through_thirds(int block, int pressed, Vec2 way, const Pressed& at) const {
    // two faces on each other are no tip, as where blocks have slid past a crossing by little
    if (has_side(polygon(block), way, at) && has_side(polygon(pressed), -way, at)) return 0;
    if (!is_held(pressed, block, way, at)) return 0;
    std::vector<Third> thirds;
    for (const Neighbour& n : neighbours_[block])
      if (n.block != pressed) thirds.push_back({&polygon(n.block), closure_near(n.pair, at.place, at.depth)});
    return through_covered(polygon(block), thirds, way, at);
  }

  // Whether some third block presses a block against `way` there: else it may go that way, as one that slides past a crossing.
  bool is_held(int block, int other, Vec2 way, const Pressed& at) const {
    for (const Neighbour& n : neighbours_[block]) {
      const Pair& pair = pairs_[n.pair];
      for (int k = pair.begin; n.block != other && k < pair.end; ++k) {
        const int i = order_[k];
        const Point& p = frame_.points[i];
        if (p.partner < 0 || p.normal_force <= 0) continue;
        const Vec2 normal = p.block_a == block ? seen_[i].normal : -seen_[i].normal;
        if (dot(normal, way) < -kOffSide &&
            distance_to_segment(at.place, seen_[i].place, seen_[p.partner].place) <=
                4 * at.depth + 2 * at.length)
          return true;
      }
    }
    return false;
  }

  // Whether a corner stands before a side and not over its end: further from the ends than anything beside it that
  // its block bears on the other way has closed, twice. What is level with the side under a closed joint presses back by
  // that closure, so a corner deeper than that came from the front.
  bool stands_before_step(const Point& p, const Seen& s) const {
    const Polygon& b = polygon(p.block_b);
    const size_t e = p.edge, next = (e + 1) % b.size();
    const double size = size_of(p.block_a, p.block_b);
    const Vec2 side = turn_left(s.normal);
    const double below =
        std::min(std::abs(dot(side, s.place - b[e])), std::abs(dot(side, s.place - b[next])));
    double floor = rules_.slop * size + rules_.tolerance;
    for (const Neighbour& n : neighbours_[p.block_a]) {
      const Pair& q = pairs_[n.pair];
      for (int k = q.begin; k < q.end; ++k) {
        const Seen& other = seen_[order_[k]];
        if (std::abs(dot(other.normal, s.normal)) > kOtherWay || norm(other.place - s.place) > kBeside * size)
          continue;
        floor = std::max(floor, other.depth);
      }
    }
    return below > 2 * (floor + kPlace * size);
  }

  // Blocks near two others that are one body with the first, bond by bond, itself included.
  std::vector<int> glued_to(int a, int b) const {
    std::vector<int> body{a};
    const auto is_near = [&](int i) {
      for (const int centre : {a, b})
        for (const Neighbour& n : neighbours_[centre])
          if (n.block == i) return i != b;
      return false;
    };
    for (size_t k = 0; k < body.size(); ++k) {
      for (const Neighbour& n : neighbours_[body[k]]) {
        const Pair& pair = pairs_[n.pair];
        if (pair.begin == pair.end || !frame_.points[order_[pair.begin]].bond()) continue;
        if (is_near(n.block) && std::find(body.begin(), body.end(), n.block) == body.end())
          body.push_back(n.block);
      }
    }
    return body;
  }

  // Check 4, along the joint: the resultant of a face, or of a corner alone.
  void check_shear(size_t i, FrameResult& out) const {
    const Point& p = frame_.points[i];
    if (p.partner >= 0 && std::cmp_less(p.partner, i)) return;
    const Law* law = law_of(p);
    if (p.joint == kUnknownJoint || (law && law->bonded)) return;
    const Law none;
    if (!law) law = &none;
    double normal = p.normal_force, shear = p.shear_force, area = 0;
    if (p.partner >= 0) {
      const Point& o = frame_.points[p.partner];
      if (o.joint != p.joint) return;
      area = norm(seen_[p.partner].place - seen_[i].place) * rules_.thickness;
      normal += o.normal_force, shear += o.shear_force;
    }
    const double slack = kLawSlack * (std::abs(normal) + law->cohesion * area) + kForceSeen * mean_force_;
    const double limit = law->cohesion * area + law->friction * std::max(0.0, normal);
    const double tension = law->tension * area;
    if (std::abs(shear) > limit + slack)
      out.findings.push_back(finding(
          Defect::kShearLaw, std::abs(shear) > limit + slack + kForceInvalid * mean_force_, p.block_a,
          p.block_b, seen_[i].place, std::abs(shear) / (limit + slack),
          fmt::format("a shear force of {:.4g} N where the joint holds {:.4g} N", std::abs(shear), limit)));
    if (-normal > tension + slack)
      out.findings.push_back(
          finding(Defect::kShearLaw, -normal > tension + slack + kForceInvalid * mean_force_, p.block_a,
                  p.block_b, seen_[i].place, -normal / (tension + slack),
                  fmt::format("a tension of {:.4g} N where the joint holds {:.4g} N", -normal, tension)));
  }

  // Check 4, across the joint: along an interface of an elastic joint the normal force is its stiffness times
  // the overlap. Asked only where one interface is all that the two share, where nothing else closes the
  // joint and where it hardly moves: the force of a step also damps.
  void check_normal(const Pair& pair, const Common& common, FrameResult& out) const {
    // in the first step what presses has not closed anything yet
    if (pair.begin == pair.end || frame_.time == 0) return;
    const double size = size_of(pair.a, pair.b);
    double normal = 0, blurred = 0;  // area that the overlap may be off by
    const Law* law = nullptr;
    Vec2 direction, place;
    for (int k = pair.begin; k < pair.end; ++k) {
      const int i = order_[k];
      const Point& p = frame_.points[i];
      const Seen& s = seen_[i];
      const Law* here = law_of(p);
      if (p.bond() || !here || here->normal_stiffness <= 0 || p.in_situ != 0 || p.rise != 0) return;
      // what the ground has closed lies in sides that did not face each other at the start, too, and no patch tells
      if (rules_.in_situ && p.patch()) return;
      if (law && law != here) return;
      law = here;
      if (s.depth > 0 && 3 * frame_.step * s.approach > 0.1 * s.depth) return;
      // one normal, whichever of the two has the corner
      const Vec2 n = p.block_a == pair.a ? s.normal : -s.normal;
      if (norm(direction) > 0 && (std::abs(cross(direction, n)) > kAlongside || dot(direction, n) < 0))
        return;
      direction = n;
      if (!p.patch() && !side_along(p, s)) return;
      if (p.normal_force >= normal) place = s.place;
      const double length = p.partner >= 0 ? 0.5 * norm(seen_[p.partner].place - s.place) : 0.02 * size;
      blurred += length * (kPlace * size + 3 * frame_.step * s.approach);
      normal += p.normal_force;
    }
    const double winkler = law->normal_stiffness * common.area * rules_.thickness;
    const double either = law->normal_stiffness * blurred * rules_.thickness;
    const double larger = std::max(normal, winkler) - either, smaller = std::min(normal, winkler) + either;
    if (larger <= kForceInvalid * mean_force_ || larger <= kNormalWarns * smaller) return;
    std::string what = fmt::format(
        "a normal force of {:.4g} N, where the stiffness of the joint times the overlap of the two is {:.4g} "
        "N",
        normal, winkler);
    if (frame_.step > 0)
      what += fmt::format(
          " (if the two have just hit each other, steps of {:.3g} s are too long for this stiffness: give "
          "the stage a smaller time_step)",
          frame_.step);
    out.findings.push_back(finding(Defect::kNormalLaw, larger > kNormalInvalid * smaller, pair.a, pair.b,
                                   place, larger / smaller, std::move(what)));
  }

  // Whether a side of the corner lies along the side that it is over.
  bool side_along(const Point& p, const Seen& s) const {
    const Polygon& a = polygon(p.block_a);
    const size_t v = p.corner;
    for (const size_t k : {v, (v + a.size() - 1) % a.size()}) {
      const Vec2 side = a[(k + 1) % a.size()] - a[k];
      const Vec2 n = turn_right(side) / norm(side);
      if (std::abs(cross(n, s.normal)) <= kAlongside && dot(n, s.normal) < 0) return true;
    }
    return false;
  }

  struct Neighbour {
    int block, pair;
  };

  const Rules& rules_;
  const Frame& frame_;
  std::vector<double> area_, size_;
  std::vector<Seen> seen_;
  double mean_force_ = 0;
  double softest_ = 0;      // least stiffness of a joint, 0: there is a hard one [Pa/m]
  std::vector<bool> tied_;  // blocks that an intact face ties to another
  std::vector<int> order_;  // points, pair by pair
  std::vector<Pair> pairs_;
  std::vector<bool> by_energy_;  // pairs whose force is compared with the energy of their overlap
  std::vector<std::vector<Neighbour>> neighbours_;
};

}  // namespace

FrameResult check_frame(const Rules& rules, const Frame& frame, const Workers& workers, int64_t turn) {
  return Check(rules, frame, turn).run(workers);
}

void add_frame(const Rules& rules, const Frame& frame, const Workers& workers, Report& report) {
  const FrameResult r = check_frame(rules, frame, workers, report.frames);
  report.add(r.findings);
  ++report.frames;
  if (r.unexplained_share > report.unexplained_share)
    report.unexplained_share = r.unexplained_share, report.unexplained_area = r.unexplained_area;
  report.closure_share = std::max(report.closure_share, r.closure_share);
  report.slack = std::max(report.slack, r.slack);
  report.patches_by_energy += r.patches_by_energy;
}

}  // namespace talus::audit
