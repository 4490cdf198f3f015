#pragma once
// What a result folder keeps of the model besides its text, so that a picture or report needs no model file:
// the table of blocks, and the model in numbers.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "talus/output/columns.h"
#include "talus/step/scene.h"

namespace talus {

/// A row of blocks.csv.
struct BlockRow {
  const Scene& scene;
  size_t block;
};
const Columns<BlockRow, Cell>& block_columns();

/// blocks.csv: id, name, kind, material, group, area [m2], centroid at the start [m].
std::string blocks_table(const Scene& scene);

/// "model" of summary.json: dimensions, materials, joints, boundaries, bolts, stress of the ground, stages
/// and monitors, as counts and SI values.
nlohmann::ordered_json model_in_numbers(const Scene& scene);

}  // namespace talus
