#pragma once
// Monitors look at places that are there.

#include "talus/cut/layout.h"

namespace talus {

/// Points outside every block, and names of no block, support or free field; nothing is said of a layout that
/// is not sound.
void check_monitors(const Model& model, const Layout& layout, Findings& findings);

}  // namespace talus
