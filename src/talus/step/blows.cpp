#include "talus/step/blows.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "talus/base/index.h"

namespace talus {

namespace {

// What is slower than the fastest one by so much is no blow any more; how exactly their equations are solved, as share of that
// speed (at 1e-10 redundant places are below what solvers come to, all of them were asked in turn, and a dry-stone wall took nine
// times as long); waves of a step after which what still comes together does so without restitution.
constexpr double kLeastBlow = 1e-9, kExactBlow = 1e-8;
constexpr int kMostWaves = 1000;

// Sets of things that belong together, each known by its first one.
class Sets {
 public:
  explicit Sets(size_t n) : of_(n) { std::iota(of_.begin(), of_.end(), size_t{0}); }
  size_t find(size_t i) {
    while (of_[i] != i) i = of_[i] = of_[of_[i]];
    return i;
  }
  void join(size_t i, size_t j) {
    i = find(i), j = find(j);
    of_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<size_t> of_;
};

// Blocks that move as one.
struct Body {
  double mass = 0, inertia = 0;  // [kg], about its centroid [kg m2]
  bool moves = true;
  Vec2 centre;  // from the reference centroid of its first block [m]
};

// One end of a patch whose joint has a restitution.
struct Place {
  size_t row = 0;  // of the step
  PointRows rows;  // between bodies that move, by the number of their first blocks
  Vec2 given[2];   // velocities there of what does not move freely [m/s]
  double restitution = 0;
  bool held = false;    // a support, which keeps the velocity that it has
  double own = 0;       // part of its velocity along the normal that is not that of the bodies [m/s]
  double reach = 0;     // how far apart it were at the end of the step, but for the motion of the bodies [m]
  Impulse impulse{};    // of the waves so far [N s]
  double approach = 0;  // the fastest of them [m/s]

  // Velocity along an axis that the bodies have nothing to do with.
  double given_along(size_t axis) const {
    return dot(axis == 0 ? rows.normal : turn_right(rows.normal), given[0] - given[1]);
  }
};

double restitution_of(const Scene& scene, const Patch& patch) {
  return patch.joint < 0 ? -1 : scene.laws[patch.joint].restitution();
}

// How far an end of a patch is apart, but for an overlap that it may keep [m].
double gap_of(const State& state, size_t patch, size_t end) {
  return state.patches[patch].allowed[end] - state.patches[patch].closure[end];
}

// What weight gives in a step: what flies up by less is back within two [m/s].
double least_blow(const Scene& scene, const StepWork& work) {
  return norm(scene.model.gravity) * work.clock.dt;
}

class Waves {
 public:
  Waves(const Scene& scene, StepWork& work, const State& state)
      : scene_(scene), work_(work), state_(state), blocks_(scene.blocks) {}

  /// @param rate   of the blocks [count]
  /// @param drift  that of the step from now on, but for blows
  void begin(const std::vector<BlockRate>& rate, const std::vector<BlockRate>& drift) {
    find_bodies();
    place_bodies();
    rate_ = rates_of_bodies(rate), rate_old_ = rate_;
    make_places(rate, drift);
    make_held();
  }

  void go() {
    const double slow = least_blow(scene_, work_);
    for (int wave = 0; wave < kMostWaves; ++wave) {
      std::vector<Place*> meet = coming(slow);
      if (meet.empty()) return;
      add_held(meet);
      part(meet);
    }
  }

  std::vector<Meeting::Blow> blows() const {
    std::vector<Meeting::Blow> out;
    for (const Place& p : places_)
      if (p.impulse[0] != 0 || p.impulse[1] != 0) out.push_back({p.row, p.impulse, p.approach});
    return out;
  }

  // The jump of its body, to the rates of a block.
  void hand_on(size_t i, BlockRate& rate) const {
    const size_t b = root_[i];
    if (!mobility_[b].moves()) return;
    const Mat2 spin = rate_[b].G - rate_old_[b].G;
    rate.a += rate_[b].a - rate_old_[b].a + spin * (place_of(i) - body_[b].centre);
    rate.G += deforms(i) ? spin * shape_of(i) : spin;
  }

