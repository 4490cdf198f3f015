#pragma once
// From the model's regions and traces to a closed set of blocks: arrangement, dead ends, slivers, numbers
// that stay. Theory: docs/theory.md section 10.

#include "talus/cut/partition.h"

namespace talus {

/// Cuts the regions of `model`. What makes no sense goes to `findings`, and then the cut is empty.
/// Throws std::runtime_error when the arrangement fails, which no input should bring about.
/// @pre the model's shapes are readable
Cut cut_model(const Model& model, Findings& findings);

/// The same cut with slivers treated as `model.cut` says now. @pre  the cut is of cut_model, of a model that
/// differs in this alone
Cut with_slivers(const Model& model, Cut cut);

}  // namespace talus
