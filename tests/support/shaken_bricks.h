#pragma once
// A wall of bricks with everything that a run keeps from step to step: for tests of saved states and of results.

#include <string>

namespace talus::test {

/// Bricks that slide, open and break on a shaking floor, after a static stage and an excavation.
inline const std::string kShakenBricks = R"model(talus = 1
[model]
gravity = [0, -9.81]
[material.rock]
density = 2500
young = "1 GPa"
poisson = 0.2
[joint.face]
friction_angle = "30 deg"
cohesion = "20 kPa"
normal_stiffness = "5 GPa/m"
shear_stiffness = "5 GPa/m"
[contact]
joint = "face"
[history.shake]
expression = "0.4*sin(40*t)*(t<0.1?t/0.1:1)"
duration = "1 s"
[[block]]
name = "floor"
polygon = [[-2, -1], [6, -1], [6, 0], [-2, 0]]
material = "rock"
kind = "driven"
motion_x = { velocity = "shake" }
[[grid]]
name = "wall"
min = [0, 0]
max = [4, 3]
cells = [4, 6]
material = "rock"
joint = "face"
[[block]]
name = "prop"
polygon = [[4, 0], [4.5, 0], [4.5, 1], [4, 1]]
material = "rock"
[[monitor]]
name = "top"
point = [2, 2.9]
relative_to = "floor"
[[monitor]]
name = "width"
convergence = [[0.1, 2.9], [3.9, 2.9]]
[[monitor]]
name = "foot"
contact = ["wall", "floor"]
window = "5 ms"
[[stage]]
name = "rest"
kind = "static"
integration = "dynamic"
duration = "1 s"
unbalanced = 1e-3
[[stage]]
name = "dig"
kind = "static"
integration = "dynamic"
duration = "1 s"
unbalanced = 1e-3
excavate = ["prop"]
relaxation = [[0, 0], ["10 ms", 1]]
reset_displacements = true
[[stage]]
name = "shake"
kind = "dynamic"
duration = "0.2 s"
time_step = "0.1 ms"
[output]
history_interval = "1 ms"
steps_interval = "1 ms"
field_interval = "20 ms"
save_interval = "20 ms"
)model";

/// The same wall in joints that weaken and ride up, with a tensioned bar from the start and, when it is
/// shaken, a grouted one that is too thin for what is asked of it.
inline std::string bolted_bricks() {
  std::string text = kShakenBricks;
  const std::string at = "cohesion = \"20 kPa\"\n";
  text.insert(text.find(at) + at.size(), R"model(tensile_strength = "10 kPa"
residual_friction_angle = "20 deg"
residual_cohesion = "1 kPa"
residual_tensile_strength = "0 kPa"
dilation_angle = "5 deg"
dilation_slip = "1 mm"
)model");
  return text + R"model([bolt_type.anchor]
kind = "anchored"
diameter = "25 mm"
young = "200 GPa"
yield_stress = "500 MPa"
rupture_strain = 0.05
spacing = "1 m"
pretension = "20 kN"
[bolt_type.bar]
kind = "grouted"
diameter = "8 mm"
yield_force = "1 kN"
rupture_strain = 0.002
spacing = "1 m"
grout_stiffness = "1 GPa"
bond_strength = "200 kN/m"
dowel_stiffness = "15 MN/m"
dowel_yield = "1 kN"
segment_length = "0.2 m"
[[bolt]]
name = "post"
from = [1.4, 3]
to = [1.6, -0.5]
type = "anchor"
stage = "rest"
[[bolt]]
name = "pin"
from = [2.3, 3]
to = [2.7, -0.5]
type = "bar"
stage = "shake"
[[monitor]]
name = "post"
bolt = "post"
[[monitor]]
name = "pin"
bolt = "pin"
)model";
}

}  // namespace talus::test
