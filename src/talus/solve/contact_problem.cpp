#include "talus/solve/contact_problem.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "talus/base/index.h"

namespace talus {

namespace {

// A point of the island seen from one of its blocks.
struct Side {
  int local;  // index in the island
  double sign;
  Vec2 arm;
};

// Eq. 5.1.
RowState row_state(const ContactProblem& problem, size_t point, int k, double e, double p, double p_n) {
  const PointRows& rows = problem.rows[point];
  const Bounds b = bounds_of(rows, k, p_n);
  const double trial = p - e / problem.diagonal[static_cast<Eigen::Index>(2 * point) + k];
  if (trial > b.lower && trial < b.upper) return {};
  const bool upper = trial >= b.upper;
  const bool moves = k == 1 && b.upper > 0;
  return {false, upper ? b.upper : b.lower, moves ? (upper ? rows.friction : -rows.friction) : 0};
}

std::vector<RowState> row_states(const ContactProblem& problem, const Eigen::VectorXd& p,
                                 const Eigen::VectorXd& e) {
  std::vector<RowState> states(problem.size());
  for (size_t i = 0; i < problem.rows.size(); ++i) {
    for (int k = 0; k < 2; ++k) {
      const size_t r = 2 * i + k;
      const auto row = static_cast<Eigen::Index>(r);
      states[r] = row_state(problem, i, k, e[row], p[row], p[static_cast<Eigen::Index>(2 * i)]);
    }
  }
  return states;
}

// Whether the smoothing applies: contacts, not ties, supports or faces with strength.
bool is_smoothed(const PointRows& p) { return p.lower == 0 && p.cohesion == 0; }

constexpr double kTwoOverPi = 2 / 3.14159265358979323846;

// Theory 5.6, 5.9.
Eigen::VectorXd residual_smoothed(const ContactProblem& problem, const Eigen::VectorXd& p,
                                  const Eigen::VectorXd& e) {
  Eigen::VectorXd h(problem.size());
  const std::vector<RowState> states = row_states(problem, p, e);
  for (Eigen::Index r = 0; r < h.size(); ++r) {
    const PointRows& rows = problem.rows[r / 2];
    const RowState& state = states[r];
    const double w = problem.diagonal[r];
    if (!is_smoothed(rows)) {
      h[r] = state.free ? e[r] : w * (p[r] - state.held_at);
    } else if (r % 2 == 0) {
      const Smoothing& s = problem.smoothing;
      // as printed, metres and newtons: no scale of the row makes them one
      const double a = s.printed ? e[r] * s.dt : e[r] / w, b = s.printed ? p[r] / s.dt_kick : p[r];
      const double least = std::min(a, b) - s.impulse * std::log1p(std::exp(-std::abs(a - b) / s.impulse));
      h[r] = s.printed ? least / s.dt : w * least;
    } else {
      // slip of this step: the anchor of the exact law does not exist here
      const double slip = e[r] - rows.row[1].bias;
      h[r] = w * (p[r] + kTwoOverPi * rows.friction * std::max(p[r - 1], 0.0) *
                             std::atan(slip / problem.smoothing.velocity));
    }
  }
  return h;
}

}  // namespace

// Theory 5.1.
ContactProblem build_problem(const std::vector<Mobility>& mobility, const RowSet& set,
                             const std::vector<int>& points, const std::vector<BlockRate>& rate) {
  ContactProblem problem;
  problem.point = points;
  std::unordered_map<int, int> local_of;  // looked up only, never walked: its order does not matter
  for (int i = 0; i < count_of(points); ++i) local_of[points[i]] = i;
  std::vector<std::pair<int, Side>> sides;  // (block, side), sorted by block: a fixed order of sums
  for (int i = 0; i < count_of(points); ++i) {
    const PointRows& p = set.points[points[i]];
    problem.rows.push_back(p);
    const int local = i;
    if (moves(mobility, p.block_a)) sides.push_back({p.block_a, {local, 1, p.arm_a}});
    if (moves(mobility, p.block_b)) sides.push_back({p.block_b, {local, -1, p.arm_b}});
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });

  const int n = problem.size();
  std::vector<Eigen::Triplet<double>> entries;
  for (size_t begin = 0; begin < sides.size();) {
    size_t end = begin;
    while (end < sides.size() && sides[end].first == sides[begin].first) ++end;
    for (size_t i = begin; i < end; ++i) {
      for (size_t j = begin; j < end; ++j) {
        const Side &s = sides[i].second, &r = sides[j].second;
        const Mat2 w = (s.sign * r.sign) * influence(mobility[sides[i].first], s.arm, r.arm);
        const Vec2 ns = problem.rows[s.local].normal, nr = problem.rows[r.local].normal;
        const Vec2 ds[2] = {ns, turn_right(ns)}, dr[2] = {nr, turn_right(nr)};
        for (int k = 0; k < 2; ++k)
          for (int l = 0; l < 2; ++l)
            entries.emplace_back(2 * s.local + k, 2 * r.local + l, dot(ds[k], w * dr[l]));
      }
    }
    begin = end;
  }
  problem.velocity_free.resize(n);
  for (int i = 0; i < count_of(points); ++i) {
    const PointRows& p = problem.rows[i];
    const auto u = relative_velocity(p, rate);
    for (int k = 0; k < 2; ++k) {
      const int row = (2 * i) + k;
      problem.velocity_free[row] = u[k] + p.row[k].bias;
      entries.emplace_back(row, row, p.row[k].compliance);
      if (p.partner >= 0) entries.emplace_back(row, 2 * local_of.at(p.partner) + k, p.cross(k));
    }
  }
  problem.influence.resize(n, n);
  problem.influence.setFromTriplets(entries.begin(), entries.end());
  problem.diagonal = problem.influence.diagonal();
  return problem;
}

