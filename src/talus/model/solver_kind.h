#pragma once
// The solvers there are, by the names that models, summaries and the command give them. What each can is in
// solve/solvers.cpp.

#include <array>
#include <cstddef>
#include <string_view>

#include "talus/base/index.h"

namespace talus {

/// kAuto: what is faster for a step.
enum class SolverKind { kAuto, kNewton, kGaussSeidel, kPrimalNewton, kPivoting };

inline constexpr std::array<std::string_view, 5> kSolverName{"auto", "newton", "gauss_seidel",
                                                             "primal_newton", "pivoting"};
static_assert(count_of(kSolverName) == place_of(SolverKind::kPivoting) + 1);

inline constexpr std::string_view name_of(SolverKind kind) { return kSolverName[place_of(kind)]; }

/// The solver called `name`; kAuto when there is none.
inline constexpr SolverKind solver_called(std::string_view name) {
  for (size_t i = 0; i < kSolverName.size(); ++i)
    if (kSolverName[i] == name) return static_cast<SolverKind>(i);
  return SolverKind::kAuto;
}

}  // namespace talus
