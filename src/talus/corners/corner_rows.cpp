#include "talus/corners/corner_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/error.h"
#include "talus/blocks/in_situ.h"
#include "talus/contact/joint_state.h"

namespace talus {

namespace {

// Tributary length of a hard contact with shear stiffness that is no end of a face, as share of the smaller
// block.
constexpr double kCornerLength = 0.02;

// Least closed part, as share of an interface or of the smaller block: a row with no stiffness at all has no
// meaning.
constexpr double kLeastShare = 1e-9;

// Overlaps below this share of the thinner block are not measured against it.
constexpr double kNoticed = 0.01;

// Pairs to a chunk.
constexpr size_t kRowGrain = 256;

// What an overlap that a point was born with loses in a step: a thousandth of it, at most this share of the
// smaller block. Pushed out at once it would leave with the speed of overlap over time step.
constexpr double kPushedOut = 1e-3, kMostPushedOut = 1e-7;

// What is left of it and forgotten, as share of the smaller block.
constexpr double kLeastAllowed = 1e-12;

// Bias of a hard normal row: it may close the gap and not more; an overlap is pushed back except for the
// slop (theory 4, table of rows).
double hard_bias(double gap, double slop, double dt) {
  if (gap >= 0) return gap / dt;
  return std::min(gap + 0.5 * slop, 0.0) / dt;
}

// What of a distance lies beyond half the slop. Contacts that stick redundantly, as two corners at one place
// do, have anchors that differ by what was left of the errors of earlier steps; no motion brings both home,
// and forces would grow without end over it (theory 4.10).
double beyond(double off, double slop) {
  if (std::abs(off) <= 0.5 * slop) return 0;
  return off > 0 ? off - 0.5 * slop : off + 0.5 * slop;
}

// How far a contact is from where it sticks, before the kick [m] (theory 4.19).
double off_anchor(const Contact& c, double slip) {
  // NaN: the contact slid in the last step; it sticks anew where it is, its elastic slip apart
  const bool anew = c.memory == Contact::kPassed || std::isnan(c.anchor);
  if (c.memory == Contact::kNone) return 0;
  return anew ? c.stretch : slip - c.anchor;
}

// A contact point of a pair on its way to a row.
struct Point {
  CornerEdge over;
  Vec2 corner;                // reference arm
  Vec2 b0, edge;              // of the edge, reference
  double slip = 0;            // coordinate along the tangent
  Vec2 closure;               // by the stress of the ground
  double gap = 0;             // less the rise [m]
  std::array<double, 2> u{};  // velocity half a step ago, normal and tangential

  Vec2 foot() const { return b0 + std::clamp(over.along, 0.0, 1.0) * edge; }
};

// The part of an interface that is closed, or is going to be in this step: from one end on, as share of its
// length. 1: all of it, or nothing yet (theory 13.6).
double closed_share(double gap, double other, double gap_then, double other_then) {
  if (gap >= 0 && other >= 0) gap = gap_then, other = other_then;
  if ((gap < 0) == (other < 0)) return 1;
  const double least = std::min(gap, other), most = std::max(gap, other);
  return std::max(-least / (most - least), kLeastShare);
}

// The closed part of a corner that has gone into an edge: Winkler's foundation under its two sides
// (theory 13.6).
struct Toe {
  double length = 0;   // closed, along the edge [m]
  double closure = 0;  // mean of it [m]
  double shift = 0;    // of the resultant from the corner, along the edge [m]
};

class ContactRows {
 public:
  ContactRows(const BlockSet& blocks, const Model& model, const std::vector<JointLaw>& laws,
              const ContactGive& give, const State& state, const std::vector<BlockRate>& before,
              const StepClock& clock, size_t first, RowSet& rows, std::vector<ContactPlace>& place)
      : blocks_(blocks),
        model_(model),
        laws_(laws),
        state_(state),
        before_(before),
        clock_(clock),
        give_(give.per_force(blocks.thickness) / (clock.dt * clock.dt_kick)),
        least_give_(give.shortest_step > 0
                        ? give.shortest_step * give.shortest_step / (clock.dt * clock.dt_kick) / kLeastYield
                        : clock.dt / clock.dt_kick / kLeastYield),
        first_(first),
        rows_(rows),
        place_(place) {
    if (blocks.count > 0) thinnest_ = *std::min_element(blocks.thinness.begin(), blocks.thinness.end());
  }

