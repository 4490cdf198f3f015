#pragma once
// A model and its transform, run and compared: what must not matter (the order of blocks, where and how the
// model lies, units, what is far away, how a block is divided) and by how much it does. Knows the rows of a
// step only as forces between two blocks; which sides touch follows from the direction of the force's normal.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "talus/base/index.h"
#include "talus/base/random.h"
#include "talus/cut/check_places.h"
#include "talus/cut/cut.h"
#include "talus/model/read_model.h"
#include "talus/talus.h"

namespace talus::test {

/// Where a transform puts things: x -> scale turn x + shift. Time stays; forces grow with scale^3.
struct Similarity {
  Mat2 turn = kIdentity;  // orthogonal; det -1: mirrored
  Vec2 shift;             // [m]
  double scale = 1;

  Vec2 place(Vec2 p) const { return scale * (turn * p) + shift; }
  Vec2 back(Vec2 p) const { return (1 / scale) * (transpose(turn) * (p - shift)); }
  Vec2 direction_back(Vec2 v) const { return transpose(turn) * v; }
  Mat2 back(const Mat2& m) const { return transpose(turn) * m * turn; }
};

inline Similarity turned_by(double degrees) {
  if (degrees == 90) return {{0, -1, 1, 0}, {}, 1};  // without round-off
  const double a = degrees * std::numbers::pi / 180;
  return {{std::cos(a), -std::sin(a), std::sin(a), std::cos(a)}, {}, 1};
}
inline Similarity mirrored() { return {{-1, 0, 0, 1}, {}, 1}; }
inline Similarity moved_by(Vec2 shift) { return {kIdentity, shift, 1}; }
inline Similarity scaled_by(double factor) { return {kIdentity, {}, factor}; }

/// A model, its blocks, and which block and side of the original each of them and of their edges belongs to.
struct Problem {
  Model model;
  Layout layout;
  Similarity placement;
  std::vector<int> body;               // [blocks] block of the original, -1: none
  std::vector<std::vector<int>> side;  // [blocks][edges] edge of it, -1: inside or none
  int bodies = 0;                      // blocks of the original
  double cell = 0;                     // of the grid on which it was cut [m]
};

// --- originals

inline void name_own_bodies(Problem& p) {
  p.bodies = count_of(p.layout.blocks);
  p.body.clear(), p.side.clear();
  for (int i = 0; i < p.bodies; ++i) {
    p.body.push_back(i);
    std::vector<int> side;
    for (int k = 0; k < count_of(p.layout.blocks[i].polygon); ++k) side.push_back(k);
    p.side.push_back(side);
  }
}

inline Layout cut_layout(const Model& model, double& cell) {
  Findings findings("invariance.toml", "");
  const Cut cut = cut_or_read(model, findings);
  cell = cut.grid;
  Layout layout = checked_layout(model, cut, findings);
  INFO(findings.render());
  REQUIRE_FALSE(findings.has_errors());
  return layout;
}

/// The tightest solution that the solvers are asked for: share of the smallest block.
inline constexpr double kTightest = 1e-13;

inline Problem problem_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Findings findings("invariance.toml", text);
  Problem p;
  p.model = read_model("invariance.toml", text, overrides, findings);
  INFO(findings.render());
  REQUIRE_FALSE(findings.has_errors());
  p.model.monitors.clear();
  p.model.solver.tolerance = p.model.solver.limit = kTightest;
  p.model.solver.stop_on_failure = false;  // what cannot be reached is printed
  p.model.solver.max_sweeps = 1500;
  p.layout = cut_layout(p.model, p.cell);
  name_own_bodies(p);
  return p;
}

// --- transforms

inline Vec2 normal_of(const Polygon& p, size_t k) {
  const Vec2 along = p[(k + 1) % p.size()] - p[k];
  return (1 / norm(along)) * turn_right(along);
}

