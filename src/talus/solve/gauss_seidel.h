#pragma once
// Projected Gauss-Seidel on the rows: point by point with normal and tangential together, couple by couple in
// the order of graph colours, four couples at a time, by any number of threads with the same bits.
// Theory: docs/theory.md 5.5.

#include <array>

#include "talus/solve/solver.h"
#include "talus/solve/wide.h"

namespace talus {

/// Keeps its layout from step to step for as long as the same points join the same blocks.
class GaussSeidel : public Solver {
 public:
  /// Which kernels to run; for tests of one against the other.
  explicit GaussSeidel(const wide::Kernels& kernels = wide::best_kernels()) : kernels_(&kernels) {}

  /// At most limits.max_sweeps sweeps.
  SolveReport solve(const StepProblem& problem, const SolverGoal& goal, const SolverInput& limits,
                    const Workers& workers) override;

 private:
  struct Point {
    int block_a, block_b;  // the lower block first
    unsigned link;         // twice the partner plus one, plus one for a tie
    int partner() const { return static_cast<int>(link >> 1U) - 1; }
    bool tie() const { return link & 1U; }
    friend bool operator==(const Point&, const Point&) = default;
  };
  struct Rows {
    int row[2];
  };
  // records of one colour of a tile, or of the couples between tiles: [contact_begin, contact_end) and the same
  // of ties
  struct Colour {
    size_t contact_begin = 0, contact_end = 0, tie_begin = 0, tie_end = 0;
    bool in_order = false;  // blocks may occur twice: one thread, record by record
  };

  bool layout_holds(const RowSet& set, const Workers& workers);
  void lay_out(const std::vector<Mobility>& mobility, std::span<const int> tile, const Workers& workers);
  struct Plan;
  const Point& at(int row) const { return seen_[row]; }
  bool has_tie(const Rows& couple) const;
  std::vector<Rows> couples() const;
  void part_couples(const std::vector<Mobility>& mobility, std::span<const int> tile, Plan& plan) const;
  void give_colours(const std::vector<Mobility>& mobility, const Workers& workers, Plan& plan) const;
  void place_rows(const Workers& workers, Plan& plan);
  void place_blocks(const std::vector<Mobility>& mobility, const Workers& workers);
  void order_lines(std::span<const int> tile, size_t tiles);
  int most_colours() const;
  /// contact(begin, end, largest) and tie(begin, end, largest) over all records in the order of colours: tiles side
  /// by side, then the couples between them, each colour side by side. Returns the largest of all.
  template <class F, class G>
  double in_colours(const Workers& workers, F contact, G tie) const;
  void write_lines(const std::vector<Mobility>& mobility, const std::vector<BlockRate>& rate,
                   const Workers& workers);
  void read_lines(const StepProblem& problem, const Workers& workers) const;
  /// And lets their impulses act on the lines.
  void write_records(const std::vector<Mobility>& mobility, const RowSet& set, const Workers& workers);
  void read_records(const Workers& workers, RowSet& set) const;
  double sweep(const Workers& workers);
  ContactError judge(const Workers& workers) const;
  void keep(const Workers& workers);
  void extrapolate(const Workers& workers, bool first);

  const wide::Kernels* kernels_;
  std::vector<Point> seen_;
  std::vector<Colour> colour_;                 // tile by tile, then between them
  std::vector<size_t> tile_colours_ = {0};     // where those of each tile begin, and those between tiles
  std::vector<Rows> contact_rows_, tie_rows_;  // [records * lanes]
  std::vector<wide::ContactRecord> contacts_;
  std::vector<wide::TieRecord> ties_;
  std::vector<wide::Give> contact_give_, tie_give_;
  std::vector<wide::BlockLine> lines_;  // blocks, the ground, then lines nobody reads
  std::vector<int> line_;               // of each block
  int ground_ = 0;

  // second phase: impulses and rates before a sweep, and the direction in which they go on
  struct Direction {
    wide::Lanes old_n, old_t, d_n, d_t;
  };
  struct RateDirection {
    std::array<double, 6> old, d;
  };
  std::vector<Direction> contact_direction_, tie_direction_;  // [records * 2]
  std::vector<RateDirection> rate_direction_;                 // [lines that are read]
  double change_squared_ = 0, least_squared_ = 0;             // of sweeps, in the metric of the influence
};

}  // namespace talus
