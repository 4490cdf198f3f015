#include "talus/solve/primal_newton.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "talus/base/error.h"
#include "talus/solve/block_factor.h"
#include "talus/solve/gauss_seidel.h"

namespace talus {

namespace {

// Rows that do not give at all get the share 1 / kStiff of their influence, or of what the stiffest other row of a block
// gives where that is less, about a centre that follows the impulse: what they settle at is exact.
constexpr double kStiff = 1e7;

// The centre is moved once velocities are found to this share of the error.
constexpr double kInner = 0.1;

// Iterations on the exact Jacobian: to this residual where the faces that stand are expected to stay so, to the other
// where some are not, by so many at most.
constexpr double kResidual = 1e-4, kRoughResidual = 1e-2;
constexpr int kMostInner = 30;

// A new factor costs about as much as five such iterations, and each face that opens, closes, slips or sticks since
// the factor was made may ask for one more.
constexpr size_t kMostChanged = 4;

// Sweeps before: from far off, where free velocities say nothing about which points are closed, Newton's method
// finds no way.
constexpr int kSweepsFirst = 40;

// Iterations that may pass without the residual halving, and how often a step is halved for it.
constexpr int kPatience = 6, kMostHalved = 8;

constexpr size_t kChunkOfFaces = 512, kChunkOfBlocks = 512;

using Six = std::array<double, 6>;

// A block's unknowns: a.x, a.y and G' in the axes of its mobility, row by row; of a rigid block the spin in place
// of G'xx, and three that stand still.
bool is_rigid(const Mobility& m) { return m.stretch[0] == 0 && m.stretch[2] == 0; }

Six coefficients(const Mobility& m, Vec2 direction, Vec2 arm) {
  const Vec2 e = turned_back(m.left, direction), y = turned_back(m.right, arm);
  if (is_rigid(m)) return {direction.x, direction.y, e.y * y.x - e.x * y.y, 0, 0, 0};
  return {direction.x, direction.y, e.x * y.x, e.x * y.y, e.y * y.x, e.y * y.y};
}

Six to_unknowns(const Mobility& m, const BlockRate& r) {
  const Mat2 g = transpose(rotation(m.left)) * r.G * rotation(m.right);
  if (is_rigid(m)) return {r.a.x, r.a.y, 0.5 * (g.yx - g.xy), 0, 0, 0};
  return {r.a.x, r.a.y, g.xx, g.xy, g.yx, g.yy};
}

// The mass of the step and its inverse.
void mass_tiles(const Mobility& m, Tile& mass, Tile& inverse) {
  mass.fill(0), inverse.fill(0);
  const auto set = [&](size_t r, size_t c, double of_mass, double of_inverse) {
    mass[6 * r + c] = of_mass, inverse[6 * r + c] = of_inverse;
  };
  set(0, 0, 1 / m.mass, m.mass), set(1, 1, 1 / m.mass, m.mass);
  if (is_rigid(m)) {
    set(2, 2, 1 / m.shear[0], m.shear[0]);
    for (size_t k = 3; k < 6; ++k) set(k, k, 1, 1);
    return;
  }
  const double stretch = m.stretch[0] * m.stretch[2] - m.stretch[1] * m.stretch[1],
               shear = m.shear[0] * m.shear[2] - m.shear[1] * m.shear[1];
  set(2, 2, m.stretch[2] / stretch, m.stretch[0]), set(5, 5, m.stretch[0] / stretch, m.stretch[2]);
  set(2, 5, -m.stretch[1] / stretch, m.stretch[1]), set(5, 2, -m.stretch[1] / stretch, m.stretch[1]);
  set(3, 3, m.shear[2] / shear, m.shear[0]), set(4, 4, m.shear[0] / shear, m.shear[2]);
  set(3, 4, -m.shear[1] / shear, m.shear[1]), set(4, 3, -m.shear[1] / shear, m.shear[1]);
}

double dot(const Six& x, const double* v) {
  double s = 0;
  for (size_t k = 0; k < 6; ++k) s += x[k] * v[k];
  return s;
}

// One or two impulses of a face: which of them are free, and which at a bound.
struct Bounded {
  double p[2] = {0, 0};
  int at[2] = {0, 0};  // -1: lower bound, 1: upper, 0: between
};

// The impulses p of C p + q = 0 where they are free, the others at their bounds. False when a bound is endless.
bool with_free(const double C[2][2], const double q[2], const Bounds bounds[2], size_t count, Bounded& face) {
  double* p = face.p;
  const int* at = face.at;
  for (size_t k = 0; k < count; ++k) {
    if (at[k] == 0) continue;
    p[k] = at[k] < 0 ? bounds[k].lower : bounds[k].upper;
    if (!std::isfinite(p[k])) return false;
  }
  if (count == 1) {
    if (at[0] == 0) p[0] = -q[0] / C[0][0];
  } else if (at[0] == 0 && at[1] == 0) {
    const double det = C[0][0] * C[1][1] - C[0][1] * C[1][0];
    p[0] = -(C[1][1] * q[0] - C[0][1] * q[1]) / det, p[1] = -(C[0][0] * q[1] - C[1][0] * q[0]) / det;
  } else {
    for (size_t k = 0; k < 2; ++k)
      if (at[k] == 0) p[k] = -(q[k] + C[k][1 - k] * p[1 - k]) / C[k][k];
  }
  return true;
}

// The minimum of p C p / 2 + q p within bounds.
Bounded within_bounds(const double C[2][2], const double q[2], const Bounds bounds[2], size_t count) {
  static constexpr int kCases[9][2] = {{0, 0},   {0, -1}, {-1, 0}, {0, 1}, {1, 0},
                                       {-1, -1}, {1, 1},  {-1, 1}, {1, -1}};
  Bounded best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& at : kCases) {
    if (count == 1 && at[1] != 0) continue;
    Bounded face{{0, 0}, {at[0], at[1]}};
    if (!with_free(C, q, bounds, count, face)) continue;
    double miss = 0;
    for (size_t k = 0; k < count; ++k) {
      const double g = q[k] + C[k][0] * face.p[0] + (count > 1 ? C[k][1] * face.p[1] : 0);
      if (at[k] == 0)
        miss = std::max(miss, std::max(bounds[k].lower - face.p[k], face.p[k] - bounds[k].upper) * C[k][k]);
      else if (bounds[k].upper > bounds[k].lower)
        miss = std::max(miss, at[k] < 0 ? -g : g);
    }
    if (miss < least) least = miss, best = face;
    if (miss <= 0) break;
  }
  return best;
}

// The faces of a step: points with their partners. Points of a face have the same blocks.
struct Face {
  int point[2] = {-1, -1};
  int a = -1, b = -1;  // moving blocks by their number among these, the lower first; -1: none
  size_t count() const { return point[1] < 0 ? 1 : 2; }
};

// Derivative of a face's impulses, normal n and tangential t of both ends: dp = -[[n, 0], [slide n, t]] du.
struct FaceTangent {
  double n[2][2] = {}, t[2][2] = {}, slide[2][2] = {};
};

// How many faces have other parts in the symmetric matrix.
size_t differing(const std::vector<FaceTangent>& a, const std::vector<FaceTangent>& b) {
  size_t count = 0;
  for (size_t f = 0; f < a.size(); ++f)
    count +=
        std::memcmp(a[f].n, b[f].n, sizeof a[f].n) != 0 || std::memcmp(a[f].t, b[f].t, sizeof a[f].t) != 0;
  return count;
}

// Inverse of C on what is free, zero elsewhere.
void invert_free(const double C[2][2], const int at[2], size_t count, double out[2][2]) {
  const bool first = at[0] == 0, second = count > 1 && at[1] == 0;
  if (first && second) {
    const double det = C[0][0] * C[1][1] - C[0][1] * C[1][0];
    out[0][0] = C[1][1] / det, out[1][1] = C[0][0] / det, out[0][1] = out[1][0] = -C[0][1] / det;
  } else if (first) {
    out[0][0] = 1 / C[0][0];
  } else if (second) {
    out[1][1] = 1 / C[1][1];
  }
}

// One step's equations F(v) = M (v - v*) - H^T P(H v + b) = 0 (eq. 5.3).
class Equations {
 public:
  Equations(const StepProblem& problem, const Workers& workers) : problem_(problem), workers_(workers) {
    number_blocks();
    number_faces();
    const size_t points = problem.rows.size();
    row_.resize(points), prox_.resize(points), centre_.resize(points), bias_.resize(points);
    find_least_give();
    workers.for_chunks(points, kChunkOfFaces, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) add_row(i);
    });
  }

  // Velocities that the impulses of the rows give; from rest none, or those that are told, whichever leaves less.
  std::vector<double> start() {
    if (!problem_.from_rest) {
      std::vector<BlockRate> rate = problem_.rate_free;
      apply_impulses(problem_.mobility, problem_.rows, rate);
      return unknowns(rate);
    }
    std::vector<double> none(6 * moving_.size());
    if (!problem_.near) return none;
    const double still = square(residual(none, nullptr));
    std::vector<double> told = unknowns(*problem_.near);
    // rows that do not give know these velocities but to some digits: their impulses are those they come with
    const std::vector<std::array<double, 2>> centre = centre_;
    for (size_t i = 0; i < prox_.size(); ++i)
      for (size_t k = 0; k < 2; ++k)
        if (prox_[i][k] > 0) centre_[i][k] += (along(i, k, told) + bias_[i][k]) / prox_[i][k];
    if (square(residual(told, nullptr)) < still) return told;
    centre_ = centre;
    return none;
  }

  // Impulses of these velocities into the rows, and F; with the derivative when it is asked for.
  // `keep`: of the law as it would be if impulses were free, or at their bounds, just where those of the rows are.
  std::vector<double> residual(const std::vector<double>& v, std::vector<FaceTangent>* tangent,
                               bool keep = false) {
    if (tangent) tangent->assign(faces_.size(), {});
    workers_.for_chunks(faces_.size(), kChunkOfFaces, [&](size_t begin, size_t end) {
      for (size_t f = begin; f < end; ++f) push_face(faces_[f], v, keep, tangent ? &(*tangent)[f] : nullptr);
    });
    // the rates of these impulses, by the mobilities that they are judged by: in a long step v* is a fall and a spin that
    // impulses all but cancel, and the mass is known as their inverse only to some digits
    std::vector<double> impulse(v.size(), 0.0);
    add_forces(
        1, [&](size_t i) { return problem_.rows.impulse[i]; }, impulse);
    std::vector<double> change = times(inverse_, impulse);
    for (size_t i = 0; i < v.size(); ++i) change[i] = v[i] - (free_[i] + change[i]);
    return times(mass_, change);
  }

  // How far velocities move in the step while the impulses stand [m].
  double reach(const std::vector<double>& F) const {
    const std::vector<double> v = times(inverse_, F);
    double most = 0;
    for (size_t i = 0; i < row_.size(); ++i)
      for (size_t k = 0; k < 2; ++k) most = std::max(most, std::abs(along(i, k, v)));
    return most * problem_.dt;
  }

  double square(const std::vector<double>& F) const { return product(F, times(inverse_, F)); }

  double product(const std::vector<double>& x, const std::vector<double>& y) const {
    return workers_.sum_chunks<double>(x.size(), 6 * kChunkOfBlocks,
                                       [&](size_t begin, size_t end, double& sum) {
                                         for (size_t i = begin; i < end; ++i) sum += x[i] * y[i];
                                       });
  }

  // Centres of rows without give go where the impulses are. False when there are none, or none has moved.
  bool centre() {
    bool moved = false;
    for (size_t i = 0; i < prox_.size(); ++i)
      for (size_t k = 0; k < 2; ++k) {
        if (prox_[i][k] == 0 || centre_[i][k] == problem_.rows.impulse[i][k]) continue;
        centre_[i][k] = problem_.rows.impulse[i][k];
        moved = true;
      }
    return moved;
  }

  // The exact Jacobian times x.
  std::vector<double> jacobian_times(const std::vector<FaceTangent>& tangent,
                                     const std::vector<double>& x) const {
    std::vector<Impulse> pull(row_.size(), Impulse{});
    workers_.for_chunks(faces_.size(), kChunkOfFaces, [&](size_t begin, size_t end) {
      for (size_t f = begin; f < end; ++f) {
        const Face& face = faces_[f];
        const FaceTangent& d = tangent[f];
        double u[2][2] = {}, n[2];
        for (size_t e = 0; e < face.count(); ++e)
          for (size_t k = 0; k < 2; ++k) u[e][k] = along(index(face, e), k, x);
        for (size_t e = 0; e < 2; ++e) n[e] = d.n[e][0] * u[0][0] + d.n[e][1] * u[1][0];
        for (size_t e = 0; e < face.count(); ++e)
          pull[index(face, e)] = {
              n[e], d.t[e][0] * u[0][1] + d.t[e][1] * u[1][1] + d.slide[e][0] * n[0] + d.slide[e][1] * n[1]};
      }
    });
    std::vector<double> y = times(mass_, x);
    add_forces(
        1, [&](size_t i) { return pull[i]; }, y);
    return y;
  }

  // Its symmetric part without friction's share: a tile for each block, and for each of pairs().
  void tiles(const std::vector<FaceTangent>& tangent, std::vector<Tile>& diagonal,
             std::vector<Tile>& beside) const {
    diagonal = mass_;
    beside.assign(pairs_.size(), Tile{});
    std::vector<std::array<Tile, 2>> own(couple_begin_.size() - 1);
    workers_.for_chunks(own.size(), 64, [&](size_t begin, size_t end) {
      for (size_t c = begin; c < end; ++c) {
        own[c][0].fill(0), own[c][1].fill(0);
        Tile* between = couple_pair_[c] < 0 ? nullptr : &beside[static_cast<size_t>(couple_pair_[c])];
        for (size_t f = couple_begin_[c]; f < couple_begin_[c + 1]; ++f)
          add_face(faces_[f], tangent[f], own[c][0], own[c][1], between);
      }
    });
    for (size_t c = 0; c < own.size(); ++c) {
      const Face& face = faces_[couple_begin_[c]];
      for (size_t k = 0; k < 36; ++k) {
        if (face.a >= 0) diagonal[static_cast<size_t>(face.a)][k] += own[c][0][k];
        if (face.b >= 0) diagonal[static_cast<size_t>(face.b)][k] += own[c][1][k];
      }
    }
  }
  const std::vector<std::array<int, 2>>& pairs() const { return pairs_; }

  // Places that keep neighbours near each other, from nothing but the arms of the rows.
  std::vector<Vec2> places() const {
    std::vector<Vec2> place(moving_.size());
    std::vector<std::vector<std::pair<int, Vec2>>> near(moving_.size());
    for (size_t c = 0; c + 1 < couple_begin_.size(); ++c) {
      const Face& face = faces_[couple_begin_[c]];
      if (face.a < 0 || face.b < 0) continue;
      const PointRows& p = problem_.rows.points[index(face, 0)];
      Vec2 from_a_to_b = p.arm_a - p.arm_b;
      if (number_[static_cast<size_t>(p.block_a)] != face.a) from_a_to_b = -1.0 * from_a_to_b;
      near[static_cast<size_t>(face.a)].emplace_back(face.b, from_a_to_b);
      near[static_cast<size_t>(face.b)].emplace_back(face.a, -1.0 * from_a_to_b);
    }
    std::vector<char> known(moving_.size(), 0);
    std::vector<size_t> next;
    for (size_t first = 0; first < place.size(); ++first) {
      if (known[first]) continue;
      known[first] = 1, next = {first};
      for (size_t i = 0; i < next.size(); ++i)
        for (const auto& [b, step] : near[next[i]]) {
          const auto k = static_cast<size_t>(b);
          if (known[k]) continue;
          known[k] = 1, place[k] = place[next[i]] + step, next.push_back(k);
        }
    }
    return place;
  }

 private:
  struct Rows {
    Six of
        [2]
        [2];  // [normal, tangential][block a, block b]: of the impulse on each, so that b has the opposite sign
    int block[2];  // moving blocks by number, -1: none
  };

  std::vector<double> unknowns(const std::vector<BlockRate>& rate) const {
    std::vector<double> v(6 * moving_.size());
    for (size_t k = 0; k < moving_.size(); ++k) put(v, k, to_unknowns(mobility(k), rate[moving_[k]]));
    return v;
  }
  const Mobility& mobility(size_t k) const { return problem_.mobility[moving_[k]]; }
  static size_t index(const Face& f, size_t end) { return static_cast<size_t>(f.point[end]); }
  static void put(std::vector<double>& v, size_t k, const Six& x) {
    std::copy(x.begin(), x.end(), &v[6 * k]);
  }

  void number_blocks() {
    number_.assign(problem_.mobility.size(), -1);
    for (size_t i = 0; i < number_.size(); ++i)
      if (problem_.mobility[i].moves()) number_[i] = static_cast<int>(moving_.size()), moving_.push_back(i);
    mass_.resize(moving_.size()), inverse_.resize(moving_.size()), free_.resize(6 * moving_.size());
    for (size_t k = 0; k < moving_.size(); ++k) {
      mass_tiles(mobility(k), mass_[k], inverse_[k]);
      put(free_, k, to_unknowns(mobility(k), problem_.rate_free[moving_[k]]));
    }
  }
  int number(int block) const { return block < 0 ? -1 : number_[static_cast<size_t>(block)]; }

  // Faces in the order of their blocks; those of the same two stand together.
  void number_faces() {
    const std::vector<PointRows>& points = problem_.rows.points;
    for (size_t i = 0; i < problem_.rows.size(); ++i) {
      const PointRows& p = points[i];
      if (p.partner >= 0 && p.partner < static_cast<int>(i)) continue;
      const int a = number(p.block_a), b = number(p.block_b);
      if (a < 0 && b < 0) continue;
      Face f;
      f.point[0] = static_cast<int>(i), f.point[1] = p.partner;
      f.a = a < 0 ? b : b < 0 ? a : std::min(a, b), f.b = a < 0 || b < 0 ? -1 : std::max(a, b);
      faces_.push_back(f);
    }
    std::sort(faces_.begin(), faces_.end(), [](const Face& f, const Face& g) {
      return f.a != g.a ? f.a < g.a : f.b != g.b ? f.b < g.b : f.point[0] < g.point[0];
    });
    for (size_t f = 0; f < faces_.size(); ++f) {
      if (f > 0 && faces_[f].a == faces_[f - 1].a && faces_[f].b == faces_[f - 1].b) continue;
      couple_begin_.push_back(f);
      couple_pair_.push_back(faces_[f].b < 0 ? -1 : static_cast<int>(pairs_.size()));
      if (faces_[f].b >= 0) pairs_.push_back({faces_[f].a, faces_[f].b});
    }
    couple_begin_.push_back(faces_.size());
  }

  // In a long step a block of little mass yields to a row far more than the joints around it do.
  void find_least_give() {
    least_give_.assign(moving_.size(), std::numeric_limits<double>::infinity());
    for (const PointRows& p : problem_.rows.points)
      for (const int block : {p.block_a, p.block_b})
        for (const Row& row : p.row) {
          const int b = number(block);
          if (b < 0 || row.compliance <= 0) continue;
          double& least = least_give_[static_cast<size_t>(b)];
          least = std::min(least, row.compliance);
        }
  }

  void add_row(size_t i) {
    const PointRows& p = problem_.rows.points[i];
    Rows& r = row_[i];
    const Vec2 axis[2] = {p.normal, turn_right(p.normal)}, arm[2] = {p.arm_a, p.arm_b};
    const int block[2] = {p.block_a, p.block_b};
    for (size_t k = 0; k < 2; ++k) {
      double influence = 0;
      bias_[i][k] = p.row[k].bias;
      for (size_t s = 0; s < 2; ++s) {
        const double sign = s == 0 ? 1 : -1;
        r.block[s] = number(block[s]);
        r.of[k][s] = {};
        if (r.block[s] < 0) {
          if (block[s] >= 0)
            bias_[i][k] +=
                sign *
                talus::dot(axis[k], velocity_at(problem_.rate_free[static_cast<size_t>(block[s])], arm[s]));
          continue;
        }
        const auto b = static_cast<size_t>(r.block[s]);
        Six x = coefficients(mobility(b), axis[k], arm[s]);
        for (double& c : x) c *= sign;
        r.of[k][s] = x;
        for (size_t m = 0; m < 6; ++m)
          for (size_t n = 0; n < 6; ++n) influence += x[m] * inverse_[b][6 * m + n] * x[n];
      }
      for (const int b : r.block)
        if (b >= 0) influence = std::min(influence, least_give_[static_cast<size_t>(b)]);
      prox_[i][k] = p.row[k].compliance > 0 ? 0 : influence / kStiff;
      centre_[i][k] = problem_.rows.impulse[i][k];
    }
  }

  double along(size_t i, size_t k, const std::vector<double>& v) const {
    const Rows& r = row_[i];
    double u = 0;
    for (size_t s = 0; s < 2; ++s)
      if (r.block[s] >= 0) u += dot(r.of[k][s], &v[6 * static_cast<size_t>(r.block[s])]);
    return u;
  }

  // Which impulses of the rows are at their bounds.
  Bounded standing(const Face& face, size_t k, const Bounds bounds[2]) const {
    Bounded result;
    for (size_t e = 0; e < face.count(); ++e) {
      const double p = problem_.rows.impulse[index(face, e)][k];
      // sweeps put a sliding impulse at its bound to some digits only
      const double near = k == 1 ? 1e-8 * bounds[e].upper : 0;
      result.at[e] = p <= bounds[e].lower + near ? -1 : p >= bounds[e].upper - near ? 1 : 0;
    }
    return result;
  }

  void push_face(const Face& face, const std::vector<double>& v, bool keep, FaceTangent* tangent) {
    const size_t count = face.count();
    double C[2][2][2] = {}, q[2][2] = {};
    Bounds bounds[2] = {};
    for (size_t e = 0; e < count; ++e) {
      const size_t i = index(face, e);
      const PointRows& p = problem_.rows.points[i];
      for (size_t k = 0; k < 2; ++k) {
        C[k][e][e] = p.row[k].compliance + prox_[i][k];
        if (count > 1) C[k][e][1 - e] = p.cross(static_cast<int>(k));
        q[k][e] = along(i, k, v) + bias_[i][k] - prox_[i][k] * centre_[i][k];
      }
      bounds[e] = bounds_of(p, 0, 0);
    }
    Bounded n, t;
    if (keep) {
      Bounds cone[2] = {};
      for (size_t e = 0; e < count; ++e)
        cone[e] =
            bounds_of(problem_.rows.points[index(face, e)], 1, problem_.rows.impulse[index(face, e)][0]);
      n = standing(face, 0, bounds), t = standing(face, 1, cone);
    }
    if (!keep || !with_free(C[0], q[0], bounds, count, n)) n = within_bounds(C[0], q[0], bounds, count);
    for (size_t e = 0; e < count; ++e) bounds[e] = bounds_of(problem_.rows.points[index(face, e)], 1, n.p[e]);
    if (!keep || !with_free(C[1], q[1], bounds, count, t)) t = within_bounds(C[1], q[1], bounds, count);
    for (size_t e = 0; e < count; ++e) problem_.rows.impulse[index(face, e)] = {n.p[e], t.p[e]};
    if (!tangent) return;
    invert_free(C[0], n.at, count, tangent->n);
    invert_free(C[1], t.at, count, tangent->t);
    // a sliding end follows its normal impulse, and a partner that sticks yields to it
    for (size_t e = 0; e < count; ++e) {
      if (t.at[e] == 0 || bounds[e].upper <= 0 || std::isinf(bounds[e].upper)) continue;
      const double share = t.at[e] * problem_.rows.points[index(face, e)].friction;
      tangent->slide[e][e] = share;
      if (count > 1 && t.at[1 - e] == 0)
        tangent->slide[1 - e][e] = -C[1][1 - e][e] / C[1][1 - e][1 - e] * share;
    }
  }

  void add_face(const Face& face, const FaceTangent& d, Tile& first, Tile& second, Tile* between) const {
    for (size_t k = 0; k < 2; ++k) {
      const auto& D = k == 0 ? d.n : d.t;
      for (size_t e = 0; e < face.count(); ++e)
        for (size_t f = 0; f < face.count(); ++f) {
          if (D[e][f] == 0) continue;
          const Rows &x = row_[index(face, e)], &y = row_[index(face, f)];
          const size_t a = x.block[0] == face.a ? 0 : 1, b = y.block[0] == face.a ? 0 : 1;
          add_product(D[e][f], x.of[k][a], y.of[k][b], first);
          if (face.b < 0) continue;
          add_product(D[e][f], x.of[k][1 - a], y.of[k][1 - b], second);
          add_product(D[e][f], x.of[k][a], y.of[k][1 - b], *between);
        }
    }
  }
  static void add_product(double s, const Six& x, const Six& y, Tile& to) {
    for (size_t r = 0; r < 6; ++r)
      for (size_t c = 0; c < 6; ++c) to[6 * r + c] += s * x[r] * y[c];
  }

  std::vector<double> times(const std::vector<Tile>& tile, const std::vector<double>& x) const {
    std::vector<double> y(x.size());
    workers_.for_chunks(tile.size(), kChunkOfBlocks, [&](size_t begin, size_t end) {
      for (size_t b = begin; b < end; ++b)
        for (size_t r = 0; r < 6; ++r) {
          double s = 0;
          for (size_t c = 0; c < 6; ++c) s += tile[b][6 * r + c] * x[6 * b + c];
          y[6 * b + r] = s;
        }
    });
    return y;
  }

  template <class F>
  void add_forces(double sign, F impulse_of, std::vector<double>& to) const {
    for (size_t i = 0; i < row_.size(); ++i) {
      const Rows& r = row_[i];
      const Impulse p = impulse_of(i);
      for (size_t s = 0; s < 2; ++s) {
        if (r.block[s] < 0) continue;
        double* y = &to[6 * static_cast<size_t>(r.block[s])];
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
};

// Solves J x = b by generalised minimal residuals, `near` being close to J^-1.
template <class J, class P>
void minimal_residual(const Equations& with, J times, P near, const std::vector<double>& b, double residual,
                      std::vector<double>& x) {
  const double size = std::sqrt(with.product(b, b));
  x.assign(b.size(), 0);
  if (!(size > 0)) return;
  std::vector<std::vector<double>> basis{b}, turned;
  for (double& v : basis[0]) v /= size;
  std::vector<std::vector<double>> column;  // of the triangle
  std::vector<double> cosine, sine, right{size};
  size_t k = 0;
  for (; k < kMostInner; ++k) {
    turned.push_back(basis[k]);
    near(turned[k]);
    std::vector<double> w = times(turned[k]);
    std::vector<double> h(k + 2);
    for (size_t i = 0; i <= k; ++i) {
      h[i] = with.product(w, basis[i]);
      for (size_t j = 0; j < w.size(); ++j) w[j] -= h[i] * basis[i][j];
    }
    h[k + 1] = std::sqrt(with.product(w, w));
    const double last = h[k + 1];
    for (size_t i = 0; i < k; ++i) {
      const double t = cosine[i] * h[i] + sine[i] * h[i + 1];
      h[i + 1] = cosine[i] * h[i + 1] - sine[i] * h[i];
      h[i] = t;
    }
    const double r = std::hypot(h[k], h[k + 1]);
    cosine.push_back(h[k] / r), sine.push_back(h[k + 1] / r);
    h[k] = r;
    column.push_back(std::move(h));
    right.push_back(-sine[k] * right[k]), right[k] *= cosine[k];
    if (!(std::abs(right[k + 1]) > residual * size) || !(last > 0)) {
      ++k;
      break;
    }
    for (double& v : w) v /= last;
    basis.push_back(std::move(w));
  }
  std::vector<double> y(k);
  for (size_t i = k; i-- > 0;) {
    double t = right[i];
    for (size_t j = i + 1; j < k; ++j) t -= column[j][i] * y[j];
    y[i] = t / column[i][i];
  }
  for (size_t i = 0; i < k; ++i)
    for (size_t j = 0; j < x.size(); ++j) x[j] += y[i] * turned[i][j];
}

// Adds the longest of the halved steps that brings the square of the residual down, or the one that leaves the least.
void go(Equations& equations, double square, const std::vector<double>& step, std::vector<double>& v) {
  const std::vector<double> from = v;
  const auto take = [&](double share) {
    for (size_t i = 0; i < v.size(); ++i) v[i] = from[i] + share * step[i];
  };
  double best = 1, least = std::numeric_limits<double>::infinity(), share = 1;
  for (int halved = 0; halved < kMostHalved; ++halved, share *= 0.5) {
    take(share);
    const double now = equations.square(equations.residual(v, nullptr));
    if (now < least) least = now, best = share;
    if (now < (1 - 1e-4 * share) * square) break;
  }
  take(best);
}

}  // namespace

struct PrimalNewton::Kept {
  GaussSeidel sweeps;
  BlockFactor factor;
};

PrimalNewton::PrimalNewton() : kept_(std::make_unique<Kept>()) {}
PrimalNewton::~PrimalNewton() = default;

SolveReport PrimalNewton::solve(const StepProblem& problem, const SolverGoal& goal, const SolverInput& limits,
                                const Workers& workers) {
  SolveReport report;
  if (!problem.from_rest) {
    SolverInput few = limits;
    few.max_sweeps = std::min(limits.max_sweeps, kSweepsFirst);
    report = kept_->sweeps.solve(problem, goal, few, workers);
    if (report.converged) return report;
    report.iterations = 0;
  }
  const InPart part(problem.profile, Profile::kNewton);
  Equations equations(problem, workers);
  BlockFactor& factor = kept_->factor;
  factor.analyse(equations.pairs(), equations.places());
  std::vector<Tile> diagonal, beside;
  bool factored = false;

  std::vector<double> v = equations.start();
  std::vector<FaceTangent> tangent, of_factor;
  ContactError best;
  best.worst = std::numeric_limits<double>::infinity();
  if (report.judged) best = *report.judged;
  std::vector<Impulse> best_impulse = problem.rows.impulse;
  double before = std::numeric_limits<double>::infinity();
  int idle = 0;
  const auto judge = [&] {
    problem.rate = problem.rate_free;
    apply_impulses(problem.mobility, problem.rows, problem.rate);
    return contact_error(problem.mobility, problem.rows, problem.rate, problem.dt, workers);
  };
  for (;; ++report.iterations) {
    // the first time as if what sweeps have opened, closed and brought to slip were so: their velocities say nothing yet
    // of impulses, as joints give little
    const bool first = report.iterations == 0 && !problem.from_rest;
    std::vector<double> F = equations.residual(v, &tangent, first);
    if (!first) {
      const ContactError error = judge();
      if (std::isnan(error.worst)) break;
      if (error.worst < best.worst) best = error, best_impulse = problem.rows.impulse;
      report.converged = best.worst <= goal.enough;
      if (best.worst <= goal.wanted) break;
      if (report.iterations == 1 && !problem.from_rest && !(error.worst <= best.worst)) {
        std::fill(v.begin(), v.end(), 0.0);  // sweeps have not come far enough
        F = equations.residual(v, &tangent);
      }
      if (equations.reach(F) <= kInner * error.worst && equations.centre())
        F = equations.residual(v, &tangent);
    }
    if (report.iterations >= limits.max_iterations) break;

    std::vector<double> down(F), step;
    for (double& x : down) x = -x;
    const auto jacobian = [&](const std::vector<double>& x) { return equations.jacobian_times(tangent, x); };
    const auto near = [&](std::vector<double>& x) { factor.solve(x, workers); };
    if (!factored || differing(tangent, of_factor) > kMostChanged) {
      equations.tiles(tangent, diagonal, beside);
      factored = factor.factorize(diagonal, beside, workers);
      if (!factored) break;
      of_factor = tangent;
    }
    minimal_residual(equations, jacobian, near, down, first ? kResidual : kRoughResidual, step);
    if (first) {
      for (size_t i = 0; i < v.size(); ++i) v[i] += step[i];
      continue;
    }
    const double square = equations.square(F);
    idle = square <= 0.25 * before ? 0 : idle + 1;
    if (idle == 0) before = square;
    if (idle > kPatience) break;
    go(equations, square, step, v);
  }
  problem.rows.impulse = std::move(best_impulse);
  report.judged = judge();
  return report;
}

}  // namespace talus
