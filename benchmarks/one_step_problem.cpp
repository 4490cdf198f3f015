#include "one_step_problem.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "talus/geometry/polygon.h"

namespace talus::bench {
namespace {

using Corners = std::vector<Vec2>;

constexpr double kTouching = 1e-6;  // [m] gap below which two blocks at rest count as in contact

size_t next(const Corners& corners, size_t i) { return (i + 1) % corners.size(); }

Vec2 outward_normal(const Corners& corners, size_t edge) {
  const Vec2 along = corners[next(corners, edge)] - corners[edge];
  return turn_right(along) / norm(along);
}

struct EdgeGap {
  size_t edge = 0;
  double gap = -std::numeric_limits<double>::infinity();  // [m] of the other polygon above that edge
};

EdgeGap widest_gap(const Corners& a, const Corners& b) {
  EdgeGap widest;
  for (size_t i = 0; i < a.size(); ++i) {
    const Vec2 normal = outward_normal(a, i);
    double lowest = std::numeric_limits<double>::infinity();
    for (const Vec2 p : b) lowest = std::min(lowest, dot(normal, p - a[i]));
    // edges equally far apart must not be chosen by round-off
    if (lowest > widest.gap + 1e-9) widest = {i, lowest};
  }
  return widest;
}

struct TouchingPoint {
  Vec2 point, normal;
};

// Ends of the stretch along which an edge of a faces b's most opposite edge, where the two touch. Blocks that
// share only a corner have no such stretch: they hold each other through their neighbours.
std::vector<TouchingPoint> touching_points(const Corners& a, size_t edge, const Corners& b) {
  const Vec2 origin = a[edge], normal = outward_normal(a, edge), along = turn_left(normal);
  const double length = norm(a[next(a, edge)] - origin);
  size_t facing = 0;
  for (size_t i = 1; i < b.size(); ++i)
    if (dot(outward_normal(b, i), normal) < dot(outward_normal(b, facing), normal)) facing = i;
  const Vec2 from = b[facing] - origin, to = b[next(b, facing)] - origin;
  const double s_from = dot(from, along), s_to = dot(to, along);
  const double low = std::max(0.0, std::min(s_from, s_to));
  const double high = std::min(length, std::max(s_from, s_to));
  std::vector<TouchingPoint> points;
  if (high - low < kTouching) return points;
  for (const double s : {low, high}) {
    const Vec2 opposite = from + (s - s_from) / (s_to - s_from) * (to - from);
    if (dot(opposite, normal) <= kTouching) points.push_back({origin + s * along, normal});
  }
  return points;
}

// The six motions of a block are two translations and four linear fields G X about its centroid: spin, ex,
// ey, gxy.
constexpr std::array<Mat2, 4> kLinearMotions = {Mat2{0, -1, 1, 0}, Mat2{1, 0, 0, 0}, Mat2{0, 0, 0, 1},
                                                Mat2{0, 0.5, 0.5, 0}};

Jacobian26 velocity_at(Vec2 arm) {
  Jacobian26 rows = Jacobian26::Zero();
  rows(0, 0) = rows(1, 1) = 1;
  for (size_t k = 0; k < kLinearMotions.size(); ++k) {
    const Vec2 v = kLinearMotions[k] * arm;
    rows.col(static_cast<Eigen::Index>(k) + 2) << v.x, v.y;
  }
  return rows;
}

// M + h^2 K of the four linear motions; the translations stand apart, for the arms are about the centroid.
Eigen::Matrix4d linear_matrix(const PolygonMoments& moments, double density, double dt, double young,
                              double poisson) {
  Eigen::Matrix4d matrix;
  for (size_t k = 0; k < kLinearMotions.size(); ++k)
    for (size_t l = 0; l < kLinearMotions.size(); ++l)
      matrix(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)) =
          density * contract(kLinearMotions[k] * moments.second, kLinearMotions[l]);
  Eigen::Matrix3d plane_stress;
  plane_stress << 1, poisson, 0,  //
      poisson, 1, 0,              //
      0, 0, (1 - poisson) / 2;
  matrix.bottomRightCorner<3, 3>() += dt * dt * moments.area * young / (1 - poisson * poisson) * plane_stress;
  return matrix;
}

Jacobian26 directions(Vec2 normal, const Jacobian26& velocity) {
  Eigen::Matrix2d axes;
  axes << normal.x, normal.y, -normal.y, normal.x;
  return axes * velocity;
}

std::vector<OneStepPoint> find_points(const BenchScene& scene, const std::vector<Vec2>& centroid) {
  std::vector<OneStepPoint> points;
  for (const auto& [i, j] : near_pairs(scene.blocks, kTouching)) {
    const Corners &p = scene.blocks[i].corners, &q = scene.blocks[j].corners;
    const EdgeGap of_p = widest_gap(p, q), of_q = widest_gap(q, p);
    if (std::max(of_p.gap, of_q.gap) > kTouching) continue;
    const bool p_owns = !(of_q.gap > of_p.gap + 1e-9);
    const int a = p_owns ? i : j, b = p_owns ? j : i;
    const auto touching = p_owns ? touching_points(p, of_p.edge, q) : touching_points(q, of_q.edge, p);
    for (const TouchingPoint& touch : touching) {
      const auto jacobian = [&](int block) -> Jacobian26 {
        if (scene.blocks[block].fixed) return Jacobian26::Zero();
        return directions(touch.normal, velocity_at(touch.point - centroid[block]));
      };
      points.push_back({a, b, touch.point, touch.normal, -jacobian(a), jacobian(b)});
    }
  }
  return points;
}

Vec2 nearest_in_cone(Vec2 z, double friction) {
  const double tangent = std::abs(z.y);
  if (tangent <= friction * z.x) return z;
  if (friction * tangent <= -z.x) return {0, 0};
  const double normal = (z.x + friction * tangent) / (1 + friction * friction);
  return {normal, std::copysign(friction * normal, z.y)};
}

}  // namespace

