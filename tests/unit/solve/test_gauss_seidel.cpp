// Projected Gauss-Seidel: kernels, colours, bounds, layout, second phase; against Newton and plain sweeps.

#include "talus/base/index.h"
#include "talus/solve/gauss_seidel.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "support/relative.h"
#include "talus/solve/contact_error.h"
#include "talus/solve/newton.h"

namespace test_gauss_seidel {

using namespace talus;

namespace {

struct Dice {
  std::mt19937 engine;
  explicit Dice(unsigned seed) : engine(seed) {}
  double number(double limit = 1) { return std::uniform_real_distribution<double>(-limit, limit)(engine); }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine); }
  Vec2 vector(double limit = 1) { return {number(limit), number(limit)}; }
  Vec2 direction() {
    const double angle = number(std::numbers::pi);
    return {std::cos(angle), std::sin(angle)};
  }
};

struct Brick {
  Vec2 size{1, 1};
  BlockKind kind = BlockKind::kDeformable;
};

// Blocks of 2000 kg/m3 and 1 GPa; where they lie does not matter to rows.
BlockSet make_blocks(const std::vector<Brick>& bricks) {
  Model model;
  model.materials.push_back({"m", 2000, 1e9, 0.2});
  Layout layout;
  for (const Brick& brick : bricks) {
    BlockShape b;
    b.name = "b" + std::to_string(layout.blocks.size());
    b.polygon = {{0, 0}, {brick.size.x, 0}, brick.size, {0, brick.size.y}};
    b.kind = brick.kind;
    layout.blocks.push_back(b);
  }
  layout.groups = {"blocks"};
  return build_blocks(model, layout);
}

// Oblong blocks of every kind: the first is driven, every fifth rigid.
BlockSet mixed_blocks(int count) {
  std::vector<Brick> bricks;
  for (int i = 0; i < count; ++i)
    bricks.push_back({{1 + 0.1 * (i % 4), 1 - 0.1 * (i % 3)},
                      i == 0       ? BlockKind::kDriven
                      : i == 1     ? BlockKind::kFixed
                      : i % 5 == 0 ? BlockKind::kRigid
                                   : BlockKind::kDeformable});
  return make_blocks(bricks);
}

// Every second deformable block implicit, each turned its own way.
std::vector<Mobility> mixed_mobilities(Dice& dice, const BlockSet& blocks) {
  std::vector<Mobility> all = mobilities(blocks, 0.9);
  for (size_t i = 0; i < all.size(); i += 2)
    all[i] = mobility_implicit(blocks, i, dice.direction(), 0.9, 1e-6);  // a millisecond
  return all;
}

std::vector<BlockRate> random_rates(Dice& dice, const BlockSet& blocks) {
  std::vector<BlockRate> rate(blocks.count);
  for (size_t i = 0; i < rate.size(); ++i) {
    if (blocks.kind[i] == BlockKind::kFixed) continue;
    const Mat2 g{dice.number(), dice.number(), dice.number(), dice.number()};
    rate[i] = {dice.vector(), blocks.kind[i] == BlockKind::kDeformable ? g : spin_matrix(dice.number())};
  }
  return rate;
}

enum Sort { kContact, kFace, kTie, kCohesive, kLimited, kSorts };

PointRows random_point(Dice& dice, const std::vector<Mobility>& mobility, Sort sort) {
  const auto n = count_of(mobility);
  PointRows p;
  const auto moves = [&](int i) { return i >= 0 && mobility[i].moves(); };
  do {
    p.block_a = dice.below(n);
    p.block_b = dice.below(5) == 0 ? -1 : dice.below(n);
  } while (p.block_a == p.block_b || (!moves(p.block_a) && !moves(p.block_b)));
  p.arm_a = dice.vector(0.5);
  if (p.block_b >= 0) p.arm_b = dice.vector(0.5);
  p.normal = dice.direction();
  // a gap or none, so that blocks at rest satisfy all rows
  if (sort == kContact || sort == kFace) p.row[0].bias = std::max(0.0, dice.number());
  if (sort != kTie && sort != kLimited)
    p.lower = sort == kCohesive ? -100 : 0, p.friction = 0.2, p.cohesion = sort == kCohesive ? 50 : 0;
  if (sort == kFace) p.row[0].compliance = 2e-4, p.row[1].compliance = 4e-4;
  if (sort == kLimited) p.lower = -200, p.upper = 150, p.cohesion = 110;
  return p;
}

