#pragma once
// Rows laid out for sweeps four couples at a time: a couple is two points of the same two blocks, the ends of
// a face as a rule. Blocks are lines of the cache; within a colour no moving block occurs twice, so that the
// couples of a colour can be solved in any order and by any number of threads with the same bits.
// Theory: docs/theory.md 5.5.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace talus::wide {

constexpr int kLanes = 4;

/// An open bound: products with it stay numbers.
constexpr double kEndless = 1e300;

// One number of each of four couples. The compiler makes of it what the machine has: one register of AVX2 or
// two of SSE2. No product is contracted with a sum, so that both give the same bits.
using Lanes = double __attribute__((vector_size(32)));

/// Motion of a block and its answer to impulses (rows/mobility.h), in the axes of the mobility.
struct alignas(64) BlockLine {
  double rate[8] = {};                          // a.x, a.y, G'xx, G'xy, G'yx, G'yy, 1/m, unused
  double answer[8] = {0, 0, 0, 0, 0, 0, 1, 0};  // stretch[3], shear[3], cos and sin of the left axes
};

/// Contact points: normal impulse >= 0, friction without cohesion.
struct ContactLanes {
  Lanes nx, ny;          // normal
  Lanes ax, ay, bx, by;  // arms in the right axes of each block
  Lanes bias_n, bias_t;
  Lanes p_n, p_t;            // impulses
  Lanes u_nn, u_nt, u_tt;    // influence of the point on itself, without compliance
  Lanes i_nn, i_nt, i_tt;    // inverse of influence plus compliance
  Lanes slide_up, slide_dn;  // 1 / (w_nn +- mu w_nt)
  Lanes mu;
};

/// Points with any bounds: ties, faces with strength, supports.
struct TieLanes {
  Lanes nx, ny, ax, ay, bx, by, bias_n, bias_t, p_n, p_t, u_nn, u_nt, u_tt, i_nn, i_nt, i_tt;
  Lanes lower_n, upper_n;
  Lanes mu, cohesion;  // p_t lies within -+ max(0, cohesion + mu p_n)
  Lanes w_nt;          // influence of one row on the other
  Lanes r_nn, r_tt;    // of each row 1 / (influence plus compliance)
};

template <class Point>
struct alignas(64) Record {
  int32_t a[kLanes], b[kLanes];            // lines of the blocks
  int32_t into_a[kLanes], into_b[kLanes];  // where they are written: lines of still blocks are not
  Lanes cross_n, cross_t;                  // compliance with the other point's impulse
  Point point[2];
};

using ContactRecord = Record<ContactLanes>;
using TieRecord = Record<TieLanes>;

/// What of a record the sweeps do not read: compliances of its two points.
struct alignas(64) Give {
  Lanes n[2], t[2];
};

/// The largest error, and the row where: of equals the one that comes first, NaN before all else, none where it
/// is zero.
struct Worst {
  double error = 0;  // [m/s]
  int row = -1;

  Worst& operator+=(const Worst& o);
};

/// Rows of a strip of a dense matrix (block_factor.h): its columns lie one behind the other.
constexpr size_t kStripRows = 12;

/// The kernels for one kind of processor. Those of records work on [0, count) in order.
struct Kernels {
  /// Influence and inverses from normals, arms and compliances; and adds the impulses to the blocks.
  void (*prepare_contacts)(BlockLine*, const Give*, ContactRecord*, size_t count);
  void (*prepare_ties)(BlockLine*, const Give*, TieRecord*, size_t count);
  /// Solves each point with all others held; raises `largest` to the largest change of an impulse times the
  /// influence of its point on itself [m/s].
  void (*sweep_contacts)(BlockLine*, ContactRecord*, size_t count, double& largest);
  void (*sweep_ties)(BlockLine*, TieRecord*, size_t count, double& largest);
  /// |p - Proj(p - e / Wii)| Wii of the worse row of each point (eq. 5.2), from where the blocks are now.
  /// @param rows  of both points of each lane of each record [count * lanes * 2]
  void (*judge_contacts)(const BlockLine*, const ContactRecord*, const Give*, const int* rows, size_t count,
                         Worst&);
  void (*judge_ties)(const BlockLine*, const TieRecord*, const Give*, const int* rows, size_t count, Worst&);

  // Strips: twelve rows of a, b and c, column by column.
  /// c -= a b^T, where a and b have `depth` columns and c twelve.
  void (*subtract_products)(const double* a, const double* b, size_t depth, double* c);
  /// c := c d^-T, d a factor of twelve rows with the reciprocals of its diagonal on it.
  void (*divide_strip)(const double* d, double* c);
  /// y -= a x, of twelve rows and `count` columns; and x -= a^T y.
  void (*subtract_columns)(const double* a, const double* x, size_t count, double* y);
  void (*subtract_rows)(const double* a, const double* y, size_t count, double* x);
};

/// The fastest kernels that this processor runs, or the plain ones. All give the same bits.
const Kernels& best_kernels();
const Kernels& plain_kernels();
const Kernels& avx2_kernels();  // @pre the processor knows AVX2
bool has_avx2();

}  // namespace talus::wide
