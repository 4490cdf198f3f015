#include "talus/step/scene.h"

#include "talus/step/energy.h"

namespace talus {

Scene build_scene(Model model, Layout layout) {
  Scene scene;
  scene.model = std::move(model);
  scene.layout = std::move(layout);
  scene.blocks = build_blocks(scene.model, scene.layout);
  scene.bonds = find_bonds(scene.model, scene.layout, scene.blocks);
  scene.supported = supported_points(scene.model, scene.layout, scene.blocks);
  scene.loaded = loaded_blocks(scene.model, scene.layout);
  return scene;
}

State start_state(const Scene& scene) {
  State state = initial_state(scene.blocks, scene.layout);
  state.bond_force.resize(2 * scene.bonds.faces.size());
  state.face.resize(scene.bonds.faces.size());
  state.support_force.resize(scene.supported.size());
  state.energy_start = kinetic_energy(scene.blocks, state.rate);
  return state;
}

}  // namespace talus
