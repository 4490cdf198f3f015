#pragma once
// Everything a step needs to know and may not change: the model, its blocks, bonds and supports.

#include "talus/contact/bonds.h"
#include "talus/contact/contact_give.h"
#include "talus/contact/outlines.h"
#include "talus/supports/bolts.h"
#include "talus/supports/boundaries.h"
#include "talus/supports/loads.h"
#include "talus/supports/supports.h"

namespace talus {

struct Scene {
  // made and taken apart in one file: here every file of the program would hold that code
  Scene();
  Scene(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(const Scene&);
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  Model model;
  Layout layout;
  BlockSet blocks;
  std::vector<JointLaw> laws;  // of the model's joints, in the stage
  ContactGive give;            // of hard contacts
  BondSet bonds;
  Outlines outlines;  // of the formulation that goes by patches; empty: contacts are of corners on edges
  std::vector<SupportedPoint> supported;
  BoundarySet boundaries;
  LoadSet loads;

  bool by_patches() const { return model.formulation == Formulation::kContactForces; }
};

/// Boundaries and bolts that cannot be are told to `findings`; such a scene is not to be run.
/// @pre  neither read_model nor make_layout found an error
Scene build_scene(Model model, Layout layout, Findings& findings);

/// The same; throws InputError instead.
Scene build_scene(Model model, Layout layout);

/// Whether a few slivers would make explicit elasticity several times dearer, or worse (theory 4.9).
bool slivers_rule(const BlockSet& blocks);

/// Whether a deformable block may meet another over a joint with friction, elastic or hard.
bool deforming_blocks_meet(const Scene& scene);

/// State at the start of the run: reference shape, initial velocities, nothing broken.
State start_state(const Scene& scene);

}  // namespace talus