// Rows of all sorts, in pairs of neighbours between the same blocks or alone.
RowSet random_rows(Dice& dice, const std::vector<Mobility>& mobility, int count, bool with_guess) {
  RowSet set;
  const auto add = [&](const PointRows& p) {
    set.add(p, with_guess ? Impulse{dice.number(300), dice.number(300)} : Impulse{});
  };
  while (count_of(set) < count) {
    const auto sort = static_cast<Sort>(dice.below(kSorts));
    PointRows p = random_point(dice, mobility, sort), q = p;
    q.arm_a = dice.vector(0.5);
    if (p.block_b >= 0) q.arm_b = dice.vector(0.5);
    if (sort == kFace) {
      const auto at = count_of(set);
      p.partner = at + 1, q.partner = at;
      add(p), add(q);
      continue;
    }
    add(p);
    if (dice.below(2) == 0) continue;
    if (dice.below(2) == 0)  // the same two blocks named the other way round
      std::swap(q.block_a, q.block_b), std::swap(q.arm_a, q.arm_b), q.normal = -q.normal;
    if (q.block_a >= 0) add(q);
  }
  set.finish();
  return set;
}

struct Solution {
  RowSet set;
  std::vector<BlockRate> rate;
  SolveReport report;
};

Solution solve(GaussSeidel& solver, const std::vector<Mobility>& mobility, const RowSet& set,
               const std::vector<BlockRate>& rate, int sweeps, double tolerance = 0,
               const Workers& workers = Workers(), const std::vector<int>& tile = {}) {
  Solution s{set, rate, {}};
  SolverInput options;
  options.max_sweeps = sweeps;
  Profile profile;
  s.report = solver.solve({mobility, rate, 1, {}, s.set, s.rate, profile, tile}, tolerance, options, workers);
  return s;
}

Solution solve(const std::vector<Mobility>& mobility, const RowSet& set, const std::vector<BlockRate>& rate,
               int sweeps, double tolerance = 0) {
  GaussSeidel solver;
  return solve(solver, mobility, set, rate, sweeps, tolerance);
}

bool same_bits(double x, double y) { return std::memcmp(&x, &y, sizeof x) == 0; }

// How many numbers of two solutions differ in some bit.
int differences(const Solution& x, const Solution& y) {
  int count = x.report.iterations != y.report.iterations;
  for (size_t i = 0; i < x.set.size(); ++i)
    for (size_t k = 0; k < 2; ++k) count += !same_bits(x.set.impulse[i][k], y.set.impulse[i][k]);
  for (size_t i = 0; i < x.rate.size(); ++i) {
    const BlockRate &u = x.rate[i], &v = y.rate[i];
    for (const auto& [p, q] :
         {std::pair(u.a.x, v.a.x), std::pair(u.a.y, v.a.y), std::pair(u.G.xx, v.G.xx),
          std::pair(u.G.xy, v.G.xy), std::pair(u.G.yx, v.G.yx), std::pair(u.G.yy, v.G.yy)})
      count += !same_bits(p, q);
  }
  return count;
}

// Rates with the impulses of the set.
std::vector<BlockRate> after(const std::vector<Mobility>& mobility, const RowSet& set,
                             std::vector<BlockRate> rate) {
  for (size_t r = 0; r < set.points.size(); ++r)
    for (const auto& [block, sign] :
         {std::pair(set.points[r].block_a, 1.0), std::pair(set.points[r].block_b, -1.0)}) {
      if (block < 0) continue;
      const BlockRate change = accelerate(mobility[block], impulse_on(set.points[r], set.impulse[r], sign));
      rate[block].a += change.a, rate[block].G += change.G;
    }
  return rate;
}

double difference(const std::vector<BlockRate>& u, const std::vector<BlockRate>& v) {
  double worst = 0;
  for (size_t i = 0; i < u.size(); ++i) {
    const Mat2 g = u[i].G - v[i].G;
    worst = std::max({worst, norm(u[i].a - v[i].a), std::sqrt(contract(g, g))});
  }
  return worst;
}