Eigen::VectorXd residual(const ContactProblem& problem, const Eigen::VectorXd& p) {
  const Eigen::VectorXd e = problem.influence * p + problem.velocity_free;
  if (problem.smoothing.on) return residual_smoothed(problem, p, e);
  const std::vector<RowState> states = row_states(problem, p, e);
  Eigen::VectorXd h(problem.size());
  for (Eigen::Index r = 0; r < h.size(); ++r) {
    const RowState& s = states[r];
    h[r] = s.free ? e[r] : problem.diagonal[r] * (p[r] - s.held_at);
  }
  return h;
}

std::vector<RowState> row_states(const ContactProblem& problem, const Eigen::VectorXd& p) {
  return row_states(problem, p, problem.influence * p + problem.velocity_free);
}

// Theory 5.2.
SparseMatrix jacobian(const ContactProblem& problem, const std::vector<RowState>& states) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(problem.influence.nonZeros());
  for (int row = 0; row < problem.size(); ++row) {
    const RowState& s = states[row];
    if (s.free) {
      for (SparseMatrix::InnerIterator it(problem.influence, row); it; ++it)
        entries.emplace_back(row, static_cast<int>(it.col()), it.value());
    } else {
      entries.emplace_back(row, row, problem.diagonal[row]);
      if (s.slope != 0) entries.emplace_back(row, row - 1, -problem.diagonal[row] * s.slope);
    }
  }
  SparseMatrix j(problem.size(), problem.size());
  j.setFromTriplets(entries.begin(), entries.end());
  return j;
}

// Theory 5.6.
SparseMatrix jacobian_smoothed(const ContactProblem& problem, const Eigen::VectorXd& p) {
  const Eigen::VectorXd e = problem.influence * p + problem.velocity_free;
  const std::vector<RowState> states = row_states(problem, p, e);
  std::vector<Eigen::Triplet<double>> entries;
  const auto add_row = [&](int row, double factor) {
    for (SparseMatrix::InnerIterator it(problem.influence, row); it; ++it)
      entries.emplace_back(row, static_cast<int>(it.col()), factor * it.value());
  };
  for (int row = 0; row < problem.size(); ++row) {
    const PointRows& rows = problem.rows[row / 2];
    const double w = problem.diagonal[row];
    const RowState& s = states[row];
    if (!is_smoothed(rows)) {
      if (s.free) {
        add_row(row, 1);
      } else {
        entries.emplace_back(row, row, w);
        if (s.slope != 0) entries.emplace_back(row, row - 1, -w * s.slope);
      }
    } else if (row % 2 == 0) {
      // share of a in the smoothed minimum: 1 / (1 + exp((a - b) / eps))
      const double x = (e[row] / w - p[row]) / problem.smoothing.impulse;
      const double share = x > 0 ? std::exp(-x) / (1 + std::exp(-x)) : 1 / (1 + std::exp(x));
      add_row(row, share);
      entries.emplace_back(row, row, w * (1 - share));
    } else {
      const double slip = (e[row] - rows.row[1].bias) / problem.smoothing.velocity;
      const double press = std::max(p[row - 1], 0.0);
      entries.emplace_back(row, row, w);
      if (press > 0) entries.emplace_back(row, row - 1, w * kTwoOverPi * rows.friction * std::atan(slip));
      add_row(row, w * kTwoOverPi * rows.friction * press / (1 + slip * slip) / problem.smoothing.velocity);
    }
  }
  SparseMatrix j(problem.size(), problem.size());
  j.setFromTriplets(entries.begin(), entries.end());
  return j;
}

// Theory 5.2.
Eigen::MatrixXd jacobian_by_differences(const ContactProblem& problem, const Eigen::VectorXd& p, double h) {
  const Eigen::VectorXd at_p = residual(problem, p);
  Eigen::MatrixXd j(problem.size(), problem.size());
  Eigen::VectorXd shifted = p;
  for (Eigen::Index k = 0; k < p.size(); ++k) {
    shifted[k] = p[k] + h;
    j.col(k) = (residual(problem, shifted) - at_p) / (shifted[k] - p[k]);
    shifted[k] = p[k];
  }
  return j;
}

}  // namespace talus