  void add(const ContactPair& pair, std::vector<Point>& points) const {
    const auto at = static_cast<size_t>(pair.begin), count = static_cast<size_t>(pair.count);
    points.resize(count);
    for (size_t k = 0; k < count; ++k) look(pair, at + k, points[k]);
    for (size_t k = 0; k < count; ++k) write(pair, at, k, points);
    for (size_t k = 0; k < count; ++k) {
      const PointRows& p = rows_.points[first_ + at + k];
      const size_t other = p.partner < 0 ? k : static_cast<size_t>(p.partner) - first_ - at;
      if (other < k) continue;
      const size_t i = first_ + at + k, j = first_ + at + other;
      guess_compliant({&p, &rows_.points[j]}, {points[k].u, points[other].u},
                      {&rows_.impulse[i], &rows_.impulse[j]});
    }
  }

 private:
  const JointLaw& law_of(const Contact& c) const {
    return c.joint < 0 ? none_ : laws_[static_cast<size_t>(c.joint)];
  }
  double size_of(const ContactPair& pair) const {
    return std::min(blocks_.size[static_cast<size_t>(pair.a)], blocks_.size[static_cast<size_t>(pair.b)]);
  }
  // The other end of a compliant face of one joint; -1: none.
  int partner_of(const ContactPair& pair, size_t at, size_t k) const {
    const Contact& c = state_.contacts[at + k];
    if (c.partner < 0) return -1;
    // two ends with different joints close on their own
    return state_.contacts[static_cast<size_t>(pair.begin + c.partner)].joint == c.joint ? c.partner : -1;
  }

  void look(const ContactPair& pair, size_t i, Point& p) const {
    const Contact& c = state_.contacts[i];
    const auto b = static_cast<size_t>(c.key.block_b);
    const JointLaw& law = law_of(c);
    p.over = corner_over_edge(blocks_, state_, c.key.corner(), c.key.on());
    p.corner = blocks_.corner(c.key.corner()), p.b0 = blocks_.corner({c.key.block_b, c.key.edge});
    p.edge = blocks_.corner(blocks_.end_of(c.key.on())) - p.b0;
    // the row in its place, and its normal while that is at hand: copies would wait for what was just written
    PointRows& row = rows_.points[first_ + i];
    row = kFreshRows;
    row.normal.x = p.over.normal.x, row.normal.y = p.over.normal.y;
    p.u = {};
    p.slip = -p.over.along * norm(p.edge);
    p.closure = {};
    const bool carries = pair.shares_face || (pair.from_start && c.length > 0);
    if (carries && model_.in_situ.given && c.joint >= 0) {
      const double height = blocks_.centroid[b].y + p.b0.y + std::clamp(p.over.along, 0.0, 1.0) * p.edge.y;
      p.closure = law.closure(in_situ_stress(model_.in_situ, model_.gravity, height),
                              turn_right(p.edge) / norm(p.edge));
    }
    p.gap = p.over.gap - law.rise(c.slip);
  }