  // The work of half of what a place has got, as its blocks move so.
  void tally_half(const std::vector<Meeting::Blow>& blows, WorkDone& work) const {
    for (const Place& p : places_) {
      const auto blow = std::ranges::lower_bound(blows, p.row, {}, &Meeting::Blow::row);
      if (blow == blows.end() || blow->row != p.row) continue;
      const std::array<double, 2> u = speed(p);
      for (size_t k = 0; k < 2; ++k) {
        if (p.held) {
          work[Cause::kSupports] += 0.5 * blow->impulse[k] * u[k];
          continue;
        }
        work[k == 0 ? Cause::kContactClosing : Cause::kFriction] += 0.5 * blow->impulse[k] * u[k];
        // what does not move freely passes on the work of what drives it
        work[Cause::kSupports] -= 0.5 * blow->impulse[k] * p.given_along(k);
      }
    }
  }

  bool failed() const { return failed_; }

 private:
  // Where a block is, from the first one of its body: no digits are lost far from the origin.
  Vec2 place_of(size_t i) const {
    return (blocks_.centroid[i] - blocks_.centroid[root_[i]]) + state_.displacement[i];
  }
  Mat2 shape_of(size_t i) const { return kIdentity + state_.strain_part[i]; }
  bool deforms(size_t i) const { return blocks_.kind[i] == BlockKind::kDeformable; }
  // Moment of momentum of a block about its centroid [kg m2/s].
  double moment_of(size_t i, const Mat2& G) const {
    if (!deforms(i)) return blocks_.polar_inertia[i] * G.yx;
    const Mat2 m = shape_of(i) * blocks_.inertia[i] * transpose(G);
    return m.xy - m.yx;
  }
  double inertia_of(size_t i) const {
    if (!deforms(i)) return blocks_.polar_inertia[i];
    return trace(shape_of(i) * blocks_.inertia[i] * transpose(shape_of(i)));
  }

  void find_bodies() {
    const int n = blocks_.count;
    Sets sets(n);
    for (size_t f = 0; f < scene_.bonds.faces.size(); ++f) {
      const BondFace& face = scene_.bonds.faces[f];
      if (!state_.face[f].broken && !scene_.laws[face.joint].is_soft() && !blocks_.removed(face.block_a) &&
          !blocks_.removed(face.block_b))
        sets.join(face.block_a, face.block_b);
    }
    root_.resize(n), body_.assign(n, {});
    for (int i = 0; i < n; ++i) root_[i] = sets.find(i);
    for (int i = 0; i < n; ++i)
      if (!blocks_.moves_freely(i)) body_[root_[i]].moves = false;
  }

  void place_bodies() {
    const size_t n = body_.size();
    for (size_t i = 0; i < n; ++i) {
      body_[root_[i]].mass += blocks_.mass[i];
      body_[root_[i]].centre += blocks_.mass[i] * place_of(i);
    }
    for (Body& b : body_)
      if (b.mass > 0) b.centre = b.centre / b.mass;
    for (size_t i = 0; i < n; ++i) {
      Body& b = body_[root_[i]];
      const Vec2 r = place_of(i) - b.centre;
      b.inertia += inertia_of(i) + blocks_.mass[i] * dot(r, r);
    }
    mobility_.assign(n, {});
    for (size_t i = 0; i < n; ++i) {
      const Body& b = body_[i];
      if (!b.moves || b.mass == 0) continue;
      const double turns = 1 / b.inertia;
      mobility_[i].mass = 1 / b.mass;
      mobility_[i].shear[0] = mobility_[i].shear[2] = turns, mobility_[i].shear[1] = -turns;
    }
  }

  // Their motion is that rigid one which has the momentum of their blocks.
  std::vector<BlockRate> rates_of_bodies(const std::vector<BlockRate>& rate) {
    const size_t n = body_.size();
    std::vector<BlockRate> out(n);
    std::vector<double> moment(n, 0);
    for (size_t i = 0; i < n; ++i) {
      const size_t b = root_[i];
      if (!mobility_[b].moves()) continue;
      out[b].a += (blocks_.mass[i] / body_[b].mass) * rate[i].a;
      moment[b] +=
          moment_of(i, rate[i].G) + blocks_.mass[i] * cross(place_of(i) - body_[b].centre, rate[i].a);
    }
    for (size_t i = 0; i < n; ++i) {
      if (!mobility_[i].moves()) continue;
      out[i].G = spin_matrix(moment[i] / body_[i].inertia);
      // what is slower by far than anything that moves is round-off
      fastest_ = std::max(fastest_, norm(out[i].a) + std::abs(out[i].G.yx) * blocks_.radius[i]);
    }
    return out;
  }

