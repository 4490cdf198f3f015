#pragma once
// Cholesky factor of symmetric positive definite matrices of 6 x 6 tiles, one for each block and one for each
// pair of blocks: nested dissection by the places of the blocks, then fronts up the tree of separators.
// The same bits for any number of threads and on every machine. Not for use outside solve/.
// Theory: docs/theory.md 5.8.

#include <array>
#include <cstddef>
#include <vector>

#include "talus/base/parallel.h"
#include "talus/base/vec2.h"
#include "talus/solve/wide.h"

namespace talus {

/// Six unknowns of one block by six of another, row by row.
using Tile = std::array<double, 36>;

class BlockFactor {
 public:
  /// @param kernels  which to run; for tests of one against the other
  explicit BlockFactor(const wide::Kernels& kernels = wide::best_kernels()) : kernels_(&kernels) {}

  /// Where the matrix has tiles: orders the blocks and finds the fronts.
  /// @param pairs  of different blocks, the lower first, in rising order, each once
  /// @param place  of each block: any that keep neighbours near each other
  void analyse(const std::vector<std::array<int, 2>>& pairs, const std::vector<Vec2>& place);

  /// What the pattern costs, known before any number.
  struct Cost {
    double entries = 0;     // of the factor, zeros in its fronts included
    double operations = 0;  // products and sums of a factorisation
    int largest_front = 0;  // unknowns
  };
  const Cost& cost() const { return cost_; }

  /// @param diagonal  one tile a block, symmetric
  /// @param beside    one tile a pair: rows of its first block, columns of its second
  /// @return false when the matrix is not positive definite
  bool factorize(const std::vector<Tile>& diagonal, const std::vector<Tile>& beside, const Workers& workers);

  /// Largest pivot over smallest: a lower bound of the condition of the matrix, in its own units.
  /// @pre  factorize() has succeeded
  double pivot_ratio() const;

  /// @param x  in: right-hand side, six numbers a block; out: the solution
  /// @pre  factorize() has succeeded
  void solve(std::vector<double>& x, const Workers& workers) const;

 private:
  // The blocks that a front eliminates, and those that they leave joined: all blocks of later fronts that one of
  // them has a tile with, then or from an earlier front.
  struct Front {
    int parent = -1;
    std::vector<int> children;
    std::vector<int> own, boundary;  // blocks, in the order of elimination
    std::vector<int> in_parent;      // place of each boundary block among the parent's own and boundary
    std::vector<int> pairs;          // whose first eliminated block is one of its own
    std::vector<size_t> at;          // where the numbers of each boundary block are while solving
    std::vector<double> columns;     // of own blocks, strip by strip
    std::vector<double> left;        // what elimination leaves of the boundary; given up to the parent
    size_t own_strips() const { return (own.size() + 1) / 2; }
    size_t boundary_strips() const { return (boundary.size() + 1) / 2; }
    double operations() const;
  };

  class Dissection;
  /// In the order of elimination.
  bool goes_before(int a, int b) const;
  void join_fronts(const std::vector<std::array<int, 2>>& pairs);
  void share_out();
  void place_boundaries();
  void gather(Front& front, const std::vector<Tile>& diagonal, const std::vector<Tile>& beside);
  bool eliminate(Front& front, const Workers& workers) const;
  static void fetch(const Front& front, const double* x, std::vector<double>& y);
  void forward(const Front& front, const Workers& workers, double* x, std::vector<double>& y) const;
  void backward(const Front& front, const Workers& workers, double* x, std::vector<double>& y) const;

  const wide::Kernels* kernels_;
  std::vector<Front> fronts_;  // children before parents
  std::vector<std::array<int, 2>> pairs_;
  std::vector<int> front_of_, place_in_front_;  // of each block
  std::vector<std::vector<int>> subtrees_;  // fronts that one thread works at, in order; the rest is rest_
  std::vector<int> rest_;
  // Numbers that a subtree takes off those of blocks outside of it, kept apart until all subtrees are done: where
  // each subtree's begin, after those of the blocks, and where all end.
  std::vector<size_t> outside_;
  Cost cost_;
};

}  // namespace talus