OneStepProblem one_step_problem(const BenchScene& scene, double dt, double young, double poisson) {
  OneStepProblem problem;
  problem.friction = scene.friction;
  problem.dt = dt;
  std::vector<Vec2> centroid;
  double mass = 0;
  for (const BenchBlock& block : scene.blocks) {
    const PolygonMoments moments = polygon_moments(block.corners);
    centroid.push_back(moments.centroid);
    problem.inverse.push_back(Matrix6::Zero());
    problem.velocity.push_back(Vector6::Zero());
    if (block.fixed) continue;
    const double block_mass = scene.density * moments.area;
    mass += block_mass;
    problem.inverse.back().topLeftCorner<2, 2>().diagonal().setConstant(1 / block_mass);
    problem.inverse.back().bottomRightCorner<4, 4>() =
        linear_matrix(moments, scene.density, dt, young, poisson).inverse();
    problem.velocity.back()(1) = -kGravity * dt;
  }
  problem.impulse_unit = mass / scene.moving();
  problem.points = find_points(scene, centroid);
  return problem;
}

std::vector<Vec2> point_velocities(const OneStepProblem& problem, const std::vector<Vec2>& impulse) {
  std::vector<Vector6> force(problem.velocity.size(), Vector6::Zero());
  for (size_t k = 0; k < problem.points.size(); ++k) {
    const OneStepPoint& p = problem.points[k];
    const Eigen::Vector2d r(impulse[k].x, impulse[k].y);
    force[p.a] += p.jacobian_a.transpose() * r;
    force[p.b] += p.jacobian_b.transpose() * r;
  }
  std::vector<Vector6> velocity = problem.velocity;
  for (size_t i = 0; i < velocity.size(); ++i) velocity[i] += problem.inverse[i] * force[i];
  std::vector<Vec2> result;
  for (const OneStepPoint& p : problem.points) {
    const Eigen::Vector2d u = p.jacobian_a * velocity[p.a] + p.jacobian_b * velocity[p.b];
    result.push_back({u(0), u(1)});
  }
  return result;
}

double natural_map_error(const OneStepProblem& problem, const std::vector<Vec2>& impulse) {
  const std::vector<Vec2> w = point_velocities(problem, impulse);
  const std::vector<Vec2> free = point_velocities(problem, std::vector<Vec2>(impulse.size()));
  double off_squares = 0, z_squares = 0, w_squares = 0, free_squares = 0;
  for (size_t k = 0; k < impulse.size(); ++k) {
    const Vec2 z = impulse[k] / problem.impulse_unit;
    const Vec2 moved = z - w[k] - Vec2{problem.friction * std::abs(w[k].y), 0};
    const Vec2 off = z - nearest_in_cone(moved, problem.friction);
    off_squares += dot(off, off);
    z_squares += dot(z, z);
    w_squares += dot(w[k], w[k]);
    free_squares += dot(free[k], free[k]);
  }
  return std::sqrt(off_squares / std::max({z_squares, w_squares, free_squares}));
}

BenchRow one_step_row(const BenchScene& scene, const OneStepProblem& problem,
                      const std::vector<Vec2>& impulse) {
  const std::vector<Vec2> velocity = point_velocities(problem, impulse);
  std::vector<BenchContact> contacts;
  for (size_t k = 0; k < impulse.size(); ++k) {
    const OneStepPoint& p = problem.points[k];
    const Vec2 relative = velocity[k].x * p.normal + velocity[k].y * turn_left(p.normal);
    contacts.push_back({p.a, p.b, p.point, p.normal, impulse[k].x, impulse[k].y, relative});
  }
  BenchRow row;
  row.phase = "one_step";
  row.blocks = scene.moving();
  row.dt = problem.dt;
  row.steps = 1;
  row.contact_points = static_cast<double>(impulse.size());
  row.law = measure_law(scene, contacts, problem.dt, {0, -kGravity});
  row.error_worst = natural_map_error(problem, impulse);
  return row;
}

}  // namespace talus::bench