/// Finds body and sides of blocks that were cut anew or divided: by place and by direction.
inline void name_bodies(const Problem& original, Problem& p) {
  p.bodies = original.bodies;
  p.body.clear(), p.side.clear();
  for (const BlockShape& b : p.layout.blocks) {
    Polygon at_home;
    Vec2 middle;
    for (const Vec2 v : b.polygon) at_home.push_back(p.placement.back(v)), middle += at_home.back();
    middle *= 1.0 / static_cast<double>(at_home.size());
    const double turning = det(p.placement.turn) > 0 ? 1 : -1;
    const std::vector<int> found = blocks_at(original.layout, middle, 0);
    const int body = found.empty() ? -1 : found.front();
    std::vector<int> sides(b.polygon.size(), -1);
    if (body >= 0) {
      const Polygon& own = original.layout.blocks[body].polygon;
      const Box box = bounding_box(own);
      const double near = 1e-4 * norm(box.max - box.min);
      for (size_t k = 0; k < sides.size(); ++k) {
        const Vec2 from = at_home[k], to = at_home[(k + 1) % at_home.size()];
        for (int s = 0; s < count_of(own); ++s)
          if (turning * dot(normal_of(own, s), normal_of(at_home, k)) > 0.999 &&
              distance_to_segment(0.5 * (from + to), own[s], own[(s + 1) % own.size()]) < near)
            sides[k] = s;
      }
    }
    p.body.push_back(body), p.side.push_back(sides);
  }
}

// A vector of two signals, of one history.
inline void place_pair(const Mat2& turn, double factor, Signal& x, Signal& y) {
  REQUIRE((!x.is_given() || !y.is_given() || x.history == y.history));
  const int history = x.is_given() ? x.history : y.history;
  const Vec2 v = factor * (turn * Vec2{x.factor, y.factor});
  x = {history, v.x}, y = {history, v.y};
}

inline void place_selection(const Similarity& to, Selection& s) {
  s.from = to.place(s.from), s.to = to.place(s.to);
}

/// All of the model but its blocks: gravity, loads, places, strengths and stiffnesses.
inline void place_model(const Similarity& to, Model& model) {
  const double stress = to.scale * to.scale;
  model.gravity = to.scale * (to.turn * model.gravity);
  for (Material& m : model.materials) m.young *= stress;
  for (JointProperty& j : model.joints) {
    j.cohesion *= stress, j.tensile_strength *= stress;
    j.residual_cohesion *= stress, j.residual_tensile_strength *= stress;
    j.normal_stiffness *= to.scale, j.shear_stiffness *= to.scale, j.dilation_slip *= to.scale;
  }
  for (SupportInput& s : model.supports) {
    REQUIRE((s.x.kind == Motion::kFixed && s.y.kind == Motion::kFixed));  // others have no turned form
    place_selection(to, s);
  }
  REQUIRE(model.boundaries.empty());
  REQUIRE(model.bolts.empty());
  for (LoadInput& l : model.loads) {
    place_selection(to, l);
    const double factor = l.kind == LoadKind::kAcceleration ? to.scale
                          : l.kind == LoadKind::kSurface    ? stress
                                                            : stress * to.scale;
    place_pair(to.turn, factor, l.x, l.y);
    l.pressure.factor *= stress;
  }
  REQUIRE_FALSE(model.in_situ.with_depth);
  model.in_situ.stress = stress * (to.turn * model.in_situ.stress * transpose(to.turn));
}

inline Polygon placed(const Similarity& to, const Polygon& polygon) {
  Polygon out;
  for (const Vec2 v : polygon) out.push_back(to.place(v));
  if (det(to.turn) < 0) std::reverse(out.begin(), out.end());
  return out;
}