// Points whose impulses are outside their bounds by more than round-off: bounds are products and sums of two
// numbers.
int out_of_bounds(const RowSet& set) {
  int count = 0;
  for (size_t i = 0; i < set.size(); ++i)
    for (int k = 0; k < 2; ++k) {
      const Impulse& p = set.impulse[i];
      const Bounds b = bounds_of(set.points[i], k, p[0]);
      const double here = p[k], round = 1e-14 * (std::abs(p[0]) + 100);
      count += !(here >= b.lower - round && here <= b.upper + round);
    }
  return count;
}

// Sweeps of plain projected Gauss-Seidel, row by row in the order of the list, to the contact error.
int plain_sweeps(const std::vector<Mobility>& mobility, RowSet set, const std::vector<BlockRate>& start,
                 double tolerance, int most) {
  std::vector<BlockRate> rate = after(mobility, set, start);
  for (int sweep = 1; sweep <= most; ++sweep) {
    for (size_t i = 0; i < set.size(); ++i) {
      const PointRows& p = set.points[i];
      Mat2 w;
      if (p.block_a >= 0) w += influence(mobility[p.block_a], p.arm_a, p.arm_a);
      if (p.block_b >= 0) w += influence(mobility[p.block_b], p.arm_b, p.arm_b);
      for (int k = 0; k < 2; ++k) {
        const Vec2 along = k == 0 ? p.normal : turn_right(p.normal);
        double& impulse = set.impulse[i][k];
        const double e = relative_velocity(p, rate)[k] + p.row[k].bias + p.row[k].compliance * impulse;
        const Bounds b = bounds_of(p, k, set.impulse[i][0]);
        const double next =
            std::clamp(impulse - e / (dot(along, w * along) + p.row[k].compliance), b.lower, b.upper);
        Impulse change{};
        change[k] = next - impulse;
        impulse = next;
        for (const auto& [block, sign] : {std::pair(p.block_a, 1.0), std::pair(p.block_b, -1.0)}) {
          if (block < 0) continue;
          const BlockRate more = accelerate(mobility[block], impulse_on(p, change, sign));
          rate[block].a += more.a, rate[block].G += more.G;
        }
      }
    }
    if (contact_error(mobility, set, rate, 1).worst <= tolerance) return sweep;
  }
  return most;
}

PointRows contact(int a, int b, Vec2 arm_a, Vec2 arm_b, Vec2 normal) {
  PointRows p;
  p.block_a = a, p.block_b = b, p.arm_a = arm_a, p.arm_b = arm_b, p.normal = normal;
  p.lower = 0, p.friction = 0.6, p.cohesion = 0;
  return p;
}

struct Problem {
  std::vector<Mobility> mobility;
  RowSet set;
  std::vector<BlockRate> rate;
};

// A tower of rigid squares on a floor, hit by gravity; the uppermost has `ratio` times the height of the
// others.
Problem tower(int count, double ratio) {
  std::vector<Brick> bricks(count, Brick{{1, 1}, BlockKind::kRigid});
  bricks.back().size.y = ratio;
  const BlockSet blocks = make_blocks(bricks);
  Problem problem{mobilities(blocks, 1), {}, std::vector<BlockRate>(bricks.size(), {{0, -0.01}, {}})};
  for (int i = 0; i < count; ++i)
    for (const double x : {-0.5, 0.5}) {
      const double half = 0.5 * bricks[i].size.y;
      problem.set.add(contact(i, i - 1, {x, -half}, i > 0 ? Vec2{x, 0.5} : Vec2{}, {0, 1}), {});
    }
  return problem;
}

// Rigid squares in a ring, each tied to the next at four points of a side, the first tied to the ground.
Problem ring(Dice& dice, int count) {
  const BlockSet blocks = make_blocks(std::vector<Brick>(count, Brick{{1, 1}, BlockKind::kRigid}));
  Problem problem{mobilities(blocks, 1), {}, random_rates(dice, blocks)};
  for (int i = -1; i < count; ++i) {
    PointRows p;
    p.block_a = i < 0 ? 0 : i, p.block_b = i < 0 ? -1 : (i + 1) % count;
    p.normal = {std::cos(6 * i / double(count)), std::sin(6 * i / double(count))};
    for (const double along : {-0.5, -0.2, 0.2, 0.5}) {
      p.arm_a = 0.5 * p.normal + along * turn_right(p.normal);
      if (i >= 0) p.arm_b = -0.5 * p.normal + along * turn_right(p.normal);
      problem.set.add(p, {});
    }
  }
  return problem;
}

}  // namespace

