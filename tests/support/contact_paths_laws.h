#pragma once
// Forces along a path by patches, with memory as in a run of 1 ms a step: of a joint of 1 GPa/m in both
// directions and friction 0.6. The blocks lie where the path puts them, and every row yields by as much as it is
// closed or sheared.

#include "support/contact_paths.h"

namespace talus::test {

/// By patches (theory 3).
/// @param path  outlives it and its copies
std::unique_ptr<ContactForces> patch_forces(const ContactPath& path);

}  // namespace talus::test