  void write(const ContactPair& pair, size_t at, size_t k, std::vector<Point>& points) const {
    const size_t i = at + k;
    Point& q = points[k];
    const Contact& c = state_.contacts[i];
    const auto a = static_cast<size_t>(c.key.block_a), b = static_cast<size_t>(c.key.block_b);
    const JointLaw& law = law_of(c);
    // only what was never disturbed sticks with the stress of the ground
    const double elastic = state_.step == 0 ? q.closure.y : 0;
    place_[i] = {q.over.gap, c.memory == Contact::kNone ? q.slip - elastic : q.slip, size_of(pair),
                 closed_part(pair, q)};

    PointRows& p = rows_.points[first_ + i];
    p.block_a = c.key.block_a, p.block_b = c.key.block_b;
    p.arm_a = acting_arm(blocks_, state_, a, q.corner);
    p.arm_b = acting_arm(blocks_, state_, b, q.foot());
    const JointStrength bears = law.between(c.key.block_a, c.key.block_b, law.worn(c.slip));
    p.friction = bears.friction;
    p.lower = 0, p.cohesion = 0;
    const bool soft = law.is_soft(0), springs = law.is_soft();
    const double size = size_of(pair), slop = model_.contact.slop * size;
    const bool gives = give_ > 0 && !(soft && law.is_soft(1));
    const double gap = soft ? q.gap + q.closure.x : q.gap + c.allowed;
    p.row[0].bias = soft || gives ? gap / clock_.dt : hard_bias(gap, slop, clock_.dt);
    // what a broken face keeps, end by end, while it is in touch
    if (pair.face >= 0 && q.gap <= noticeable(blocks_, a, b))
      bound(bears.over(c.length * blocks_.thickness * clock_.dt_kick), p);

    Impulse guess{};
    if (c.memory == Contact::kNone) {
      p.row[1].bias = elastic / clock_.dt;
    } else {
      guess = {c.force[0] * clock_.dt_kick, c.force[1] * clock_.dt_kick};
      p.row[1].bias = stuck_bias(off_anchor(c, q.slip), law.is_soft(1) || gives, size);
    }
    bool rebounds = false;
    if (law.restitution() >= 0 || springs) {
      q.u = relative_velocity(p, before_);
      rebounds = law.restitution() >= 0 && q.gap + clock_.dt * q.u[0] <= 0 && q.u[0] < 0;
      if (rebounds) p.row[0].bias = std::min(p.row[0].bias, law.restitution() * q.u[0]);
    }
    if (gives) {
      p.gives = {!soft && !rebounds, !law.is_soft(1)};
      for (size_t row = 0; row < 2; ++row)
        if (p.gives[row]) p.row[row].compliance = std::min(give_, least_give_ * yield(pair));
    }
    if (springs) {
      const int partner = partner_of(pair, at, k);
      double length = c.length;
      if (partner >= 0) {
        p.partner = static_cast<int>(first_) + pair.begin + partner;
        if (soft && p.lower == 0)
          length *= close_face(q, points[static_cast<size_t>(partner)], c,
                               state_.contacts[at + static_cast<size_t>(partner)], size, p);
      } else if (soft && p.lower == 0 && c.partner < 0) {
        length = close_corner(q, c, size, p);
      } else if (c.length == 0) {
        length = kCornerLength * size;
      }
      add_compliance(law, length * blocks_.thickness, partner >= 0, clock_, q.u, p);
    }
    rows_.impulse[first_ + i] = guess;
    rows_.owner[first_ + i] = {Family::kContact, static_cast<int>(i)};
  }

  // About what two blocks yield at a corner, together [1/kg].
  double yield(const ContactPair& pair) const {
    double sum = 0;
    for (const int block : {pair.a, pair.b})
      if (blocks_.moves_freely(block)) sum += kYield / blocks_.mass[static_cast<size_t>(block)];
    return sum;
  }

  // Bias of the shear row of a place that is `off` from where it sticks [m/s].
  double stuck_bias(double off, bool gives, double size) const {
    return (gives ? off : beyond(off, model_.contact.slop * size)) / clock_.dt;
  }

  double closed_part(const ContactPair& pair, const Point& q) const {
    double share = 0;
    if (-q.gap <= kNoticed * thinnest_) return share;
    for (const int block : {pair.a, pair.b}) {
      const auto k = static_cast<size_t>(block);
      // below this nobody asks: the thinnest there can be
      if (-q.gap > kNoticed * blocks_.thinness[k])
        share = std::max(share, -q.gap / thickness_along(block, q.over.normal));
    }
    return share;
  }

  // Mean thickness of a block: its area over its extent across `normal` [m].
  double thickness_along(int block, Vec2 normal) const {
    const auto k = static_cast<size_t>(block);
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (int v = 0; v < blocks_.vertex_count(block); ++v) {
      const Vec2 X = blocks_.corner({block, v});
      const double at = cross(normal, X + state_.strain_part[k] * X);
      least = std::min(least, at), most = std::max(most, at);
    }
    return blocks_.size[k] * blocks_.size[k] / (most - least);
  }

