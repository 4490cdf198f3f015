#pragma once
// Factor of sparse symmetric matrices, one after the other. Not for use outside solve/.

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <vector>

#include "talus/base/index.h"

namespace talus {

using ColumnMatrix = Eigen::SparseMatrix<double>;

/// A symmetric factor whose ordering is kept for as long as the pattern of its matrix stays.
class SymmetricFactor {
 public:
  /// False when there is no factor.
  bool factorize(const ColumnMatrix& a) {
    const auto same = [](const std::vector<int>& kept, const int* now, Eigen::Index n) {
      return count_of(kept) == n && std::equal(kept.begin(), kept.end(), now);
    };
    if (!same(outer_, a.outerIndexPtr(), a.outerSize() + 1) ||
        !same(inner_, a.innerIndexPtr(), a.nonZeros())) {
      outer_.assign(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize() + 1);
      inner_.assign(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros());
      factor_.analyzePattern(a);
    }
    factor_.factorize(a);
    return factor_.info() == Eigen::Success;
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& rhs) const { return factor_.solve(rhs); }

 private:
  std::vector<int> outer_, inner_;
  Eigen::SimplicialLDLT<ColumnMatrix> factor_;
};

}  // namespace talus
