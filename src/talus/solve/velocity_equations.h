#pragma once
// The equations of a step in the velocities of its blocks: what they leave, and its derivative. Theory: docs/theory.md 5.8.

#include <algorithm>
#include <array>
#include <vector>

#include "talus/solve/block_factor.h"
#include "talus/solve/solver.h"

namespace talus {

using Six = std::array<double, 6>;

// One or two impulses of a face: which of them are free, and which at a bound.
struct BoundedImpulses {
  double p[2] = {0, 0};
  int at[2] = {0, 0};  // -1: lower bound, 1: upper, 0: between
};

// Derivative of a face's impulses, normal n and tangential t of both ends: dp = -[[n, 0], [slide n, t]] du.
struct FaceTangent {
  double n[2][2] = {}, t[2][2] = {}, slide[2][2] = {};
};

// How many faces have other parts in the symmetric matrix.
size_t differing(const std::vector<FaceTangent>& a, const std::vector<FaceTangent>& b);

// One step's equations F(v) = M (v - v*) - H^T P(H v + b) = 0 (eq. 5.3).
class VelocityEquations {
 public:
  VelocityEquations(const StepProblem& problem, const Workers& workers);

  // Velocities that the impulses of the rows give; from rest none, or those that are told, whichever leaves less.
  std::vector<double> start();

  // Impulses of these velocities into the rows, and F; with the derivative when it is asked for.
  // `keep`: of the law as it would be if impulses were free, or at their bounds, just where those of the rows are.
  std::vector<double> residual(const std::vector<double>& v, std::vector<FaceTangent>* tangent,
                               bool keep = false);

  // Friction's bounds are those of these normal impulses of the rows, not their own, and what gives does by so many times as
  // much, until let_go(): F is the gradient of a convex function.
  void hold(std::vector<double> pressed, double soft) { pressed_ = std::move(pressed), soft_ = soft; }
  void let_go() { pressed_.clear(), soft_ = 1; }

  // How far velocities move in the step while the impulses stand [m].
  double reach(const std::vector<double>& F) const;

  double square(const std::vector<double>& F) const { return product(F, times(inverse_, F)); }

  double product(const std::vector<double>& x, const std::vector<double>& y) const;

  // Centres of rows without give go where the impulses are. False when there are none, or none has moved.
  bool centre();

  // The exact Jacobian times x.
  std::vector<double> jacobian_times(const std::vector<FaceTangent>& tangent,
                                     const std::vector<double>& x) const;

  // Its symmetric part without friction's share: a tile for each block, and for each of pairs().
  void tiles(const std::vector<FaceTangent>& tangent, std::vector<Tile>& diagonal,
             std::vector<Tile>& beside) const;
  const std::vector<std::array<int, 2>>& pairs() const { return pairs_; }

  // Places that keep neighbours near each other, from nothing but the arms of the rows.
  std::vector<Vec2> places() const;

 private:
  // The faces of a step: points with their partners. Points of a face have the same blocks.
  struct Face {
    int point[2] = {-1, -1};
    int a = -1, b = -1;  // moving blocks by their number among these, the lower first; -1: none
    size_t count() const { return point[1] < 0 ? 1 : 2; }
  };
  struct Rows {
    // [normal, tangential][block a, block b]: of the impulse on each, so that b has the opposite sign
    Six of[2][2];
    int block[2];  // moving blocks by number, -1: none
  };

  std::vector<double> unknowns(const std::vector<BlockRate>& rate) const;
  const Mobility& mobility(size_t k) const { return problem_.mobility[moving_[k]]; }
  static size_t index(const Face& f, size_t end) { return f.point[end]; }
  static void put(std::vector<double>& v, size_t k, const Six& x) {
    std::copy(x.begin(), x.end(), &v[6 * k]);
  }

  void number_blocks();
  int number(int block) const { return block < 0 ? -1 : number_[block]; }

  // Faces in the order of their blocks; those of the same two stand together.
  void number_faces();

  // In a long step a block of little mass yields to a row far more than the joints around it do.
  void find_least_give();

  void add_row(size_t i);

  double along(size_t i, size_t k, const std::vector<double>& v) const;

  // Which impulses of the rows are at their bounds.
  BoundedImpulses standing(const Face& face, size_t k, const Bounds bounds[2]) const;

  void push_face(const Face& face, const std::vector<double>& v, bool keep, FaceTangent* tangent);

  void add_face(const Face& face, const FaceTangent& d, Tile& first, Tile& second, Tile* between) const;
  static void add_product(double s, const Six& x, const Six& y, Tile& to) {
    for (size_t r = 0; r < 6; ++r)
      for (size_t c = 0; c < 6; ++c) to[6 * r + c] += s * x[r] * y[c];
  }

  std::vector<double> times(const std::vector<Tile>& tile, const std::vector<double>& x) const;

  template <class F>
  void add_forces(double sign, F impulse_of, std::vector<double>& to) const {
    for (size_t i = 0; i < row_.size(); ++i) {
      const Rows& r = row_[i];
      const Impulse p = impulse_of(i);
      for (size_t s = 0; s < 2; ++s) {
        if (r.block[s] < 0) continue;
        double* y = &to[6 * r.block[s]];
        for (size_t m = 0; m < 6; ++m) y[m] += sign * (p[0] * r.of[0][s][m] + p[1] * r.of[1][s][m]);
      }
    }
  }

  const StepProblem& problem_;
  const Workers& workers_;
  std::vector<size_t> moving_;  // blocks that move
  std::vector<int> number_;     // of each block among them
  std::vector<Tile> mass_, inverse_;
  std::vector<double> free_;        // v*
  std::vector<double> least_give_;  // of each moving block: the least compliance of a row that has one
  std::vector<Face> faces_;
  std::vector<size_t> couple_begin_;  // faces of the same two blocks, and where the last end
  std::vector<int> couple_pair_;      // index among pairs_, -1: one of the blocks stands still
  std::vector<std::array<int, 2>> pairs_;
  std::vector<Rows> row_;
  std::vector<std::array<double, 2>> prox_, centre_, bias_;  // of each point
  std::vector<double> pressed_;  // of each point while bounds are held; else empty
  double soft_ = 1;
};

}  // namespace talus