  // Where only one end of an interface is closed the other end of its row couple is the end of the closed
  // part: W = kn t/2 times the integral of closure^2 has the slope and the tangent of that part. Returns its
  // share (eq. 4.1a).
  double close_face(Point& q, const Point& other, const Contact& c, const Contact& far, double size,
                    PointRows& p) const {
    const double gap = q.gap + q.closure.x, away = other.gap + other.closure.x;
    const PointRows there = arms_of(other, far);
    const double share = closed_share(gap, away, gap + clock_.dt * q.u[0],
                                      away + clock_.dt * relative_velocity(there, before_)[0]);
    if (share == 1) return 1;
    const bool open = (gap >= 0 && away >= 0) ? gap + clock_.dt * q.u[0] >= 0 : gap >= 0;
    if (!open) return share;
    // this end goes to the end of the closed part
    const bool same = far.key.block_a == c.key.block_a;
    const Vec2 far_a = same ? there.arm_a : there.arm_b, far_b = same ? there.arm_b : there.arm_a;
    p.arm_a = far_a + share * (p.arm_a - far_a);
    p.arm_b = far_b + share * (p.arm_b - far_b);
    const double here = away + share * (gap - away);
    p.row[0].bias = here / clock_.dt;
    if (c.memory != Contact::kNone && far.memory != Contact::kNone) {
      // how far that place has slipped, not the corner that stands open
      const double corner = off_anchor(c, q.slip), closed = off_anchor(far, other.slip);
      p.row[1].bias =
          stuck_bias(closed + share * (corner - closed), law_of(c).is_soft(1) || p.gives[1], size);
    }
    q.u = relative_velocity(p, before_);
    return share;
  }

  PointRows arms_of(const Point& q, const Contact& c) const {
    PointRows p;
    p.block_a = c.key.block_a, p.block_b = c.key.block_b;
    p.arm_a = acting_arm(blocks_, state_, static_cast<size_t>(p.block_a), q.corner);
    p.arm_b = acting_arm(blocks_, state_, static_cast<size_t>(p.block_b), q.foot());
    p.normal = q.over.normal;
    return p;
  }

  // A corner alone: the part of its two sides that has gone into the edge (theory 13.6).
  double close_corner(Point& q, const Contact& c, double size, PointRows& p) const {
    const double gap = q.gap + q.closure.x, then = gap + clock_.dt * q.u[0];
    const Toe toe = toe_of(q, c, -(gap < 0 ? gap : then));
    if (gap < 0 && toe.length > 0) {
      p.row[0].bias = -toe.closure / clock_.dt;
      shift_arms(q, c, toe.shift, p);
      q.u = relative_velocity(p, before_);
    }
    return std::max(toe.length, kLeastShare * size);
  }

  Toe toe_of(const Point& q, const Contact& c, double depth) const {
    Toe toe;
    if (depth <= 0) return toe;
    const int n = blocks_.vertex_count(c.key.block_a), v = c.key.vertex;
    const auto a = static_cast<size_t>(c.key.block_a);
    const Vec2 X = blocks_.corner({c.key.block_a, v}), along = turn_left(q.over.normal);
    const double on_edge = q.over.along * q.over.length;  // the edge runs along turn_left(normal)
    double force = 0, moment = 0;
    int bit = 1;
    for (const int neighbour : {v + 1 == n ? 0 : v + 1, v == 0 ? n - 1 : v - 1}) {
      const bool bears = c.toes & bit;
      bit = 2;
      if (!bears) continue;
      const Vec2 E = blocks_.corner({c.key.block_a, neighbour}) - X, side = E + state_.strain_part[a] * E;
      const double up = dot(side, q.over.normal), run = dot(side, along);
      const double room = std::min(std::abs(run), run > 0 ? q.over.length - on_edge : on_edge);
      if (room <= 0) continue;
      const double wedge = up > 0 ? depth * std::abs(run) / up : room, length = std::min(wedge, room);
      // closure falls from depth to depth (1 - length/wedge) over the length
      const double left = up > 0 ? 1 - length / wedge : 1, mean = 0.5 * (1 + left) * depth;
      const double centre = length * (1 + 2 * left) / (3 * (1 + left));
      toe.length += length, force += mean * length;
      moment += (run > 0 ? 1 : -1) * mean * length * centre;
    }
    if (toe.length > 0) toe.closure = force / toe.length, toe.shift = moment / force;
    return toe;
  }

