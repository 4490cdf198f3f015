// The sweep over wide records. Included once by each file that is compiled for one kind of processor; all in
// a nameless namespace, so that no two of them share a function.

#ifdef __FMA__
#include <immintrin.h>
#endif

#include <cmath>
#include <limits>

#include "talus/solve/wide.h"

namespace talus::wide {

namespace {

using Mask = int64_t __attribute__((vector_size(32)));

constexpr double kMost = std::numeric_limits<double>::max(),
                 kLeast = std::numeric_limits<double>::denorm_min();

inline Lanes all(double v) { return Lanes{v, v, v, v}; }
// x y + z, rounded once; and z - x y.
#ifdef __FMA__
inline Lanes madd(Lanes x, Lanes y, Lanes z) { return _mm256_fmadd_pd(x, y, z); }
inline Lanes nmadd(Lanes x, Lanes y, Lanes z) { return _mm256_fnmadd_pd(x, y, z); }
#else
inline Lanes madd(Lanes x, Lanes y, Lanes z) {
  for (int l = 0; l < kLanes; ++l) z[l] = std::fma(x[l], y[l], z[l]);
  return z;
}
inline Lanes nmadd(Lanes x, Lanes y, Lanes z) { return madd(-x, y, z); }
#endif
inline Lanes larger(Lanes x, Lanes y) { return x > y ? x : y; }
inline Lanes smaller(Lanes x, Lanes y) { return x < y ? x : y; }
inline Lanes size(Lanes x) {
  return reinterpret_cast<Lanes>(reinterpret_cast<Mask>(x) &
                                 Mask{INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX});
}

// Four numbers of each of four places, as lanes; and back.
inline void load(const double* p0, const double* p1, const double* p2, const double* p3, Lanes out[4]) {
  const Lanes r0 = *reinterpret_cast<const Lanes*>(p0), r1 = *reinterpret_cast<const Lanes*>(p1),
              r2 = *reinterpret_cast<const Lanes*>(p2), r3 = *reinterpret_cast<const Lanes*>(p3);
  const Lanes t0 = __builtin_shufflevector(r0, r1, 0, 4, 2, 6),
              t1 = __builtin_shufflevector(r0, r1, 1, 5, 3, 7),
              t2 = __builtin_shufflevector(r2, r3, 0, 4, 2, 6),
              t3 = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);
  out[0] = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
  out[1] = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
  out[2] = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
  out[3] = __builtin_shufflevector(t1, t3, 2, 3, 6, 7);
}

inline void store(const Lanes in[4], double* p0, double* p1, double* p2, double* p3) {
  const Lanes t0 = __builtin_shufflevector(in[0], in[1], 0, 4, 2, 6),
              t1 = __builtin_shufflevector(in[0], in[1], 1, 5, 3, 7),
              t2 = __builtin_shufflevector(in[2], in[3], 0, 4, 2, 6),
              t3 = __builtin_shufflevector(in[2], in[3], 1, 5, 3, 7);
  *reinterpret_cast<Lanes*>(p0) = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
  *reinterpret_cast<Lanes*>(p1) = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
  *reinterpret_cast<Lanes*>(p2) = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
  *reinterpret_cast<Lanes*>(p3) = __builtin_shufflevector(t1, t3, 2, 3, 6, 7);
}

// Four blocks, one in each lane.
struct Four {
  Lanes v[8];  // as BlockLine::rate
  Lanes k[8];  // as BlockLine::answer

