#pragma once
// What the patches of a model hang on and do not change.

#include "talus/contact/bonds.h"
#include "talus/contact/outlines.h"
#include "talus/model/joint_law.h"

namespace talus {

/// What the search for patches is told.
struct PatchWorld {
  const BlockSet& blocks;
  const Outlines& outlines;
  const BondSet& bonds;
  const Layout& layout;
  const Model& model;
  const std::vector<JointLaw>& laws;
};

}  // namespace talus