/// The blocks as they were cut, put elsewhere.
inline Problem placed(const Similarity& to, const Problem& original) {
  Problem p = original;
  p.placement = to;
  place_model(to, p.model);
  p.layout.touching *= to.scale, p.cell *= to.scale;
  for (size_t i = 0; i < p.layout.blocks.size(); ++i) {
    BlockShape& b = p.layout.blocks[i];
    b.polygon = placed(to, b.polygon);
    b.velocity = to.scale * (to.turn * b.velocity);
    b.spin *= det(to.turn);
    if (det(to.turn) > 0) continue;
    const auto reverse_edges = [](std::vector<int>& edges) {  // the edge after the last corner stays the last
      if (!edges.empty()) std::reverse(edges.begin(), edges.end() - 1);
    };
    reverse_edges(b.edge_origin), reverse_edges(b.edge_joint), reverse_edges(p.side[i]);
  }
  return p;
}

/// The model put elsewhere before it is cut.
inline Problem cut_again(const Similarity& to, const Problem& original,
                         const std::function<void(Model&)>& change = nullptr) {
  REQUIRE((original.model.grids.empty() && original.model.meshes.empty() && original.model.masonry.empty() &&
           original.model.tessellations.empty() && original.model.traces.empty()));
  Problem p = original;
  p.placement = to;
  place_model(to, p.model);
  const double angle = std::atan2(to.turn.yx, to.turn.xx);
  for (BlockInput& b : p.model.blocks)
    b.polygon = placed(to, b.polygon), b.velocity = to.scale * (to.turn * b.velocity);
  for (RegionInput& r : p.model.regions) r.polygon = placed(to, r.polygon);
  for (OpeningInput& o : p.model.openings) o.polygon = placed(to, o.polygon);
  for (ArchInput& a : p.model.arches) a.center = to.place(a.center), a.from += angle, a.to += angle;
  for (JointSetInput& s : p.model.joint_sets) s.origin = to.place(s.origin), s.angle.mean += angle;
  for (FaultInput& f : p.model.faults)
    for (Vec2& v : f.points) v = to.place(v);
  if (change) change(p.model);
  p.layout = cut_layout(p.model, p.cell);
  name_bodies(original, p);
  return p;
}

/// The same blocks in another order: backwards, or at random (seed > 0).
inline Problem reordered(const Problem& original, uint64_t seed) {
  Problem p = original;
  const size_t n = p.layout.blocks.size();
  std::vector<size_t> order(n);
  for (size_t i = 0; i < n; ++i) order[i] = n - 1 - i;
  Random random(seed);
  for (size_t i = n - 1; seed > 0 && i > 0; --i)
    std::swap(order[i], order[static_cast<size_t>(random.uniform() * static_cast<double>(i + 1))]);
  for (size_t i = 0; i < n; ++i) {
    p.layout.blocks[i] = original.layout.blocks[order[i]];
    p.body[i] = original.body[order[i]], p.side[i] = original.side[order[i]];
  }
  return p;
}

/// A small rigid stone on a shelf, 40 model sizes away.
inline Problem with_pebble(const Problem& original) {
  Problem p = original;
  Box all = bounding_box(p.layout.blocks.front().polygon);
  double least = HUGE_VAL;
  for (const BlockShape& b : p.layout.blocks) {
    const Box box = bounding_box(b.polygon);
    all = {{std::min(all.min.x, box.min.x), std::min(all.min.y, box.min.y)},
           {std::max(all.max.x, box.max.x), std::max(all.max.y, box.max.y)}};
    least = std::min(least, std::sqrt(signed_area(b.polygon)));
  }
  const Vec2 at = all.max + 40 * (all.max - all.min);
  const auto add = [&](const std::string& name, Vec2 from, Vec2 to, BlockKind kind) {
    BlockShape b;
    b.name = name;
    b.id = count_of(p.layout.blocks);
    b.group = count_of(p.layout.groups);
    b.polygon = {from, {to.x, from.y}, to, {from.x, to.y}};
    b.kind = kind;
    p.layout.groups.push_back(name), p.layout.group_where.emplace_back();
    p.layout.blocks.push_back(b);
    p.body.push_back(-1), p.side.emplace_back(4, -1);
  };
  const double size = least / 50;
  add("shelf", at - Vec2{size, size}, at + Vec2{2 * size, 0}, BlockKind::kFixed);
  add("pebble", at, at + Vec2{size, size}, BlockKind::kRigid);
  return p;
}