TEST_CASE("plain and AVX2 kernels give the same bits") {
  if (!wide::has_avx2()) {
    MESSAGE("no AVX2 here: not compared");
    return;
  }
  Dice dice(1);
  const BlockSet blocks = mixed_blocks(30);
  for (int trial = 0; trial < 30; ++trial) {
    const auto mobility = mixed_mobilities(dice, blocks);
    const auto rate = random_rates(dice, blocks);
    const RowSet set = random_rows(dice, mobility, 40 + trial, trial % 2 == 0);
    for (const int sweeps : {1, 2, 20, 60}) {
      CAPTURE(trial);
      CAPTURE(sweeps);
      GaussSeidel plain(wide::plain_kernels()), avx2(wide::avx2_kernels()), best;
      const Solution x = solve(plain, mobility, set, rate, sweeps),
                     y = solve(avx2, mobility, set, rate, sweeps);
      CHECK(differences(x, y) == 0);
      CHECK(differences(x, solve(best, mobility, set, rate, sweeps)) == 0);
      CHECK(same_bits(x.report.judged->worst, y.report.judged->worst));
      CHECK(x.report.judged->point == y.report.judged->point);
      CHECK(contact_error(mobility, x.set, x.rate, 1).worst > 0);  // not all at rest
    }
  }
}

TEST_CASE("the error that sweeps tell is the one measured apart from them") {
  // the two work out velocities in other axes: some digits less than all
  constexpr double kTolerance = 1e-9;
  Dice dice(12);
  const BlockSet blocks = mixed_blocks(30);
  for (int trial = 0; trial < 60; ++trial) {
    CAPTURE(trial);
    const auto mobility = mixed_mobilities(dice, blocks);
    RowSet set = random_rows(dice, mobility, 40 + trial, trial % 2 == 0);
    const bool none = trial % 6 == 5;
    if (none) set.points[trial].row[trial % 4 == 1].bias = std::nan("");
    const Solution s = solve(mobility, set, random_rates(dice, blocks), 1 + trial % 7);
    const ContactError apart = contact_error(mobility, s.set, s.rate, 1);
    REQUIRE(s.report.judged);
    CHECK(s.report.judged->point == apart.point);
    CHECK(std::isnan(apart.worst) == none);
    CHECK(std::isnan(s.report.judged->worst) == none);
    if (!none) CHECK(s.report.judged->worst == test::relative(apart.worst, kTolerance));
  }
}

TEST_CASE(
    "random problems: the motion of Newton, errors below the tolerance, rates that belong to impulses") {
  // Speeds are of order 1. Errors of 1e-12 in the rows leave the velocities that far apart times the
  // condition of a few dozen rows, 1e4 and less; impulses may differ where rows are redundant.
  constexpr double kTolerance = 1e-12, kApart = 1e-8;
  Dice dice(2);
  const BlockSet blocks = mixed_blocks(16);
  int compared = 0, touching = 0;
  for (int trial = 0; trial < 40; ++trial) {
    CAPTURE(trial);
    const auto mobility = mixed_mobilities(dice, blocks);
    std::vector<BlockRate> rate = random_rates(dice, blocks);
    rate[0] = {};  // a driven block may ask for what no impulse gives
    const RowSet set = random_rows(dice, mobility, 14, false);
    const Solution s = solve(mobility, set, rate, 200000, kTolerance);
    CHECK(s.report.converged);
    if (s.report.converged) CHECK(contact_error(mobility, s.set, s.rate, 1).worst <= kTolerance);
    CHECK(out_of_bounds(s.set) == 0);
    // every sweep rounds rates once more, as large as what impulses make of them: p/m, and p/2 over m/12 of
    // gradients
    double largest = 0;
    for (const Impulse& p : s.set.impulse) largest = std::max({largest, std::abs(p[0]), std::abs(p[1])});
    const double made = 6 * largest / *std::min_element(blocks.mass.begin(), blocks.mass.end());
    CHECK(difference(s.rate, after(mobility, s.set, rate)) <=
          std::numeric_limits<double>::epsilon() * s.report.iterations * (1 + made));
    RowSet other = set;
    if (!solve_newton(mobility, rate, {}, 1e-13, other).converged) continue;
    ++compared;
    CHECK(difference(s.rate, after(mobility, other, rate)) <= kApart);
    for (const Impulse& p : s.set.impulse) touching += p[0] != 0;
  }
  CHECK(compared >= 35);  // Newton may cycle, and says so
  CHECK(touching > 5 * compared);
}

