#include "talus/solve/gauss_seidel.h"

#include <algorithm>

#include "talus/solve/contact_error.h"

namespace talus {

namespace {

// The error is measured after this many sweeps: it costs as much as one.
constexpr int kSweepsBetweenChecks = 10;

class Sweeper {
 public:
  Sweeper(const BlockSet& blocks, const std::vector<BlockRate>& rate, double scale, RowSet& set)
      : blocks_(blocks), scale_(scale), set_(set), rate_(rate) {
    for (size_t i = 0; i < set.points.size(); ++i) {
      const PointRows& p = set.points[i];
      double w[2] = {p.row[0].compliance, p.row[1].compliance};
      for (int k = 0; k < 2; ++k) {
        const Vec2 d = k == 0 ? p.normal : turn_right(p.normal);
        if (p.block_a >= 0)
          w[k] += scale * dot(d, influence(blocks, static_cast<size_t>(p.block_a), p.arm_a, p.arm_a) * d);
        if (p.block_b >= 0)
          w[k] += scale * dot(d, influence(blocks, static_cast<size_t>(p.block_b), p.arm_b, p.arm_b) * d);
      }
      diagonal_.push_back({w[0], w[1]});
      push(i, set.impulse[i]);  // the first guess
    }
  }

  void sweep() {
    for (size_t i = 0; i < set_.points.size(); ++i) {
      relax(i, 0);
      relax(i, 1);
    }
  }

  const std::vector<BlockRate>& rate() const { return rate_; }

 private:
  void relax(size_t i, size_t k) {
    const PointRows& p = set_.points[i];
    double& impulse = set_.impulse[i][k];
    double e = relative_velocity(p, rate_)[k] + p.row[k].bias + p.row[k].compliance * impulse;
    if (p.partner >= 0) e += p.cross[k] * set_.impulse[static_cast<size_t>(p.partner)][k];
    const Bounds b = bounds_of(p, static_cast<int>(k), set_.impulse[i][0]);
    const double next = std::clamp(impulse - e / diagonal_[i][k], b.lower, b.upper);
    Impulse change{};
    change[k] = next - impulse;
    impulse = next;
    if (change[k] != 0) push(i, change);
  }

  void push(size_t i, const Impulse& change) {
    const PointRows& p = set_.points[i];
    const auto move = [&](int block, double sign) {
      if (block < 0) return;
      const auto b = static_cast<size_t>(block);
      const BlockRate v = accelerate(blocks_, b, scale_ * impulse_on(p, change, sign));
      rate_[b].a += v.a;
      rate_[b].G += v.G;
    };
    move(p.block_a, 1);
    move(p.block_b, -1);
  }

  const BlockSet& blocks_;
  double scale_;
  RowSet& set_;
  std::vector<BlockRate> rate_;
  std::vector<std::array<double, 2>> diagonal_;
};

}  // namespace

SolveReport solve_gauss_seidel(const BlockSet& blocks, const std::vector<BlockRate>& rate, double scale,
                               const SolverInput& options, double tolerance, double dt, RowSet& set) {
  SolveReport report;
  report.converged = set.points.empty();
  Sweeper sweeper(blocks, rate, scale, set);
  while (!report.converged && report.iterations < options.max_sweeps) {
    sweeper.sweep();
    ++report.iterations;
    const bool look = report.iterations <= 3 || report.iterations % kSweepsBetweenChecks == 0;
    if (look) report.converged = contact_error(blocks, set, sweeper.rate(), scale, dt).worst <= tolerance;
  }
  return report;
}

}  // namespace talus
