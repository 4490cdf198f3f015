#pragma once
// The ground behind an edge: its resistance to waves (eq. 33 of the paper).

#include <cmath>

#include "talus/blocks/block_set.h"

namespace talus {

/// rho cp and rho cs [Pa s/m].
struct Impedance {
  double pressure = 0, shear = 0;
};

/// @pre  the material has elastic constants
inline Impedance impedance(const Model& model, int material) {
  const Material& m = model.materials[material];
  const PlaneModuli c = plane_moduli(m.young, m.poisson, model.plane);
  return {std::sqrt(m.density * c.c11), std::sqrt(m.density * c.c33)};
}

/// The material behind a boundary at an edge of this block.
inline int material_behind(const BoundaryInput& boundary, const Layout& layout, int block) {
  return boundary.material >= 0 ? boundary.material : layout.blocks[block].material;
}

}  // namespace talus