TEST_CASE("impulses are within their bounds after any number of sweeps") {
  Dice dice(3);
  const BlockSet blocks = mixed_blocks(20);
  for (int trial = 0; trial < 20; ++trial) {
    const auto mobility = mixed_mobilities(dice, blocks);
    const auto rate = random_rates(dice, blocks);
    // too many rows to be satisfied all, and a first guess that breaks the bounds
    const RowSet set = random_rows(dice, mobility, 60, true);
    CHECK(out_of_bounds(set) > 0);
    for (int sweeps = 1; sweeps <= 80; sweeps += sweeps < 4 || sweeps > 28 ? 1 : 6) {
      CAPTURE(trial);
      CAPTURE(sweeps);
      const Solution s = solve(mobility, set, rate, sweeps);
      CHECK(out_of_bounds(s.set) == 0);
      CHECK(s.report.iterations == sweeps);
      CHECK_FALSE(s.report.converged);
    }
  }
}

TEST_CASE("tile by tile: the same solution, the same bits for any number of threads") {
  Dice dice(12);
  constexpr int kBlocks = 120, kTiles = 7;
  const BlockSet blocks = mixed_blocks(kBlocks);
  const auto mobility = mixed_mobilities(dice, blocks);
  const auto rate = random_rates(dice, blocks);
  const RowSet set = random_rows(dice, mobility, 200, true);
  std::vector<int> tile;
  for (int i = 0; i < kBlocks; ++i) tile.push_back(dice.below(kTiles));
  const auto run = [&](int sweeps, double tolerance, int threads, const std::vector<int>& tiles) {
    GaussSeidel solver;
    return solve(solver, mobility, set, rate, sweeps, tolerance, Workers(threads), tiles);
  };
  for (const int sweeps : {3, 40})
    for (const int threads : {2, 3, 4})
      CHECK(differences(run(sweeps, 0, 1, tile), run(sweeps, 0, threads, tile)) == 0);
  // another order of the couples, another way there
  CHECK(differences(run(3, 0, 1, tile), run(3, 0, 1, {})) > 0);
  const Solution parted = run(20000, 1e-12, 1, tile), whole = run(20000, 1e-12, 1, {});
  REQUIRE(parted.report.converged);
  REQUIRE(whole.report.converged);
  CHECK(difference(parted.rate, whole.rate) <= 1e-9);

  // a layout goes with its tiles for as long as the blocks are the same
  GaussSeidel kept;
  const Solution first = solve(kept, mobility, set, rate, 3, 0, Workers(), tile);
  CHECK(differences(first, solve(kept, mobility, set, rate, 3, 0, Workers(), tile)) == 0);
}

TEST_CASE("a hundred blocks on one: more couples than colours") {
  constexpr int kSmall = 100;
  std::vector<Brick> bricks(kSmall + 1, Brick{{0.1, 0.1}});
  bricks[0].size = {20, 1};
  const BlockSet blocks = make_blocks(bricks);
  const auto mobility = mobilities(blocks, 1);
  std::vector<BlockRate> rate(bricks.size(), {{0, -0.01}, {}});
  RowSet set;
  for (const double x : {-10, 10}) set.add(contact(0, -1, {x, -0.5}, {}, {0, 1}), {});
  for (int i = 1; i <= kSmall; ++i) {
    const double x = 0.19 * (i - 50.5);
    rate[i].a.x = i % 3 == 0 ? 0.02 : 0;  // some slide
    for (const double end : {-0.05, 0.05}) set.add(contact(i, 0, {end, -0.05}, {x + end, 0.5}, {0, 1}), {});
  }
  GaussSeidel solver;
  const Solution s = solve(solver, mobility, set, rate, 20000, 1e-13);
  CHECK(s.report.converged);
  CHECK(s.report.colours < kSmall);
  RowSet other = set;
  REQUIRE(solve_newton(mobility, rate, {}, 1e-14, other).converged);
  // speeds of 0.02 to 1e-13, through a mass ratio of 2000
  CHECK(difference(s.rate, after(mobility, other, rate)) <= 1e-9);
  for (const int threads : {2, 3}) {
    GaussSeidel again;
    CHECK(differences(s, solve(again, mobility, set, rate, 20000, 1e-13, Workers(threads))) == 0);
  }
}