/// Every deformable block in glued parts: k x k of those with four corners, or triangles about the middle
/// (k = 0, and of all others).
inline Problem divided(const Problem& original, int k) {
  Problem p = original;
  const int glue = count_of(p.model.joints);
  JointProperty bond;
  bond.name = "inside", bond.bonded = true;
  p.model.joints.push_back(bond);
  p.layout.glued.resize(p.model.joints.size(), false), p.layout.glued.back() = true;
  p.layout.blocks.clear();
  for (const BlockShape& whole : original.layout.blocks) {
    const Polygon& c = whole.polygon;
    if (whole.kind != BlockKind::kDeformable) {
      p.layout.blocks.push_back(whole);
      continue;
    }
    const auto joint = [&](size_t e) {
      return whole.edge_joint.empty() ? p.layout.default_joint : whole.edge_joint[e];
    };
    const auto origin = [&](size_t e) { return whole.edge_origin.empty() ? 0 : whole.edge_origin[e]; };
    const auto add = [&](const Polygon& polygon, const std::vector<int>& of_edge, int number) {
      BlockShape part = whole;
      part.name = whole.name + "/" + std::to_string(number);
      part.polygon = polygon;
      part.edge_joint.clear(), part.edge_origin.clear();
      for (const int e : of_edge) {
        part.edge_joint.push_back(e < 0 ? glue : joint(e));
        // an edge inside is along nothing that a support or a load can name
        part.edge_origin.push_back(e < 0 ? count_of(p.layout.origins) : origin(e));
      }
      p.layout.blocks.push_back(part);
    };
    int number = 0;
    if (k > 0 && c.size() == 4) {
      const auto at = [&](int i, int j) {
        const double s = static_cast<double>(i) / k, t = static_cast<double>(j) / k;
        return (1 - s) * ((1 - t) * c[0] + t * c[3]) + s * ((1 - t) * c[1] + t * c[2]);
      };
      for (int j = 0; j < k; ++j)
        for (int i = 0; i < k; ++i)
          add({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)},
              {j == 0 ? 0 : -1, i == k - 1 ? 1 : -1, j == k - 1 ? 2 : -1, i == 0 ? 3 : -1}, number++);
    } else {
      Vec2 middle;
      for (const Vec2 v : c) middle += (1.0 / static_cast<double>(c.size())) * v;
      for (int e = 0; e < count_of(c); ++e) add({c[e], c[(e + 1) % c.size()], middle}, {e, -1, -1}, number++);
    }
  }
  p.layout.origins.push_back("inside of a block");
  name_bodies(original, p);
  return p;
}

// --- runs

/// What is compared, at one instant, in the place and the units of the original.
struct Snapshot {
  double time = 0;
  std::vector<Vec2> displacement, velocity;  // [bodies] means by area
  std::vector<Mat2> stretch;  // [bodies] gradient of displacement x size of the block [m]; empty: divided
  std::map<std::array<int, 4>, Vec2> face;  // (body, side, body, side) -> force on the first [N]
  std::map<int, Vec2> held;                 // fixed bodies, -1: supports -> force on it [N]
  // the same two, as means over the steps since the snapshot before
  std::map<std::array<int, 4>, Vec2> pair_mean;  // sides -1
  std::map<int, Vec2> held_mean;
  double dissipated = 0, height = 0;  // [J], [m] of the centre of all that moves
  int touched = 0;                    // pairs of bodies that have pressed each other so far
};

struct Outcome {
  std::vector<Snapshot> at;
  double solver_error = 0;  // worst contact error over the size of the smallest block
  int64_t failed_steps = 0;
};

struct RunOptions {
  int threads = 1;
  int snapshots = 4;          // at equal shares of the steps, the last at the end
  std::vector<int> restarts;  // steps after which the run is stopped and goes on from the state kept then
};