  Four(const BlockLine* lines, const int32_t* id) {
    const BlockLine &l0 = lines[id[0]], &l1 = lines[id[1]], &l2 = lines[id[2]], &l3 = lines[id[3]];
    load(l0.rate, l1.rate, l2.rate, l3.rate, v);
    load(l0.rate + 4, l1.rate + 4, l2.rate + 4, l3.rate + 4, v + 4);
    load(l0.answer, l1.answer, l2.answer, l3.answer, k);
    load(l0.answer + 4, l1.answer + 4, l2.answer + 4, l3.answer + 4, k + 4);
  }
  void write(BlockLine* lines, const int32_t* id) const {
    BlockLine &l0 = lines[id[0]], &l1 = lines[id[1]], &l2 = lines[id[2]], &l3 = lines[id[3]];
    store(v, l0.rate, l1.rate, l2.rate, l3.rate);
    store(v + 4, l0.rate + 4, l1.rate + 4, l2.rate + 4, l3.rate + 4);
  }
  // velocity of the point at arm (x, y), along the axes of the plane
  void velocity(Lanes x, Lanes y, Lanes& vx, Lanes& vy) const {
    const Lanes wx = madd(v[2], x, v[3] * y), wy = madd(v[4], x, v[5] * y);
    vx = madd(k[6], wx, nmadd(k[7], wy, v[0]));
    vy = madd(k[7], wx, madd(k[6], wy, v[1]));
  }
  // answer to the impulse (fx, fy) at arm (x, y)
  void push(Lanes x, Lanes y, Lanes fx, Lanes fy) {
    const Lanes gx = madd(k[6], fx, k[7] * fy), gy = nmadd(k[7], fx, k[6] * fy);
    const Lanes qxx = gx * x, qxy = gx * y, qyx = gy * x, qyy = gy * y;
    v[0] = madd(v[6], fx, v[0]);
    v[1] = madd(v[6], fy, v[1]);
    v[2] = madd(k[0], qxx, madd(k[1], qyy, v[2]));
    v[3] = madd(k[3], qxy, madd(k[4], qyx, v[3]));
    v[4] = madd(k[4], qxy, madd(k[5], qyx, v[4]));
    v[5] = madd(k[1], qxx, madd(k[2], qyy, v[5]));
  }
  // adds n . w n, n . w t, t . w t of the block's influence w of the arm on itself, t = n turned clockwise
  // (eq. 1.3)
  void influence(Lanes x, Lanes y, Lanes nx, Lanes ny, Lanes& nn, Lanes& nt, Lanes& tt) const {
    const Lanes ex = madd(k[6], nx, k[7] * ny), ey = nmadd(k[7], nx, k[6] * ny);
    const Lanes xx = x * x, xy = x * y, yy = y * y, exx = ex * ex, exy = ex * ey, eyy = ey * ey;
    const Lanes wxx = madd(k[0], xx, madd(k[3], yy, v[6])), wxy = (k[1] + k[4]) * xy,
                wyy = madd(k[2], yy, madd(k[5], xx, v[6]));
    const Lanes twice = (exy + exy) * wxy;
    nn += madd(exx, wxx, madd(eyy, wyy, twice));
    nt += madd(exy, wxx - wyy, (eyy - exx) * wxy);
    tt += madd(eyy, wxx, madd(exx, wyy, -twice));
  }
};

template <class Point>
inline void push_point(Four& a, Four& b, const Point& p, Lanes d_n, Lanes d_t) {
  const Lanes fx = madd(d_n, p.nx, d_t * p.ny), fy = nmadd(d_t, p.nx, d_n * p.ny);
  a.push(p.ax, p.ay, fx, fy);
  b.push(p.bx, p.by, -fx, -fy);
}

// Impulses of a point that satisfy its laws when the residual at zero impulse is (q_n, q_t) (theory 5.5).
inline void solve_point(const ContactLanes& p, Lanes q_n, Lanes q_t, Lanes& n, Lanes& t) {
  const Lanes zero{};
  const Lanes stick_n = -madd(p.i_nn, q_n, p.i_nt * q_t), stick_t = -madd(p.i_nt, q_n, p.i_tt * q_t);
  const auto sticks = (stick_n > zero) & (size(stick_t) <= p.mu * stick_n);
  // where it slides it does so the way it would have been held from
  const Lanes slide_n = larger(-q_n * (stick_t > zero ? p.slide_up : p.slide_dn), zero);
  const Lanes limit = p.mu * slide_n;
  n = sticks ? stick_n : slide_n;
  t = sticks ? stick_t : (stick_t > zero ? limit : -limit);
}

inline void solve_point(const TieLanes& p, Lanes q_n, Lanes q_t, Lanes& n, Lanes& t) {
  const Lanes stick_n = -madd(p.i_nn, q_n, p.i_nt * q_t), stick_t = -madd(p.i_nt, q_n, p.i_tt * q_t);
  // rounded as bounds_of() does it
  const auto cone = [&](Lanes x) { return larger(p.mu * x + p.cohesion, Lanes{}); };
  const auto holds = (stick_n >= p.lower_n) & (stick_n <= p.upper_n) & (size(stick_t) <= cone(stick_n));
  // elsewhere one row after the other
  const Lanes one_n = larger(smaller(-madd(p.w_nt, p.p_t, q_n) * p.r_nn, p.upper_n), p.lower_n);
  const Lanes limit = cone(one_n);
  const Lanes one_t = larger(smaller(-madd(p.w_nt, one_n, q_t) * p.r_tt, limit), -limit);
  n = holds ? stick_n : one_n;
  t = holds ? stick_t : one_t;
}

template <class Point>
inline void sweep_records(BlockLine* lines, Record<Point>* records, size_t count, double& most) {
  Lanes largest{};
  for (size_t r = 0; r < count; ++r) {
    Record<Point>& record = records[r];
    Four a(lines, record.a), b(lines, record.b);
    for (int i = 0; i < 2; ++i) {
      Point& p = record.point[i];
      const Point& other = record.point[1 - i];
      Lanes ax, ay, bx, by;
      a.velocity(p.ax, p.ay, ax, ay);
      b.velocity(p.bx, p.by, bx, by);
      const Lanes dx = ax - bx, dy = ay - by;
      // what the blocks say comes last: all else is there before
      const Lanes rest_n =
                      nmadd(p.u_nn, p.p_n, nmadd(p.u_nt, p.p_t, madd(record.cross_n, other.p_n, p.bias_n))),
                  rest_t =
                      nmadd(p.u_nt, p.p_n, nmadd(p.u_tt, p.p_t, madd(record.cross_t, other.p_t, p.bias_t)));
      const Lanes q_n = madd(p.nx, dx, madd(p.ny, dy, rest_n)), q_t = nmadd(p.nx, dy, madd(p.ny, dx, rest_t));
      Lanes n, t;
      solve_point(p, q_n, q_t, n, t);
      const Lanes d_n = n - p.p_n, d_t = t - p.p_t;
      p.p_n = n, p.p_t = t;
      largest = larger(largest, larger(size(d_n) * p.u_nn, size(d_t) * p.u_tt));
      push_point(a, b, p, d_n, d_t);
    }
    a.write(lines, record.into_a);
    b.write(lines, record.into_b);
  }
  for (int l = 0; l < kLanes; ++l) most = largest[l] > most ? largest[l] : most;
}

// Influence of each point on itself, and the inverse with its compliance.
template <class Point>
inline void measure(const Four& a, const Four& b, Lanes c_n, Lanes c_t, Point& p, Lanes& w_nn, Lanes& w_nt,
                    Lanes& w_tt) {
  Lanes nn{}, nt{}, tt{};
  a.influence(p.ax, p.ay, p.nx, p.ny, nn, nt, tt);
  b.influence(p.bx, p.by, p.nx, p.ny, nn, nt, tt);
  w_nn = nn + c_n, w_tt = tt + c_t;
  // where friction would turn the sign of the normal law (a steep arm), or nothing is left of the
  // determinant, the two rows are solved as if apart: sweeps come to the same end
  const auto apart = (p.mu * size(nt) > all(0.9) * w_nn) | (nt * nt > all(0.999) * w_nn * w_tt);
  nt = apart ? Lanes{} : nt;
  w_nt = nt;
  p.u_nn = nn, p.u_nt = nt, p.u_tt = tt;
  const Lanes one = all(1) / nmadd(nt, nt, w_nn * w_tt);
  p.i_nn = w_tt * one, p.i_nt = -nt * one, p.i_tt = w_nn * one;
}

inline void measure_point(const Four& a, const Four& b, Lanes c_n, Lanes c_t, ContactLanes& p) {
  Lanes w_nn, w_nt, w_tt;
  measure(a, b, c_n, c_t, p, w_nn, w_nt, w_tt);
  p.slide_up = all(1) / madd(p.mu, w_nt, w_nn);
  p.slide_dn = all(1) / nmadd(p.mu, w_nt, w_nn);
}
inline void measure_point(const Four& a, const Four& b, Lanes c_n, Lanes c_t, TieLanes& p) {
  Lanes w_nn, w_tt;
  measure(a, b, c_n, c_t, p, w_nn, p.w_nt, w_tt);
  p.r_nn = all(1) / w_nn, p.r_tt = all(1) / w_tt;
}

template <class Point>
inline void prepare_records(BlockLine* lines, const Give* give, Record<Point>* records, size_t count) {
  for (size_t r = 0; r < count; ++r) {
    Record<Point>& record = records[r];
    Four a(lines, record.a), b(lines, record.b);
    for (int i = 0; i < 2; ++i) {
      Point& p = record.point[i];
      measure_point(a, b, give[r].n[i], give[r].t[i], p);
      push_point(a, b, p, p.p_n, p.p_t);
    }
    a.write(lines, record.into_a);
    b.write(lines, record.into_b);
  }
}

void prepare_contacts(BlockLine* l, const Give* g, ContactRecord* r, size_t count) {
  prepare_records(l, g, r, count);
}
void prepare_ties(BlockLine* l, const Give* g, TieRecord* r, size_t count) {
  prepare_records(l, g, r, count);
}

struct Limits {
  Lanes lower, upper;
};
inline Limits normal_limits(const ContactLanes&) { return {Lanes{}, all(kEndless)}; }
inline Limits normal_limits(const TieLanes& p) { return {p.lower_n, p.upper_n}; }
inline Limits tangential_limits(const ContactLanes& p) {
  const Lanes limit = larger(p.mu * p.p_n, Lanes{});
  return {-limit, limit};
}
inline Limits tangential_limits(const TieLanes& p) {
  const Lanes limit = larger(p.mu * p.p_n + p.cohesion, Lanes{});
  return {-limit, limit};
}

// |p - Proj(p - e / w)| w, without the division.
inline Lanes missed(Lanes p, Lanes e, Lanes w, const Limits& limits) {
  return size(larger(smaller(e, w * (p - limits.lower)), w * (p - limits.upper)));
}

// Eq. 5.2.
template <class Point>
inline void judge_records(const BlockLine* lines, const Record<Point>* records, const Give* give,
                          const int* rows, size_t count, Worst& worst) {
  for (size_t r = 0; r < count; ++r) {
    const Record<Point>& record = records[r];
    const Four a(lines, record.a), b(lines, record.b);
    for (int i = 0; i < 2; ++i) {
      const Point &p = record.point[i], &other = record.point[1 - i];
      const Lanes c_n = give[r].n[i], c_t = give[r].t[i];
      Lanes ax, ay, bx, by;
      a.velocity(p.ax, p.ay, ax, ay);
      b.velocity(p.bx, p.by, bx, by);
      const Lanes dx = ax - bx, dy = ay - by;
      const Lanes e_n = p.nx * dx + p.ny * dy + p.bias_n + c_n * p.p_n + record.cross_n * other.p_n,
                  e_t = p.ny * dx - p.nx * dy + p.bias_t + c_t * p.p_t + record.cross_t * other.p_t;
      const Lanes here = larger(missed(p.p_n, e_n, p.u_nn + c_n, normal_limits(p)),
                                missed(p.p_t, e_t, p.u_tt + c_t, tangential_limits(p)));
      // written so that what is no number is looked at; most points are passed over
      const Lanes known = larger(all(worst.error), all(kLeast));
      const auto fine = (here < known) & (size(e_n) + size(e_t) <= all(kMost));
      if (fine[0] & fine[1] & fine[2] & fine[3]) continue;
      for (int l = 0; l < kLanes; ++l) {
        const bool number = std::isfinite(e_n[l]) && std::isfinite(e_t[l]) && std::isfinite(here[l]);
        worst += {number ? here[l] : std::nan(""), rows[(r * kLanes + l) * 2 + i]};
      }
    }
  }
}

void judge_contacts(const BlockLine* l, const ContactRecord* r, const Give* g, const int* rows, size_t count,
                    Worst& worst) {
  judge_records(l, r, g, rows, count, worst);
}
void judge_ties(const BlockLine* l, const TieRecord* r, const Give* g, const int* rows, size_t count,
                Worst& worst) {
  judge_records(l, r, g, rows, count, worst);
}

void sweep_contacts(BlockLine* l, ContactRecord* r, size_t count, double& s) {
  sweep_records(l, r, count, s);
}
void sweep_ties(BlockLine* l, TieRecord* r, size_t count, double& s) { sweep_records(l, r, count, s); }

// Strips need not begin at a line of the cache.
using LooseLanes = double __attribute__((vector_size(32), aligned(8)));
inline Lanes read(const double* p) { return *reinterpret_cast<const LooseLanes*>(p); }
inline void write(double* p, Lanes v) { *reinterpret_cast<LooseLanes*>(p) = v; }

constexpr size_t kParts = kStripRows / kLanes;  // registers of a column

void subtract_products(const double* a, const double* b, size_t depth, double* c) {
  for (size_t first = 0; first < kStripRows; first += kLanes) {
    double* to = c + kStripRows * first;
    Lanes sum[kLanes][kParts];
    for (size_t j = 0; j < kLanes; ++j)
      for (size_t i = 0; i < kParts; ++i) sum[j][i] = read(to + kStripRows * j + kLanes * i);
    for (size_t k = 0; k < depth; ++k) {
      const double *x = a + kStripRows * k, *y = b + kStripRows * k + first;
      const Lanes x0 = read(x), x1 = read(x + kLanes), x2 = read(x + 2 * kLanes);
      for (size_t j = 0; j < kLanes; ++j) {
        const Lanes s = all(y[j]);
        sum[j][0] = nmadd(x0, s, sum[j][0]);
        sum[j][1] = nmadd(x1, s, sum[j][1]);
        sum[j][2] = nmadd(x2, s, sum[j][2]);
      }
    }
    for (size_t j = 0; j < kLanes; ++j)
      for (size_t i = 0; i < kParts; ++i) write(to + kStripRows * j + kLanes * i, sum[j][i]);
  }
}

void divide_strip(const double* d, double* c) {
  for (size_t j = 0; j < kStripRows; ++j) {
    double* to = c + kStripRows * j;
    Lanes x[kParts] = {read(to), read(to + kLanes), read(to + 2 * kLanes)};
    for (size_t k = 0; k < j; ++k) {
      const Lanes s = all(d[kStripRows * k + j]);
      for (size_t i = 0; i < kParts; ++i) x[i] = nmadd(read(c + kStripRows * k + kLanes * i), s, x[i]);
    }
    for (size_t i = 0; i < kParts; ++i) write(to + kLanes * i, x[i] * all(d[kStripRows * j + j]));
  }
}

void subtract_columns(const double* a, const double* x, size_t count, double* y) {
  Lanes sum[kParts] = {read(y), read(y + kLanes), read(y + 2 * kLanes)};
  for (size_t k = 0; k < count; ++k) {
    const Lanes s = all(x[k]);
    for (size_t i = 0; i < kParts; ++i) sum[i] = nmadd(read(a + kStripRows * k + kLanes * i), s, sum[i]);
  }
  for (size_t i = 0; i < kParts; ++i) write(y + kLanes * i, sum[i]);
}

void subtract_rows(const double* a, const double* y, size_t count, double* x) {
  const Lanes y0 = read(y), y1 = read(y + kLanes), y2 = read(y + 2 * kLanes);
  for (size_t k = 0; k < count; ++k) {
    const double* column = a + kStripRows * k;
    const Lanes s = madd(read(column + 2 * kLanes), y2, madd(read(column + kLanes), y1, read(column) * y0));
    x[k] -= (s[0] + s[1]) + (s[2] + s[3]);
  }
}

constexpr Kernels make_kernels() {
  return {prepare_contacts, prepare_ties,      sweep_contacts, sweep_ties,       judge_contacts,
          judge_ties,       subtract_products, divide_strip,   subtract_columns, subtract_rows};
}

}  // namespace

}  // namespace talus::wide