  void shift_arms(const Point& q, const Contact& c, double shift, PointRows& p) const {
    const Vec2 by = shift * turn_left(q.over.normal);
    const auto move = [&](int block, Vec2& arm) {
      const auto k = static_cast<size_t>(block);
      arm += blocks_.kind[k] == BlockKind::kDeformable ? inverse(kIdentity + state_.strain_part[k]) * by : by;
    };
    move(c.key.block_a, p.arm_a), move(c.key.block_b, p.arm_b);
  }

  const BlockSet& blocks_;
  const Model& model_;
  const std::vector<JointLaw>& laws_;
  const State& state_;
  const std::vector<BlockRate>& before_;
  const StepClock& clock_;
  const double give_;        // compliance of hard contacts [1/kg]
  const double least_give_;  // which need not be larger than this share of what their blocks yield
  const size_t first_;
  RowSet& rows_;
  std::vector<ContactPlace>& place_;
  const JointLaw none_;  // of contacts without a joint
  double thinnest_ = 0;  // least thinness of a block [m]
};

}  // namespace

void add_contact_rows(const BlockSet& blocks, const Model& model, const std::vector<JointLaw>& laws,
                      const ContactGive& give, const State& state, const std::vector<BlockRate>& before,
                      const StepClock& clock, const Workers& workers, RowSet& rows,
                      std::vector<ContactPlace>& place) {
  TALUS_ASSERT(before.size() == static_cast<size_t>(blocks.count) && laws.size() == model.joints.size());
  const size_t first = rows.add_more(Family::kContact, state.contacts.size());
  resize_sparingly(place, state.contacts.size());
  const ContactRows contact_rows(blocks, model, laws, give, state, before, clock, first, rows, place);
  workers.for_chunks(state.pairs.size(), kRowGrain, [&](size_t begin, size_t end) {
    std::vector<Point> points;
    for (size_t q = begin; q < end; ++q) contact_rows.add(state.pairs[q], points);
  });
}

// Eq. 4.7.
void remember_contacts(const RowSet& rows, RowRange range, const std::vector<ContactPlace>& place,
                       const StepClock& clock, State& state) {
  const RowRange all = rows.range(Family::kContact);
  TALUS_ASSERT(all.size() == state.contacts.size() && place.size() == state.contacts.size());
  TALUS_ASSERT(range.begin >= all.begin && range.end <= all.end);
  const double per_kick = 1 / clock.dt_kick;
  for (size_t r = range.begin; r < range.end; ++r) {
    const PointRows& p = rows.points[r];
    const Impulse& impulse = rows.impulse[r];
    const ContactPlace& at = place[r - all.begin];
    Contact& c = state.contacts[r - all.begin];
    const double elastic = p.row[1].compliance > 0 ? elastic_slip(rows, r, clock) : 0;
    const bool anchored = c.memory == Contact::kWhole && !std::isnan(c.anchor);
    const bool held = impulse[0] > 0 || bounds_of(p, 1, impulse[0]).upper > 0, slid = slides(p, impulse);
    c.touched = c.touched || held;
    if (held && slid) {
      // the place where it would stick goes along with the slip that is not elastic
      const double gone = off_anchor(c, at.slip) + clock.dt * relative_velocity(p, state.rate)[1] - elastic;
      c.slip += std::abs(gone), c.slip_signed += gone;
    }
    if (slid)
      c.anchor = std::nan("");
    else if (!anchored)
      c.anchor = at.slip - (c.memory == Contact::kNone ? 0 : c.stretch);
    c.force = {impulse[0] * per_kick, impulse[1] * per_kick};
    if (c.allowed > 0) {
      c.allowed = std::min(c.allowed, -at.gap);
      c.allowed -= std::min(kPushedOut * c.allowed, kMostPushedOut * at.size);
      if (!(c.allowed > kLeastAllowed * at.size)) c.allowed = 0;
    }
    c.stretch = elastic;
    c.memory = Contact::kWhole;
  }
}

}  // namespace talus