class SnapshotObserver : public Observer {
 public:
  SnapshotObserver(const Problem& problem, const std::vector<StagePlan>& plans, const RunOptions& options)
      : problem_(problem), options_(options) {
    for (const StagePlan& p : plans) begin_.push_back(steps_), steps_ += p.steps;
  }

  void at(const Instant& i) override {
    note_touches(i);
    ++summed_;
    add_rows(i, sum_);
    const int64_t every = std::max<int64_t>(1, steps_ / options_.snapshots);
    // of whole steps: those that no solver solves to such a tolerance are taken in parts
    const int64_t step = begin_[i.stage] + i.steps_before;
    if (i.last || (step % every == 0 && step > 0)) snapshots.push_back(snapshot(i));
  }
  void keep_state(const Standing& standing, const State& state) override {
    if (stop_here) kept = std::make_unique<std::pair<Standing, State>>(standing, state);
  }

  std::vector<Snapshot> snapshots;
  bool stop_here = false;  // and keep the state
  std::unique_ptr<std::pair<Standing, State>> kept;

 private:
  static Vec2 force_of(const Instant& i, size_t row) {
    const PointRows& p = i.work.rows.points[row];
    const Impulse& q = i.work.rows.impulse[row];
    return (1 / i.work.clock.dt_kick) * (q[0] * p.normal + q[1] * turn_right(p.normal));
  }

  // The side of a block whose outward normal now is nearest to `direction`, within 0.1 rad.
  int side_facing(const Instant& i, int block, Vec2 direction) const {
    const BlockSet& blocks = i.scene.blocks;
    const int n = blocks.vertex_count(block);
    double best = std::cos(0.1);
    int side = -1;
    for (int e = 0; e < n; ++e) {
      const Vec2 from = offset_now(i.state, block, blocks.corner({block, e}));
      const Vec2 to = offset_now(i.state, block, blocks.corner({block, (e + 1) % n}));
      const double d = dot(turn_right(to - from), direction) / norm(to - from);
      if (d > best) best = d, side = problem_.side[block][e];
    }
    return side;
  }

  void note_touches(const Instant& i) {
    for (size_t r = 0; r < i.work.rows.points.size(); ++r) {
      const PointRows& p = i.work.rows.points[r];
      if (p.block_a < 0 || p.block_b < 0 || i.work.rows.impulse[r][0] <= 0) continue;
      const int a = problem_.body[p.block_a], b = problem_.body[p.block_b];
      if (a >= 0 && b >= 0 && a != b) touched_.insert(std::minmax(a, b));
    }
  }

  void add_rows(const Instant& i, Snapshot& s) const {
    for (size_t r = 0; r < i.work.rows.points.size(); ++r) add_row(i, r, s);
  }

  Snapshot snapshot(const Instant& i) {
    const int bodies = problem_.bodies;
    const Similarity& to = problem_.placement;
    const BlockSet& blocks = i.scene.blocks;
    const double length = 1 / to.scale, force = length * length * length;
    Snapshot s;
    s.time = i.state.time;
    s.displacement.resize(bodies), s.velocity.resize(bodies), s.stretch.resize(bodies);
    s.touched = count_of(touched_);
    std::vector<double> area(bodies);
    std::vector<int> parts(bodies);
    double mass = 0;
    for (int b = 0; b < blocks.count; ++b) {
      if (problem_.body[b] < 0) continue;
      const int body = problem_.body[b];
      s.displacement[body] += blocks.volume[b] * length * to.direction_back(i.state.displacement[b]);
      s.velocity[body] += blocks.volume[b] * length * to.direction_back(i.state.rate[b].a);
      s.stretch[body] = length * std::sqrt(blocks.volume[b]) * to.back(i.state.strain_part[b]);
      area[body] += blocks.volume[b], ++parts[body];
      if (!blocks.moves_freely(b)) continue;
      mass += blocks.mass[b];
      s.height += blocks.mass[b] * to.back(blocks.centroid[b] + i.state.displacement[b]).y;
    }
    s.height /= mass;
    for (int b = 0; b < bodies; ++b) {
      if (parts[b] == 0) continue;
      s.displacement[b] *= 1 / area[b], s.velocity[b] *= 1 / area[b];
    }
    if (std::any_of(parts.begin(), parts.end(), [](int n) { return n > 1; })) s.stretch.clear();
    const WorkDone& w = i.state.work;
    s.dissipated = -(w[Cause::kContactClosing] + w[Cause::kFriction] + w[Cause::kDamping]) * force * length;
    add_rows(i, s);
    for (const auto& [key, f] : sum_.face) s.pair_mean[{key[0], -1, key[2], -1}] += (1.0 / summed_) * f;
    for (const auto& [key, f] : sum_.held) s.held_mean[key] = (1.0 / summed_) * f;
    sum_ = {}, summed_ = 0;
    return s;
  }

