#include "talus/solve/velocity_equations.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "talus/base/index.h"

namespace talus {

namespace {

// Rows that do not give at all get the share 1 / kStiff of their influence, or 1 / kBeside of what the stiffest other row of a
// block gives where that is less, about a centre that follows the impulse: what they settle at is exact.
constexpr double kStiff = 1e7, kBeside = 1e4;

constexpr size_t kChunkOfFaces = 512, kChunkOfBlocks = 512;

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

// The impulses p of C p + q = 0 where they are free, the others at their bounds. False when a bound is endless.
bool with_free(const double C[2][2], const double q[2], const Bounds bounds[2], size_t count,
               BoundedImpulses& face) {
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
BoundedImpulses within_bounds(const double C[2][2], const double q[2], const Bounds bounds[2], size_t count) {
  static constexpr int kCases[9][2] = {{0, 0},   {0, -1}, {-1, 0}, {0, 1}, {1, 0},
                                       {-1, -1}, {1, 1},  {-1, 1}, {1, -1}};
  BoundedImpulses best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& at : kCases) {
    if (count == 1 && at[1] != 0) continue;
    BoundedImpulses face{{0, 0}, {at[0], at[1]}};
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

}  // namespace

size_t differing(const std::vector<FaceTangent>& a, const std::vector<FaceTangent>& b) {
  size_t count = 0;
  for (size_t f = 0; f < a.size(); ++f)
    count +=
        std::memcmp(a[f].n, b[f].n, sizeof a[f].n) != 0 || std::memcmp(a[f].t, b[f].t, sizeof a[f].t) != 0;
  return count;
}

VelocityEquations::VelocityEquations(const StepProblem& problem, const Workers& workers)
    : problem_(problem), workers_(workers) {
  number_blocks();
  number_faces();
  const size_t points = problem.rows.size();
  row_.resize(points), prox_.resize(points), centre_.resize(points), bias_.resize(points);
  find_least_give();
  workers.for_chunks(points, kChunkOfFaces, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) add_row(i);
  });
}

std::vector<double> VelocityEquations::start() {
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

std::vector<double> VelocityEquations::residual(const std::vector<double>& v,
                                                std::vector<FaceTangent>* tangent, bool keep) {
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

double VelocityEquations::reach(const std::vector<double>& F) const {
  const std::vector<double> v = times(inverse_, F);
  double most = 0;
  for (size_t i = 0; i < row_.size(); ++i)
    for (size_t k = 0; k < 2; ++k) most = std::max(most, std::abs(along(i, k, v)));
  return most * problem_.dt;
}

double VelocityEquations::product(const std::vector<double>& x, const std::vector<double>& y) const {
  return workers_.sum_chunks<double>(x.size(), 6 * kChunkOfBlocks,
                                     [&](size_t begin, size_t end, double& sum) {
                                       for (size_t i = begin; i < end; ++i) sum += x[i] * y[i];
                                     });
}

bool VelocityEquations::centre() {
  bool moved = false;
  for (size_t i = 0; i < prox_.size(); ++i)
    for (size_t k = 0; k < 2; ++k) {
      if (prox_[i][k] == 0 || centre_[i][k] == problem_.rows.impulse[i][k]) continue;
      centre_[i][k] = problem_.rows.impulse[i][k];
      moved = true;
    }
  return moved;
}

std::vector<double> VelocityEquations::jacobian_times(const std::vector<FaceTangent>& tangent,
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

void VelocityEquations::tiles(const std::vector<FaceTangent>& tangent, std::vector<Tile>& diagonal,
                              std::vector<Tile>& beside) const {
  diagonal = mass_;
  beside.assign(pairs_.size(), Tile{});
  std::vector<std::array<Tile, 2>> own(couple_begin_.size() - 1);
  workers_.for_chunks(own.size(), 64, [&](size_t begin, size_t end) {
    for (size_t c = begin; c < end; ++c) {
      own[c][0].fill(0), own[c][1].fill(0);
      Tile* between = couple_pair_[c] < 0 ? nullptr : &beside[couple_pair_[c]];
      for (size_t f = couple_begin_[c]; f < couple_begin_[c + 1]; ++f)
        add_face(faces_[f], tangent[f], own[c][0], own[c][1], between);
    }
  });
  for (size_t c = 0; c < own.size(); ++c) {
    const Face& face = faces_[couple_begin_[c]];
    for (size_t k = 0; k < 36; ++k) {
      if (face.a >= 0) diagonal[face.a][k] += own[c][0][k];
      if (face.b >= 0) diagonal[face.b][k] += own[c][1][k];
    }
  }
}

std::vector<Vec2> VelocityEquations::places() const {
  std::vector<Vec2> place(moving_.size());
  std::vector<std::vector<std::pair<int, Vec2>>> near(moving_.size());
  for (size_t c = 0; c + 1 < couple_begin_.size(); ++c) {
    const Face& face = faces_[couple_begin_[c]];
    if (face.a < 0 || face.b < 0) continue;
    const PointRows& p = problem_.rows.points[index(face, 0)];
    Vec2 from_a_to_b = p.arm_a - p.arm_b;
    if (number_[p.block_a] != face.a) from_a_to_b = -1.0 * from_a_to_b;
    near[face.a].emplace_back(face.b, from_a_to_b);
    near[face.b].emplace_back(face.a, -1.0 * from_a_to_b);
  }
  std::vector<char> known(moving_.size(), 0);
  std::vector<size_t> next;
  for (size_t first = 0; first < place.size(); ++first) {
    if (known[first]) continue;
    known[first] = 1, next = {first};
    for (size_t i = 0; i < next.size(); ++i)
      for (const auto& [b, step] : near[next[i]]) {
        if (known[b]) continue;
        known[b] = 1, place[b] = place[next[i]] + step, next.push_back(b);
      }
  }
  return place;
}

std::vector<double> VelocityEquations::unknowns(const std::vector<BlockRate>& rate) const {
  std::vector<double> v(6 * moving_.size());
  for (size_t k = 0; k < moving_.size(); ++k) put(v, k, to_unknowns(mobility(k), rate[moving_[k]]));
  return v;
}

void VelocityEquations::number_blocks() {
  number_.assign(problem_.mobility.size(), -1);
  for (size_t i = 0; i < number_.size(); ++i)
    if (problem_.mobility[i].moves()) number_[i] = count_of(moving_), moving_.push_back(i);
  mass_.resize(moving_.size()), inverse_.resize(moving_.size()), free_.resize(6 * moving_.size());
  for (size_t k = 0; k < moving_.size(); ++k) {
    mass_tiles(mobility(k), mass_[k], inverse_[k]);
    put(free_, k, to_unknowns(mobility(k), problem_.rate_free[moving_[k]]));
  }
}

void VelocityEquations::number_faces() {
  const std::vector<PointRows>& points = problem_.rows.points;
  for (int i = 0; i < count_of(problem_.rows); ++i) {
    const PointRows& p = points[i];
    if (p.partner >= 0 && p.partner < i) continue;
    const int a = number(p.block_a), b = number(p.block_b);
    if (a < 0 && b < 0) continue;
    Face f;
    f.point[0] = i, f.point[1] = p.partner;
    f.a = a < 0 ? b : b < 0 ? a : std::min(a, b), f.b = a < 0 || b < 0 ? -1 : std::max(a, b);
    faces_.push_back(f);
  }
  std::sort(faces_.begin(), faces_.end(), [](const Face& f, const Face& g) {
    return f.a != g.a ? f.a < g.a : f.b != g.b ? f.b < g.b : f.point[0] < g.point[0];
  });
  for (size_t f = 0; f < faces_.size(); ++f) {
    if (f > 0 && faces_[f].a == faces_[f - 1].a && faces_[f].b == faces_[f - 1].b) continue;
    couple_begin_.push_back(f);
    couple_pair_.push_back(faces_[f].b < 0 ? -1 : count_of(pairs_));
    if (faces_[f].b >= 0) pairs_.push_back({faces_[f].a, faces_[f].b});
  }
  couple_begin_.push_back(faces_.size());
}

void VelocityEquations::find_least_give() {
  least_give_.assign(moving_.size(), std::numeric_limits<double>::infinity());
  for (const PointRows& p : problem_.rows.points)
    for (const int block : {p.block_a, p.block_b})
      for (const Row& row : p.row) {
        const int b = number(block);
        if (b < 0 || row.compliance <= 0) continue;
        double& least = least_give_[b];
        least = std::min(least, row.compliance);
      }
}

void VelocityEquations::add_row(size_t i) {
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
          bias_[i][k] += sign * talus::dot(axis[k], velocity_at(problem_.rate_free[block[s]], arm[s]));
        continue;
      }
      const int b = r.block[s];
      Six x = coefficients(mobility(b), axis[k], arm[s]);
      for (double& c : x) c *= sign;
      r.of[k][s] = x;
      for (size_t m = 0; m < 6; ++m)
        for (size_t n = 0; n < 6; ++n) influence += x[m] * inverse_[b][6 * m + n] * x[n];
    }
    double own = influence / kStiff;
    for (const int b : r.block)
      if (b >= 0) own = std::min(own, least_give_[b] / kBeside);
    prox_[i][k] = p.row[k].compliance > 0 ? 0 : own;
    centre_[i][k] = problem_.rows.impulse[i][k];
  }
}

double VelocityEquations::along(size_t i, size_t k, const std::vector<double>& v) const {
  const Rows& r = row_[i];
  double u = 0;
  for (size_t s = 0; s < 2; ++s)
    if (r.block[s] >= 0) u += dot(r.of[k][s], &v[6 * r.block[s]]);
  return u;
}

BoundedImpulses VelocityEquations::standing(const Face& face, size_t k, const Bounds bounds[2]) const {
  BoundedImpulses result;
  for (size_t e = 0; e < face.count(); ++e) {
    const double p = problem_.rows.impulse[index(face, e)][k];
    // sweeps put a sliding impulse at its bound to some digits only
    const double near = k == 1 ? 1e-8 * bounds[e].upper : 0;
    result.at[e] = p <= bounds[e].lower + near ? -1 : p >= bounds[e].upper - near ? 1 : 0;
  }
  return result;
}

void VelocityEquations::push_face(const Face& face, const std::vector<double>& v, bool keep,
                                  FaceTangent* tangent) {
  const size_t count = face.count();
  double C[2][2][2] = {}, q[2][2] = {};
  Bounds bounds[2] = {};
  for (size_t e = 0; e < count; ++e) {
    const size_t i = index(face, e);
    const PointRows& p = problem_.rows.points[i];
    for (int k = 0; k < 2; ++k) {
      C[k][e][e] = soft_ * p.row[k].compliance + prox_[i][k];
      if (count > 1) C[k][e][1 - e] = soft_ * p.cross(k);
      q[k][e] = along(i, k, v) + bias_[i][k] - prox_[i][k] * centre_[i][k];
    }
    bounds[e] = bounds_of(p, 0, 0);
  }
  BoundedImpulses n, t;
  if (keep) {
    Bounds cone[2] = {};
    for (size_t e = 0; e < count; ++e)
      cone[e] = bounds_of(problem_.rows.points[index(face, e)], 1, problem_.rows.impulse[index(face, e)][0]);
    n = standing(face, 0, bounds), t = standing(face, 1, cone);
  }
  if (!keep || !with_free(C[0], q[0], bounds, count, n)) n = within_bounds(C[0], q[0], bounds, count);
  for (size_t e = 0; e < count; ++e) {
    const size_t i = index(face, e);
    bounds[e] = bounds_of(problem_.rows.points[i], 1, pressed_.empty() ? n.p[e] : pressed_[i]);
  }
  if (!keep || !with_free(C[1], q[1], bounds, count, t)) t = within_bounds(C[1], q[1], bounds, count);
  for (size_t e = 0; e < count; ++e) problem_.rows.impulse[index(face, e)] = {n.p[e], t.p[e]};
  if (!tangent) return;
  invert_free(C[0], n.at, count, tangent->n);
  invert_free(C[1], t.at, count, tangent->t);
  if (!pressed_.empty()) return;
  // a sliding end follows its normal impulse, and a partner that sticks yields to it
  for (size_t e = 0; e < count; ++e) {
    if (t.at[e] == 0 || bounds[e].upper <= 0 || std::isinf(bounds[e].upper)) continue;
    const double share = t.at[e] * problem_.rows.points[index(face, e)].friction;
    tangent->slide[e][e] = share;
    if (count > 1 && t.at[1 - e] == 0)
      tangent->slide[1 - e][e] = -C[1][1 - e][e] / C[1][1 - e][1 - e] * share;
  }
}

void VelocityEquations::add_face(const Face& face, const FaceTangent& d, Tile& first, Tile& second,
                                 Tile* between) const {
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

std::vector<double> VelocityEquations::times(const std::vector<Tile>& tile,
                                             const std::vector<double>& x) const {
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

}  // namespace talus