TEST_CASE("a point that is alone between its blocks is all that acts between them") {
  // apart by more than they move, in every direction and much faster than any bound inside a solver
  const BlockSet blocks = make_blocks(std::vector<Brick>(2));
  for (const double speed : {1.0, 3.0, 1000.0})
    for (int k = 0; k < 8; ++k) {
      const double angle = 0.25 * std::numbers::pi * k;
      const Vec2 along{std::cos(angle), std::sin(angle)};
      PointRows p = contact(1, 0, -0.5 * along, 0.5 * along, along);
      p.row[0].bias = 10 * speed;
      RowSet set;
      set.add(p, {});
      const std::vector<BlockRate> rate{{}, {-2 * speed * along, {}}};
      const Solution s = solve(mobilities(blocks, 1), set, rate, 50, 1e-12);
      CAPTURE(speed);
      CAPTURE(k);
      CHECK(s.set.impulse[0] == Impulse{0, 0});
      CHECK(difference(s.rate, rate) == 0);
    }
}

TEST_CASE("points that change get a new layout") {
  Dice dice(4);
  const BlockSet blocks = mixed_blocks(20);
  const auto mobility = mixed_mobilities(dice, blocks);
  const auto rate = random_rates(dice, blocks);
  const RowSet first = random_rows(dice, mobility, 40, true);
  const auto check = [&](const RowSet& second) {
    for (const int sweeps : {3, 40}) {
      GaussSeidel kept;
      solve(kept, mobility, first, rate, sweeps);
      CHECK(differences(solve(kept, mobility, second, rate, sweeps), solve(mobility, second, rate, sweeps)) ==
            0);
      // and back
      CHECK(differences(solve(kept, mobility, first, rate, sweeps), solve(mobility, first, rate, sweeps)) ==
            0);
    }
  };
  SUBCASE("nothing") { check(first); }
  SUBCASE("other points") { check(random_rows(dice, mobility, 40, true)); }
  SUBCASE("more and fewer points") {
    check(random_rows(dice, mobility, 70, true));
    check(random_rows(dice, mobility, 10, true));
  }
  SUBCASE("other numbers in the same points") {
    RowSet second = first;
    for (PointRows& p : second.points) p.normal = dice.direction(), p.row[0].bias = dice.number();
    for (Impulse& p : second.impulse) p = {};
    check(second);
  }
  SUBCASE("one point between other blocks") {
    for (size_t i = 0; i < first.size(); ++i) {
      if (first.points[i].partner >= 0) continue;
      RowSet second = first;
      PointRows& p = second.points[i];
      p.block_a = p.block_b == 3 ? 4 : 3;
      check(second);
    }
  }
  SUBCASE("contacts become ties, ties contacts") {
    for (size_t i = 0; i < first.size(); ++i) {
      if (first.points[i].partner >= 0) continue;
      RowSet second = first;
      PointRows& p = second.points[i];
      const bool tie = std::isinf(p.cohesion);
      p.row[0] = p.row[1] = {};
      p.lower = tie ? 0 : -std::numeric_limits<double>::infinity();
      p.cohesion = tie ? 0 : std::numeric_limits<double>::infinity();
      p.friction = tie ? 0.3 : 0;
      check(second);
    }
  }
  SUBCASE("faces fall apart into corners, and blocks change places") {
    RowSet second = first;
    for (PointRows& p : second.points) {
      p.partner = -1;
      if (p.block_b >= 0) std::swap(p.block_a, p.block_b);
    }
    check(second);
  }
}