  void make_places(const std::vector<BlockRate>& rate, const std::vector<BlockRate>& drift) {
    const size_t first = work_.rows.range(Family::kContact).begin;
    for (size_t i = 0; i < state_.patches.size(); ++i) {
      if (restitution_of(scene_, state_.patches[i]) < 0) continue;
      for (size_t end = 0; end < 2; ++end) {
        Place p;
        p.row = first + 2 * i + end, p.restitution = restitution_of(scene_, state_.patches[i]);
        const PointRows& rows = work_.rows.points[p.row];
        p.rows.normal = rows.normal, p.rows.friction = rows.friction;
        p.rows.lower = p.rows.cohesion = 0;
        std::tie(p.rows.block_a, p.rows.arm_a, p.given[0]) = on_body(rows.block_a, rows.arm_a, rate);
        std::tie(p.rows.block_b, p.rows.arm_b, p.given[1]) = on_body(rows.block_b, rows.arm_b, rate);
        if (p.rows.block_a == p.rows.block_b) continue;
        // what acts, and the motion that is not that of the bodies
        p.own = relative_velocity(rows, rate)[0] - speed(p)[0];
        p.reach = gap_of(state_, i, end) + work_.clock.dt * (relative_velocity(rows, drift)[0] - speed(p)[0]);
        places_.push_back(p);
      }
    }
  }

  void make_held() {
    const RowRange range = work_.rows.range(Family::kSupport);
    for (size_t r = range.begin; r < range.end; ++r) {
      Place p;
      p.row = r, p.held = true, p.rows = work_.rows.points[r];
      const int block = std::max(p.rows.block_a, p.rows.block_b);
      if (block < 0 || !body_[root_[block]].moves) continue;
      for (auto [of, arm] :
           {std::pair(&p.rows.block_a, &p.rows.arm_a), std::pair(&p.rows.block_b, &p.rows.arm_b)})
        if (*of >= 0) std::tie(*of, *arm, std::ignore) = on_body(*of, *arm, rate_);
      for (Row& row : p.rows.row) row = {};
      places_.push_back(p);
    }
  }

  // A point of a block as one of its body, if that moves; else -1 and the velocity there.
  std::tuple<int, Vec2, Vec2> on_body(int block, Vec2 arm, const std::vector<BlockRate>& rate) const {
    if (!body_[root_[block]].moves) return {-1, Vec2{}, velocity_at(rate[block], arm)};
    const Vec2 now = deforms(block) ? shape_of(block) * arm : arm;
    return {static_cast<int>(root_[block]), place_of(block) - body_[root_[block]].centre + now, Vec2{}};
  }

  std::array<double, 2> speed(const Place& p) const {
    const std::array<double, 2> u = relative_velocity(p.rows, rate_);
    return {u[0] + p.given_along(0), u[1] + p.given_along(1)};
  }

  // The places of the next wave.
  std::vector<Place*> coming(double slow) {
    std::vector<Place*> out;
    double fastest = fastest_;
    for (Place& p : places_) {
      const double u = speed(p)[0];
      if (p.held || !(std::max(u, u + p.own) < -slow) || !(-u > kLeastBlow * fastest_) ||
          p.reach + work_.clock.dt * u > 0)
        continue;
      out.push_back(&p), fastest = std::max(fastest, -u);
    }
    fastest_ = fastest;
    return out;
  }

  // What holds the bodies of a wave.
  void add_held(std::vector<Place*>& meet) {
    std::vector<char> met(body_.size(), 0);
    for (const Place* p : meet)
      for (const int body : {p->rows.block_a, p->rows.block_b})
        if (body >= 0) met[body] = 1;
    for (Place& p : places_)
      if (p.held && met[std::max(p.rows.block_a, p.rows.block_b)]) meet.push_back(&p);
  }

  // Eq. 4.7a, with a share of the restitution.
  std::vector<Impulse> solve(const std::vector<Place*>& meet, double share) {
    RowSet set;
    for (const Place* p : meet) {
      PointRows rows = p->rows;
      const std::array<double, 2> u = speed(*p);
      rows.row[0].bias = p->held ? -u[0] : p->given_along(0) + share * p->restitution * u[0];
      rows.row[1].bias = p->held ? -u[1] : p->given_along(1);
      set.add(rows, {0, 0}, {Family::kContact, static_cast<int>(p->row)});
    }
    std::vector<BlockRate> rate = rate_;
    std::vector<Impulse> guess;
    SolverSet solvers;
    const double exact = kExactBlow * fastest_ * work_.clock.dt;
    const StepProblem problem{mobility_, rate_, work_.clock.dt, {}, set, rate, work_.profile};
    const Solved solved =
        solve_step(scene_.model, {}, exact, exact, 1, false, work_.workers, solvers, problem, guess);
    failed_ = failed_ || solved.failed;
    return set.impulse;
  }

