// Lemke's method: the impulses of the other solvers where these find any, and solutions where they do not.

#include "talus/solve/pivoting.h"

#include <doctest/doctest.h>

#include <random>

#include "support/random_rows.h"
#include "talus/solve/contact_error.h"
#include "talus/solve/newton.h"
#include "talus/solve/solvers.h"

namespace test_pivoting {

using namespace talus;
using namespace talus::test;

namespace {

struct Problem {
  BlockSet blocks;
  std::vector<Mobility> mobility;
  std::vector<BlockRate> free;
  RowSet rows;
};

Problem between_squares(int count) {
  Problem problem{make_squares(count), {}, {}, {}};
  problem.mobility = mobilities(problem.blocks, 1);
  return problem;
}

struct Answer {
  std::vector<Impulse> impulse;
  std::vector<BlockRate> rate;
  double error = 0;
  SolveReport report;
};

Answer solved_by(Solver& solver, const Problem& problem, int threads = 1) {
  const Workers workers(threads);
  RowSet rows = problem.rows;
  std::vector<BlockRate> rate = problem.free;
  Profile profile;
  const StepProblem step{problem.mobility, problem.free, 1, {}, rows, rate, profile};
  SolverInput limits;
  Answer answer;
  answer.report = solver.solve(step, {1e-11}, limits, workers);
  answer.impulse = rows.impulse, answer.rate = rate;
  answer.error = contact_error(problem.mobility, rows, rate, 1, workers).worst;
  return answer;
}
Answer pivoted(const Problem& problem, int threads = 1) {
  Pivoting pivoting;
  return solved_by(pivoting, problem, threads);
}

// Rows of every kind, each with some give: contacts, ties, faces with strength (of some the bounds vanish before the
// face opens), bolts, and the two ends of a face.
Problem every_kind(std::mt19937& random) {
  Problem problem = between_squares(9);
  for (int i = 0; i < 12; ++i) {
    PointRows p = random_point(random, 9);
    p.row[0].compliance = 1e-4, p.row[1].compliance = 2e-4;
    switch (i % 6) {
      case 0:
        p.lower = 0, p.friction = 0.3, p.cohesion = 0;
        break;
      case 1:
        break;
      case 2:
        p.lower = -100, p.friction = 0.3, p.cohesion = 50;
        break;
      case 3:
        p.lower = -300, p.friction = 0.3, p.cohesion = 40;
        break;
      case 4:
        p.lower = -200, p.upper = 150, p.cohesion = 80;
        break;
      default:  // the other end of the face of case 3: of the same two blocks
        p = problem.rows.points[i - 2];
        p.arm_a += Vec2{0.3, 0.1}, p.arm_b += Vec2{0.3, 0.1};
        p.partner = i - 2;
        problem.rows.points[i - 2].partner = i;
    }
    problem.rows.add(p, {0, 0});
  }
  problem.free = random_rates(random, problem.blocks);
  return problem;
}

// Hard contacts of 80 degrees of friction.
Problem rough(std::mt19937& random) {
  Problem problem = between_squares(9);
  for (int i = 0; i < 24; ++i) {
    PointRows p = random_point(random, 9);
    p.lower = 0, p.friction = 5.67, p.cohesion = 0;
    p.row[0].bias = std::abs(p.row[0].bias), p.row[1].bias = 0;  // gaps: at rest all is well
    problem.rows.add(p, {0, 0});
  }
  problem.free = random_rates(random, problem.blocks);
  return problem;
}

}  // namespace

TEST_CASE("pivoting finds the impulses of Newton's method, whatever the rows") {
  std::mt19937 random(5);
  int compared = 0, held[4] = {};
  for (int trial = 0; trial < 60; ++trial) {
    CAPTURE(trial);
    const Problem problem = every_kind(random);
    const Answer mine = pivoted(problem);
    CHECK(mine.error < 1e-11);
    Newton newton;
    const Answer other = solved_by(newton, problem);
    if (!(other.error < 1e-11)) continue;
    ++compared;
    double largest = 0, most = 0;
    for (size_t i = 0; i < mine.impulse.size(); ++i)
      for (size_t k = 0; k < 2; ++k) {
        largest = std::max(largest, std::abs(other.impulse[i][k]));
        most = std::max(most, std::abs(mine.impulse[i][k] - other.impulse[i][k]));
      }
    CHECK(most < 1e-8 * largest);
    for (size_t i = 0; i < mine.impulse.size(); ++i) {
      const PointRows& p = problem.rows.points[i];
      held[0] += mine.impulse[i][0] == p.lower, held[1] += mine.impulse[i][0] == p.upper;
      held[2] += slides(p, mine.impulse[i]), held[3] += p.cohesion + p.friction * mine.impulse[i][0] < 0;
    }
  }
  CHECK(compared >= 50);
  for (const int n : held) CHECK(n > 5);  // there is something of each
}

TEST_CASE("pivoting solves contacts of 80 degrees that neither sweeps nor Newton's method do") {
  std::mt19937 random(6);
  int by_sweeps = 0, by_newton = 0;
  for (int trial = 0; trial < 40; ++trial) {
    CAPTURE(trial);
    const Problem problem = rough(random);
    CHECK(pivoted(problem).error < 1e-11);
    SolverSet solvers;
    by_sweeps += solved_by(solvers.of(SolverKind::kGaussSeidel), problem).error < 1e-9;
    by_newton += solved_by(solvers.of(SolverKind::kNewton), problem).error < 1e-9;

    // which is when it is asked
    Model model;
    RowSet rows = problem.rows;
    std::vector<BlockRate> rate = problem.free;
    std::vector<Impulse> guess;
    Profile profile;
    const StepProblem step{problem.mobility, problem.free, 1, {}, rows, rate, profile};
    const Solved solved = solve_step(model, {}, 1e-9, 0, 1, false, Workers(), solvers, step, guess);
    CHECK_FALSE(solved.failed);
    bool asked = false;
    for (size_t k = 0; k < solved.attempts.count; ++k)
      asked = asked || solved.attempts.list[k].solver == SolverKind::kPivoting;
    CHECK(asked == (solved.method == SolverKind::kPivoting));
  }
  MESSAGE("solved by sweeps ", by_sweeps, ", by Newton ", by_newton);
  CHECK(by_sweeps < 40);
  CHECK(by_newton < 40);
}

TEST_CASE("pivoting tolerates redundant ties, and redundant contacts on them") {
  Problem problem = between_squares(3);
  for (const int b : {1, 2})
    for (const double y : {-0.5, -0.2, 0.2, 0.5}) {
      PointRows p;
      p.block_a = b, p.block_b = b - 1;
      p.arm_a = {-0.5, y}, p.arm_b = {0.5, y};
      p.normal = {1, 0};
      problem.rows.add(p, {0, 0});
    }
  // a floor under the second, at six points, with strength at some
  for (int i = 0; i < 6; ++i) {
    PointRows p;
    p.block_a = 2;
    p.arm_a = {-0.5 + 0.2 * i, -0.5};
    p.normal = {0, 1};
    p.lower = i % 2 ? -1 : 0, p.friction = 0.6, p.cohesion = i % 2 ? 2 : 0;
    problem.rows.add(p, {0, 0});
  }
  problem.free.resize(3);
  problem.free[1] = {{1, -2}, {0, 0.1, -0.1, 0}};
  problem.free[2] = {{1, -2}, {0.3, 0.1, -0.4, 0.2}};
  const Answer answer = pivoted(problem);
  CHECK(answer.report.converged);
  CHECK(answer.error < 1e-12);
  for (size_t i = 0; i < 8; ++i)  // the tied edges stay together
    for (const double u : relative_velocity(problem.rows.points[i], answer.rate)) CHECK(std::abs(u) < 1e-12);
}

TEST_CASE(
    "pivoting solves hard faces with strength that are tied crosswise, and not quite to the same places") {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 5; ++trial) {
    CAPTURE(trial);
    Problem problem = between_squares(7);
    for (int a = 1; a < 7; ++a)
      for (const int b : {a - 1, a - 2, a - 3})
        for (int k = 0; k < 5; ++k) {
          if (b < 0) continue;
          PointRows p;
          p.block_a = a, p.block_b = b;
          const double angle = a - b == 1 ? 0 : a - b == 2 ? 1 : 2;
          p.normal = {std::cos(angle), std::sin(angle)};
          p.arm_a = {-0.5, 0.2 * k - 0.4}, p.arm_b = {0.5, 0.2 * k - 0.4};
          p.lower = -100, p.friction = 0.8, p.cohesion = 60;
          p.row[0].bias = 1e-3 * unit(random), p.row[1].bias = 1e-3 * unit(random);
          problem.rows.add(p, {0, 0});
        }
    problem.free = random_rates(random, problem.blocks);
    CHECK(pivoted(problem).error < 1e-10);
  }
}

TEST_CASE("pivoting has the same bits each time, with any number of threads, whatever came before") {
  std::mt19937 random(7);
  const Problem first = rough(random), second = rough(random);
  const Answer once = pivoted(first);
  CHECK(once.report.iterations > 10);
  Pivoting pivoting;
  solved_by(pivoting, second);
  CHECK(solved_by(pivoting, first).impulse == once.impulse);
  CHECK(pivoted(first, 3).impulse == once.impulse);
  CHECK(pivoted(first).rate[1].a.x == once.rate[1].a.x);
}

}  // namespace test_pivoting
