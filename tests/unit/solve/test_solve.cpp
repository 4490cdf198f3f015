// The contact residual, its Jacobian, Newton, islands, and the separate error measure.

#include <doctest/doctest.h>

#include <random>

#include "support/random_rows.h"
#include "support/relative.h"
#include "talus/base/index.h"
#include "talus/solve/contact_error.h"
#include "talus/solve/contact_problem.h"
#include "talus/solve/newton.h"

namespace test_solve {

using namespace talus;
using namespace talus::test;

namespace {

// Random rows of every kind: hard contacts with friction, ties, cohesive faces, compliant rows, supports.
RowSet random_rows(std::mt19937& random, int blocks, int count) {
  std::uniform_real_distribution<double> unit(-1, 1);
  RowSet set;
  for (int i = 0; i < count; ++i) {
    PointRows p = random_point(random, blocks);
    switch (i % 4) {
      case 0:
        p.lower = 0, p.friction = 0.6, p.cohesion = 0;
        break;
      case 1:
        break;
      case 2:
        p.lower = -100, p.friction = 0.3, p.cohesion = 50;
        break;
      default:
        p.lower = 0, p.friction = 0.5, p.cohesion = 0;
        p.row[0].compliance = 1e-4, p.row[1].compliance = 2e-4;
    }
    set.add(p, {500 * unit(random), 500 * unit(random)});
  }
  return set;
}

std::vector<BlockRate> after(const BlockSet& blocks, const RowSet& set, std::vector<BlockRate> rate) {
  apply_impulses(mobilities(blocks, 1), set, rate);
  return rate;
}

}  // namespace

TEST_CASE("the analytic Jacobian equals difference quotients at random states") {
  // between kinks the law is linear: the quotient is exact but for round-off, 1e-16 / 1e-7 of the entries
  std::mt19937 random(1);
  const BlockSet blocks = make_squares(8);
  for (int trial = 0; trial < 40; ++trial) {
    const RowSet set = random_rows(random, blocks.count, 24);
    std::vector<int> points(set.points.size());
    for (int i = 0; i < count_of(points); ++i) points[i] = i;
    const ContactProblem problem =
        build_problem(mobilities(blocks, 0.9), set, points, random_rates(random, blocks));
    Eigen::VectorXd p(problem.size());
    for (size_t i = 0; i < points.size(); ++i)
      for (size_t k = 0; k < 2; ++k) p[static_cast<Eigen::Index>(2 * i + k)] = set.impulse[i][k];
    const Eigen::MatrixXd analytic = jacobian(problem, row_states(problem, p));
    const Eigen::MatrixXd quotient = jacobian_by_differences(problem, p, 1e-4);
    CHECK((analytic - quotient).cwiseAbs().maxCoeff() < 1e-6 * analytic.cwiseAbs().maxCoeff());
    int held = 0, sliding = 0;
    for (const RowState& s : row_states(problem, p)) held += !s.free, sliding += s.slope != 0;
    CHECK(held > 0);  // the states do visit every branch of the law
    CHECK(sliding > 0);
    CHECK(held < problem.size());
  }
}

TEST_CASE("the normal law as printed is eq. 26 of metres and newtons") {
  std::mt19937 random(7);
  const BlockSet blocks = make_squares(3);
  RowSet set;
  PointRows row;
  row.block_a = 1, row.block_b = 0;
  row.normal = {0, 1}, row.lower = 0, row.friction = 0.6, row.cohesion = 0;
  set.add(row, {0, 0});
  constexpr double kDt = 2e-3, kKick = 1e-3, kEpsilon = 0.3;
  for (int trial = 0; trial < 20; ++trial) {
    std::uniform_real_distribution<double> unit(-1, 1);
    ContactProblem problem = build_problem(mobilities(blocks, 0.9), set, {0}, random_rates(random, blocks));
    problem.smoothing = {true, true, kEpsilon, 6e-8 / kDt, kDt, kKick};
    Eigen::VectorXd p(2);
    p << unit(random) * kKick, 0;
    const double gap = kDt * (problem.influence * p + problem.velocity_free)[0], force = p[0] / kKick;
    const double printed = -kEpsilon * std::log(std::exp(-gap / kEpsilon) + std::exp(-force / kEpsilon));
    CHECK(residual(problem, p)[0] * kDt == approx(printed).epsilon(1e-12));
  }
}

TEST_CASE("Newton solves random problems to round-off by the separate measure") {
  std::mt19937 random(2);
  const BlockSet blocks = make_squares(9);
  int solved = 0;
  for (int trial = 0; trial < 60; ++trial) {
    RowSet set = random_rows(random, blocks.count, 8);
    // bilateral rows between random points can contradict each other; contacts cannot
    for (PointRows& p : set.points)
      if (std::isinf(p.cohesion)) p.lower = 0, p.friction = 0.2, p.cohesion = 0;
    for (Impulse& i : set.impulse) i = {};
    const std::vector<BlockRate> rate = random_rates(random, blocks);
    const SolveReport report = solve_newton(mobilities(blocks, 1), rate, {}, 1e-12, set);
    if (!report.converged) continue;
    ++solved;
    // velocities of order 1 m/s over 1 s: round-off of a few hundred operations
    CHECK(contact_error(mobilities(blocks, 1), set, after(blocks, set, rate), 1).worst < 1e-11);
  }
  CHECK(solved >= 55);  // a semismooth Newton may cycle; the caller is told, never left with a wrong answer
}

TEST_CASE("Newton handles redundant ties: the same edge tied at four points") {
  const BlockSet blocks = make_squares(2);
  RowSet set;
  for (const double y : {-0.5, -0.2, 0.2, 0.5}) {
    PointRows p;
    p.block_a = 1, p.block_b = 0;
    p.arm_a = {-0.5, y}, p.arm_b = {0.5, y};
    p.normal = {1, 0};
    set.add(p, {0, 0});
  }
  std::vector<BlockRate> rate(2);
  rate[1] = {{1, -2}, {0.3, 0.1, -0.4, 0.2}};
  const SolveReport report = solve_newton(mobilities(blocks, 1), rate, {}, 1e-12, set);
  CHECK(report.converged);
  CHECK(report.iterations <= 3);
  const auto now = after(blocks, set, rate);
  CHECK(contact_error(mobilities(blocks, 1), set, now, 1).worst < 1e-12);
  // the tied edge stands still
  for (const PointRows& p : set.points) CHECK(norm(velocity_at(now[1], p.arm_a)) < 1e-12);
}

TEST_CASE("one point on the floor: presses, slips and sticks as Coulomb says") {
  const BlockSet blocks = make_squares(4);  // block 3 is rigid
  PointRows p;
  p.block_a = 3;
  p.arm_a = {0, -0.5};
  p.normal = {0, 1};
  p.lower = 0, p.cohesion = 0;
  p.friction = 0.5;
  const auto solve = [&](Vec2 velocity) {
    RowSet set;
    set.add(p, {0, 0});
    std::vector<BlockRate> rate(4);
    rate[3].a = velocity;
    CHECK(solve_newton(mobilities(blocks, 1), rate, {}, 1e-13, set).converged);
    return set.impulse[0];
  };
  const double m = blocks.mass[3], I = blocks.polar_inertia[3];
  CHECK(solve({0, 1})[0] == 0);                          // leaving: no force
  CHECK(solve({0, -1})[0] == approx(m).epsilon(1e-12));  // the centroid is above: p = m v
  const Impulse slide = solve({10, -1});                 // tangent = normal clockwise = +x
  CHECK(slide[1] == approx(-0.5 * slide[0]).epsilon(1e-12));
  const Impulse stick = solve({0.1, -1});  // 1/w_t = 1/(1/m + r^2/I)
  CHECK(stick[1] == approx(-0.1 / (1 / m + 0.25 / I)).epsilon(1e-12));
}

TEST_CASE("islands: points are joined through freely moving blocks only") {
  const BlockSet blocks = make_squares(6);
  RowSet set;
  const auto add = [&set](int a, int b) {
    PointRows p;
    p.block_a = a, p.block_b = b, p.normal = {1, 0};
    set.add(p, {});
  };
  add(1, 0);  // both on the fixed block 0: not joined by it
  add(2, 0);
  add(3, 2);
  add(4, -1);
  add(5, 4);
  const auto islands = find_islands(mobilities(blocks, 1), set);
  REQUIRE(islands.size() == 3);
  CHECK(islands[0] == std::vector<int>{0});
  CHECK(islands[1] == std::vector<int>{1, 2});
  CHECK(islands[2] == std::vector<int>{3, 4});
}

TEST_CASE("contact error: zero at a solution, the gap violated in metres otherwise, NaN told") {
  const BlockSet blocks = make_squares(2);
  PointRows p;
  p.block_a = 1, p.block_b = 0;
  p.arm_a = {-0.5, 0}, p.arm_b = {0.5, 0};
  p.normal = {1, 0};
  p.lower = 0, p.cohesion = 0;
  RowSet set;
  set.add(p, {0, 0});
  std::vector<BlockRate> rate(2);
  rate[1].a = {-3, 0};
  // without a force the corner goes 3 m/s x 0.01 s into the other block
  const ContactError wrong = contact_error(mobilities(blocks, 1), set, rate, 0.01);
  CHECK(wrong.worst == approx(0.03).epsilon(1e-12));
  CHECK(wrong.point == 0);
  rate[1].a = {std::nan(""), 0};
  CHECK(std::isnan(contact_error(mobilities(blocks, 1), set, rate, 0.01).worst));
}

}  // namespace test_solve