  // Which of them hang together, by bodies that move.
  std::vector<size_t> islands(const std::vector<Place*>& meet) const {
    Sets sets(body_.size());
    std::vector<size_t> out;
    for (const Place* p : meet)
      if (p->rows.block_a >= 0 && p->rows.block_b >= 0) sets.join(p->rows.block_a, p->rows.block_b);
    for (const Place* p : meet)
      out.push_back(sets.find(static_cast<size_t>(std::max(p->rows.block_a, p->rows.block_b))));
    return out;
  }

  // Friction at places that rebound may give energy by the law of Newton. Of an island where it does, the impulses are as far
  // between those and the ones without rebound, which never give any, as it takes.
  void hold_back(const std::vector<Place*>& meet, std::vector<Impulse>& impulse) {
    const std::vector<size_t> island = islands(meet);
    const auto work_of = [&](const std::vector<Impulse>& p, const std::vector<BlockRate>& rate) {
      std::vector<double> work(body_.size(), 0);
      for (size_t i = 0; i < meet.size(); ++i) {
        if (meet[i]->held) continue;  // what drives it may give
        const auto before = speed(*meet[i]), after = relative_velocity(meet[i]->rows, rate);
        for (size_t k = 0; k < 2; ++k)
          work[island[i]] += 0.5 * p[i][k] * (before[k] + after[k] + meet[i]->given_along(k));
      }
      return work;
    };
    const std::vector<double> gives = work_of(impulse, rates_with(meet, impulse));
    if (std::ranges::none_of(gives, [](double w) { return w > 0; })) return;
    const std::vector<Impulse> least = solve(meet, 0);
    const std::vector<double> takes = work_of(least, rates_with(meet, least));
    std::vector<Impulse> middle = impulse;
    for (size_t i = 0; i < meet.size(); ++i)
      for (size_t k = 0; k < 2; ++k) middle[i][k] = 0.5 * (impulse[i][k] + least[i][k]);
    const std::vector<double> between = work_of(middle, rates_with(meet, middle));
    for (size_t i = 0; i < meet.size(); ++i) {
      const size_t s = island[i];
      if (!(gives[s] > 0)) continue;
      // of the parabola through the three works its root
      const double a = 2 * (gives[s] + takes[s] - 2 * between[s]), b = gives[s] - takes[s] - a;
      const double share = root_between(a, b, std::min(takes[s], 0.0));
      for (size_t k = 0; k < 2; ++k) impulse[i][k] = least[i][k] + share * (impulse[i][k] - least[i][k]);
    }
  }
  // Of a x^2 + b x + c, c <= 0 < a + b + c, in [0, 1].
  static double root_between(double a, double b, double c) {
    double low = 0, high = 1;
    for (int n = 0; n < 60; ++n) {
      const double x = 0.5 * (low + high);
      ((a * x + b) * x + c > 0 ? high : low) = x;
    }
    return low;
  }

  std::vector<BlockRate> rates_with(const std::vector<Place*>& meet,
                                    const std::vector<Impulse>& impulse) const {
    RowSet set;
    for (size_t i = 0; i < meet.size(); ++i) set.add(meet[i]->rows, impulse[i]);
    std::vector<BlockRate> rate = rate_;
    apply_impulses(mobility_, set, rate);
    return rate;
  }

  void part(const std::vector<Place*>& meet) {
    std::vector<Impulse> impulse = solve(meet, 1);
    hold_back(meet, impulse);
    for (size_t i = 0; i < meet.size(); ++i) {
      Place& p = *meet[i];
      if (!p.held) p.approach = std::max(p.approach, -speed(p)[0]);
      for (size_t k = 0; k < 2; ++k) p.impulse[k] += impulse[i][k];
    }
    rate_ = rates_with(meet, impulse);
  }

