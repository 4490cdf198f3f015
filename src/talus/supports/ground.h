#pragma once
// The ground at a block seen from afar: rock softened by the sets of joints that have stiffness.
// Theory: docs/theory.md 4.13.

#include <array>
#include <string>

#include "talus/blocks/block_set.h"

namespace talus {

/// Elastic moduli, (xx, yy, xy) from (exx, eyy, gxy), row by row [Pa].
using Stiffness = std::array<std::array<double, 3>, 3>;

/// A set of parallel joints.
struct JointsOfRock {
  Vec2 normal;            // unit
  double frequency = 0;   // joints per length along it [1/m]
  double kn = 0, ks = 0;  // [Pa/m], 0: hard
};

/// Rock with joints: compliances add up, hard joints add none.
Stiffness jointed_stiffness(const PlaneModuli& rock, const std::vector<JointsOfRock>& joints);

/// Joints with stiffness of the grid, mesh or region that a block belongs to.
/// @param trouble  gets the name of what has such joints, but no one direction and spacing
std::vector<JointsOfRock> joints_around(const Model& model, const Layout& layout, const BlockShape& block,
                                        std::string& trouble);

/// Density and moduli of the ground at a block, of another material if one is given.
struct Ground {
  double density = 0;  // [kg/m3]
  Stiffness stiffness{};
};
Ground ground_at(const Model& model, const Layout& layout, const BlockShape& block, int material,
                 std::string& trouble);

}  // namespace talus
