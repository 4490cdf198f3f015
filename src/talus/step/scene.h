#pragma once
// Everything a step needs to know and may not change: the model, its blocks, bonds and supports.

#include "talus/contact/bonds.h"
#include "talus/supports/loads.h"
#include "talus/supports/supports.h"

namespace talus {

struct Scene {
  Model model;
  Layout layout;
  BlockSet blocks;
  BondSet bonds;
  std::vector<SupportedPoint> supported;
  std::vector<std::vector<int>> loaded;  // blocks of each load
};

/// @pre  neither read_model nor make_layout found an error
Scene build_scene(Model model, Layout layout);

/// State at the start of the run: reference shape, initial velocities, nothing broken.
State start_state(const Scene& scene);

}  // namespace talus