  const Scene& scene_;
  StepWork& work_;
  const State& state_;
  const BlockSet& blocks_;
  std::vector<size_t> root_;  // [count] first block of the body of a block
  // [count], of bodies, by their first blocks
  std::vector<Body> body_;
  std::vector<Mobility> mobility_;
  std::vector<BlockRate> rate_, rate_old_;
  std::vector<Place> places_;
  double fastest_ = 0;  // of what has met so far [m/s]
  bool failed_ = false;
};

}  // namespace

std::vector<size_t> closing_rows(const Scene& scene, const StepWork& work, const State& state) {
  const BlockSet& blocks = scene.blocks;
  const size_t first = work.rows.range(Family::kContact).begin;
  const double slow = least_blow(scene, work);
  std::vector<size_t> closing;
  if (!meets_hard(scene.layout, scene.laws)) return closing;
  for (size_t i = 0; i < state.patches.size(); ++i) {
    const Patch& c = state.patches[i];
    for (size_t end = 0; end < 2; ++end) {
      const PointRows& p = work.rows.points[first + 2 * i + end];
      if (p.is_soft(0)) continue;
      const double gap = gap_of(state, i, end);
      const bool apart = gap > noticeable(blocks, c.block_a, c.block_b);
      if (!apart && (!(restitution_of(scene, c) >= 0) || c.force[end][0] != 0)) continue;
      if (relative_velocity(p, work.rate_before)[0] < -slow &&
          gap + work.clock.dt * relative_velocity(p, work.rate_free)[0] <= 0)
        closing.push_back(first + 2 * i + end);
    }
  }
  if (closing.empty()) return closing;
  // what its neighbours press a block with, over its mass [m/s2]
  std::vector<double> pressed(blocks.mass.size(), 0);
  for (const Patch& c : state.patches)
    for (const int block : {c.block_a, c.block_b})
      if (blocks.moves_freely(block)) {
        pressed[block] += (std::abs(c.force[0][0]) + std::abs(c.force[1][0])) / blocks.mass[block];
      }
  std::erase_if(closing, [&](size_t r) {
    if (restitution_of(scene, state.patches[(r - first) / 2]) >= 0) return false;
    const PointRows& p = work.rows.points[r];
    const double back = std::max(pressed[p.block_a], pressed[p.block_b]);
    return !(relative_velocity(p, work.rate_before)[0] < -back * work.clock.dt);
  });
  return closing;
}

bool rings(const Scene& scene, const StepWork& work, const State& state, const std::vector<size_t>& closing) {
  std::vector<char> tied(scene.blocks.count, 0);
  for (size_t f = 0; f < scene.bonds.faces.size(); ++f) {
    const BondFace& face = scene.bonds.faces[f];
    if (state.face[f].broken || scene.blocks.removed(face.block_a) || scene.blocks.removed(face.block_b))
      continue;
    tied[face.block_a] = tied[face.block_b] = 1;
  }
  const size_t first = work.rows.range(Family::kContact).begin;
  return std::ranges::any_of(closing, [&](size_t r) {
    const Patch& c = state.patches[(r - first) / 2];
    const auto alone = [&](int i) { return scene.blocks.kind[i] == BlockKind::kDeformable && tied[i] == 0; };
    return restitution_of(scene, c) < 0 && (alone(c.block_a) || alone(c.block_b));
  });
}

void find_blows(const Scene& scene, StepWork& work, State& state) {
  if (std::ranges::none_of(scene.laws, [](const JointLaw& law) { return law.restitution() >= 0; })) return;
  // bodies meet with the velocities of this instant: with those before the kick weight would take of each rebound, with
  // those after it it would give
  std::vector<BlockRate> now(state.rate.size());
  for (size_t i = 0; i < now.size(); ++i) now[i] = mean(work.rate_before[i], state.rate[i]);
  Waves waves(scene, work, state);
  waves.begin(now, state.rate);
  waves.go();
  work.meeting.blows = waves.blows(), work.meeting.failed = waves.failed();
  for (size_t i = 0; i < state.rate.size(); ++i) waves.hand_on(i, state.rate[i]);
}

RowSums tally_blows(const Scene& scene, StepWork& work, const State& state) {
  RowSums out;
  if (work.meeting.blows.empty()) return out;
  const auto tally = [&](const std::vector<BlockRate>& rate, WorkDone& half) {
    Waves waves(scene, work, state);
    waves.begin(rate, rate);
    waves.tally_half(work.meeting.blows, half);
  };
  tally(work.rate_before, out.work.before), tally(state.rate, out.work.after);
  return out;
}

}  // namespace talus
