#pragma once
// Places that sections of the model name - blocks, points, edges - are there, and those who hold them agree.

#include "talus/cut/layout.h"

namespace talus {

/// Places of supports, boundaries, loads and stages. @pre  the layout is sound and has blocks
void check_places(const Model& model, const Layout& layout, Findings& findings);

/// The layout of the model with its places checked, where it is sound.
Layout checked_layout(const Model& model, const Cut& cut, Findings& findings);

/// The same, cutting first.
Layout checked_layout(const Model& model, Findings& findings);

}  // namespace talus