  void add_row(const Instant& i, size_t r, Snapshot& s) const {
    const double scale = std::pow(problem_.placement.scale, -3);
    const PointRows& p = i.work.rows.points[r];
    const int a = p.block_a < 0 ? -1 : problem_.body[p.block_a];
    const int b = p.block_b < 0 ? -1 : problem_.body[p.block_b];
    if (p.block_a < 0 || (p.block_b >= 0 && a == b) || a < 0 || (p.block_b >= 0 && b < 0)) return;
    const Vec2 f = scale * problem_.placement.direction_back(force_of(i, r));
    if (p.block_b < 0) {
      s.held[-1] += -f;
      return;
    }
    for (const auto& [block, body, push] : {std::tuple{p.block_a, a, f}, std::tuple{p.block_b, b, -f}})
      if (!i.scene.blocks.moves_freely(block)) s.held[body] += push;
    const int side_a = side_facing(i, p.block_a, -p.normal), side_b = side_facing(i, p.block_b, p.normal);
    // a corner alone: what the two blocks do to each other
    const bool faces = side_a >= 0 && side_b >= 0;
    if (a < b)
      s.face[{a, faces ? side_a : -1, b, faces ? side_b : -1}] += f;
    else
      s.face[{b, faces ? side_b : -1, a, faces ? side_a : -1}] += -f;
  }

  const Problem& problem_;
  const RunOptions& options_;
  std::vector<int64_t> begin_;  // of stages, in steps
  int64_t steps_ = 0;
  std::set<std::pair<int, int>> touched_;
  Snapshot sum_;  // forces since the last snapshot
  int summed_ = 0;
};

struct Prepared {
  Scene scene;
  std::vector<StagePlan> plans;
};

inline Prepared prepared(const Problem& p) {
  Findings findings("invariance.toml", "");
  Prepared out;
  out.scene = build_scene(p.model, p.layout, findings);
  if (!findings.has_errors()) out.plans = plan_stages(out.scene, findings);
  INFO(findings.render());
  REQUIRE_FALSE(findings.has_errors());
  return out;
}

/// Runs a problem to its end.
inline Outcome outcome_of(const Problem& problem, const RunOptions& options = {}) {
  Prepared first = prepared(problem);
  State state = start_state(first.scene);
  SnapshotObserver observer(problem, first.plans, options);
  // stops where it is asked to, and goes on with nothing but what was kept
  struct Stopper : Observer {
    SnapshotObserver& inner;
    const RunOptions& options;
    size_t next = 0;
    int64_t seen = 0;
    Stopper(SnapshotObserver& o, const RunOptions& r) : inner(o), options(r) {}
    void at(const Instant& i) override {
      if (i.last && inner.stop_here) return;  // shown again when the run goes on
      seen = i.state.step + 1;
      inner.at(i);
    }
    bool stop() override {
      return inner.stop_here = next < options.restarts.size() && seen >= options.restarts[next];
    }
    void keep_state(const Standing& standing, const State& state_now) override {
      inner.keep_state(standing, state_now);
    }
  } stopper(observer, options);
  RunResult run = run_stages(first.scene, first.plans, state, stopper, Workers(options.threads));
  while (run.interrupted && run.failure.empty()) {
    REQUIRE(observer.kept);
    const auto kept = std::move(observer.kept);
    observer.stop_here = false;
    ++stopper.next;
    Prepared again = prepared(problem);
    run = continue_stages(again.scene, again.plans, kept->first, kept->second, stopper,
                          Workers(options.threads));
  }
  INFO(run.failure);
  CHECK(run.failure.empty());
  return {observer.snapshots, run.worst_error / smallest_size(first.scene.blocks), run.failed_steps};
}

