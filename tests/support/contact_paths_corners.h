#pragma once
// Forces along a path by the search for corners over edges and its rows (theory 3.2, 3.3, 4.6).

#include "support/contact_paths.h"

namespace talus::test {

/// Of a joint of 1 GPa/m in both directions and friction 0.6, with memory as in a run of 1 ms a step: the
/// blocks lie where the path puts them, and every row yields by as much as it is closed or sheared.
/// @param path  outlives it and its copies
std::unique_ptr<ContactForces> corner_forces(const ContactPath& path);

}  // namespace talus::test
