#pragma once
// Places that sections of the model name - blocks, points, edges - are there, and those who hold them agree.

#include <string>

#include "talus/cut/layout.h"

namespace talus {

/// Told when no block is called `name`.
void unknown_block(const Layout& layout, const std::string& name, const Where& where, const std::string& path,
                   Findings& findings);

/// Places of monitors, supports, boundaries and loads. @pre  the layout has blocks
void check_places(const Model& model, const Layout& layout, Findings& findings);

}  // namespace talus