// --- comparison

/// Largest differences, as shares of the largest values of the run.
struct Deviation {
  double displacement = 0, velocity = 0, face = 0, held = 0;
  double pair_mean = 0, held_mean = 0;

  /// Of what the places and forces of all instants say.
  double largest(bool with_faces) const {
    return std::max({displacement, velocity, with_faces ? face : 0.0, held});
  }
};

inline double compared(const std::vector<Outcome>& both,
                       const std::function<void(const Snapshot&, const Snapshot&, double&, double&)>& add) {
  double difference = 0, scale = 0;
  for (size_t k = 0; k < both[0].at.size(); ++k) add(both[0].at[k], both[1].at[k], difference, scale);
  return difference == 0 ? 0 : scale > 0 ? difference / scale : HUGE_VAL;
}

template <class Forces>
void add_forces(const Forces& a, const Forces& b, double& difference, double& scale) {
  const auto at = [](const Forces& f, const auto& key) {
    const auto it = f.find(key);
    return it == f.end() ? Vec2{} : it->second;
  };
  for (const Forces* of : {&a, &b})
    for (const auto& [key, force] : *of) {
      scale = std::max(scale, norm(force));
      difference = std::max(difference, norm(at(a, key) - at(b, key)));
    }
}

/// @param count  of snapshots compared, from the first on
inline Deviation deviation(const Outcome& original, const Outcome& other, size_t count = 1u << 30) {
  REQUIRE(original.at.size() == other.at.size());
  std::vector<Outcome> both{original, other};
  for (Outcome& o : both) o.at.resize(std::min(count, o.at.size()));
  const auto motion = [](std::vector<Vec2> Snapshot::*of) {
    return [of](const Snapshot& a, const Snapshot& b, double& difference, double& scale) {
      for (size_t i = 0; i < (a.*of).size(); ++i) {
        difference = std::max(difference, norm((a.*of)[i] - (b.*of)[i]));
        scale = std::max(scale, norm((a.*of)[i]));
      }
    };
  };
  Deviation d;
  d.displacement =
      compared(both, [&](const Snapshot& a, const Snapshot& b, double& difference, double& scale) {
        motion (&Snapshot::displacement)(a, b, difference, scale);
        if (a.stretch.size() != b.stretch.size()) return;
        for (size_t i = 0; i < a.stretch.size(); ++i) {
          const Mat2 e = a.stretch[i] - b.stretch[i];
          difference = std::max(difference, std::sqrt(contract(e, e)));
        }
      });
  d.velocity = compared(both, motion(&Snapshot::velocity));
  d.face = compared(both, [](const Snapshot& a, const Snapshot& b, double& difference, double& scale) {
    add_forces(a.face, b.face, difference, scale);
  });
  d.held = compared(both, [](const Snapshot& a, const Snapshot& b, double& difference, double& scale) {
    add_forces(a.held, b.held, difference, scale);
  });
  d.pair_mean = compared(both, [](const Snapshot& a, const Snapshot& b, double& difference, double& scale) {
    add_forces(a.pair_mean, b.pair_mean, difference, scale);
  });
  d.held_mean = compared(both, [](const Snapshot& a, const Snapshot& b, double& difference, double& scale) {
    add_forces(a.held_mean, b.held_mean, difference, scale);
  });
  return d;
}

}  // namespace talus::test
