#pragma once
// How many blocks a model will have, known from its sections before anything is drawn.

#include <string>
#include <vector>

#include "talus/model/model.h"
#include "talus/schema/findings.h"

namespace talus {

struct ExpectedPart {
  std::string path;  // of its section
  Where where;
  double blocks = 0;
};

/// Blocks that each section makes, within some tens of percent where there are many. Joint sets and surveyed
/// traces: the crossings of their lines, less the ends of traces, which are dead; masonry, tessellations:
/// area by area of a block; grids: their cells. Blocks read from a file count nothing.
std::vector<ExpectedPart> expected_blocks(const Model& model);

/// An error when cutting and running that many blocks needs more than `memory` [bytes].
void check_expected(const Model& model, double memory, Findings& findings);

}  // namespace talus
