#pragma once
// Which solver a step gets. The measured table behind it is in docs/performance.md.

#include "talus/model/model.h"

namespace talus {

/// What the model asks for; for `auto`, what is faster for so many points, `hard_ties` of which tie faces
/// without any give.
SolverKind chosen_solver(const Model& model, size_t points, size_t hard_ties);

}  // namespace talus
