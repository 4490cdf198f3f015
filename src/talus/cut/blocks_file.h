#pragma once
// The blocks of a cut as a file (JSON), and back, so that a run need not cut again.

#include <string>

#include "talus/cut/cut.h"

namespace talus {

/// Identifies everything that shapes the blocks: regions, traces and the settings of [cut]; not materials,
/// joint properties or stages, which may change while the blocks stay; supports and boundaries only where
/// slivers are merged.
std::string cut_fingerprint(const Model& model);

/// Content of a blocks file. Coordinates with all digits.
std::string blocks_file_text(const Model& model, const Cut& cut);

/// Reads the file that `model.cut.blocks_file` names, relative to the folder of the model file. A file of
/// another cut, or a damaged one, is a finding. Throws FileError when it cannot be opened.
Cut read_blocks_file(const Model& model, Findings& findings);

}  // namespace talus