TEST_CASE("one end of a face may have strength left when the other has none") {
  for (const int weak : {0, 1}) {
    CAPTURE(weak);
    Problem problem = tower(3, 1);
    for (size_t i = 0; i < problem.set.size(); ++i) {
      PointRows& p = problem.set.points[i];
      p.partner = static_cast<int>(i ^ 1U);
      p.row[0].compliance = 1e-4, p.row[1].compliance = 2e-4;
      if (static_cast<int>(i % 2) != weak) p.lower = -50, p.cohesion = 1000;
    }
    // pushed sideways and up: the weak ends slide or open, the others hold
    for (BlockRate& v : problem.rate) v.a = {0.3, 0.05};
    const Solution s = solve(problem.mobility, problem.set, problem.rate, 100000, 1e-12);
    CHECK(contact_error(problem.mobility, s.set, s.rate, 1).worst <= 1e-12);
  }
}

TEST_CASE("no rows: nothing to do") {
  const BlockSet blocks = mixed_blocks(4);
  Dice dice(5);
  const auto rate = random_rates(dice, blocks);
  const Solution s = solve(mobilities(blocks, 1), {}, rate, 10);
  CHECK(s.report.converged);
  CHECK(s.report.iterations == 0);
  CHECK(difference(s.rate, rate) == 0);
}

TEST_CASE("the second phase takes a small part of the sweeps of plain Gauss-Seidel") {
  constexpr int kMost = 3000;
  const auto check = [&](const Problem& problem, double tolerance) {
    const Solution s = solve(problem.mobility, problem.set, problem.rate, kMost, tolerance);
    CHECK(s.report.converged);
    CHECK(contact_error(problem.mobility, s.set, s.rate, 1).worst <= tolerance);
    CHECK(out_of_bounds(s.set) == 0);
    CHECK(s.report.second_phase > 0);
    CHECK(s.report.second_phase < s.report.iterations);
    const int plain = plain_sweeps(problem.mobility, problem.set, problem.rate, tolerance, kMost);
    CAPTURE(plain);
    // measured: 6 to 12 times fewer; the order in which rows are visited changes plain sweeps by less than
    // two times
    CHECK(3 * s.report.iterations < plain);
    // what it returns when it is stopped half way is within the bounds, too
    for (int sweeps = 31; sweeps < s.report.iterations; sweeps += 7)
      CHECK(out_of_bounds(solve(problem.mobility, problem.set, problem.rate, sweeps).set) == 0);
  };
  // tolerances: a thousandth of the speed of 0.01, and a ten millionth of speeds of order 1
  SUBCASE("tall tower") { check(tower(20, 1), 1e-5); }
  SUBCASE("tower with a weight on top") { check(tower(12, 100), 1e-5); }
  SUBCASE("redundant ring of ties") {
    Dice dice(6);
    check(ring(dice, 8), 1e-7);
  }
}

TEST_CASE("what sweeps say of their error is what is measured apart from them") {
  const Problem problem = tower(12, 5);
  int converged = 0;
  for (int sweeps = 1; sweeps <= 2000; sweeps += 1 + sweeps / 20) {
    const Solution s = solve(problem.mobility, problem.set, problem.rate, sweeps, 1e-5);
    REQUIRE(s.report.judged);
    const ContactError apart = contact_error(problem.mobility, s.set, s.rate, 1);
    CHECK(s.report.judged->worst == test::relative(apart.worst, 1e-9));
    CHECK(s.report.judged->point == apart.point);
    if (!s.report.converged) continue;
    ++converged;
    CHECK(s.report.judged->worst <= 1e-5);
  }
  CHECK(converged > 0);
}

TEST_CASE("a tower at rest carries its weight") {
  // plain arithmetic: each course carries the impulse of all above it
  constexpr int kCount = 10;
  constexpr double kTolerance = 1e-7;
  const Problem problem = tower(kCount, 5);
  const Solution s = solve(problem.mobility, problem.set, problem.rate, 20000, kTolerance);
  CHECK(s.report.converged);
  const double square = 0.01 * 2000;
  for (int i = 0; i < kCount; ++i) {
    const int k = 2 * i;
    const double sum = s.set.impulse[k][0] + s.set.impulse[k + 1][0];
    // errors of the speeds add up from course to course: ten times 1e-7 of 0.01
    CHECK(sum == test::approx(square * (kCount - 1 - i + 5)).epsilon(kCount * kTolerance / 0.01));
  }
}

}  // namespace test_gauss_seidel
