// Stages, what changes with them, and the stress of the ground before the first.

#include "talus/model/schema_tables.h"

namespace talus {

namespace {

SectionSpec in_situ_section() {
  return {
      "in_situ",
      SectionShape::kTable,
      "Stress of the ground at the start, in every deformable block as at its centroid. Either with depth "
      "(`level`, `density`, `k0` or a horizontal gradient) or the same everywhere (`stress_xx` ...).",
      {{.name = "level",
        .dimension = D::kLength,
        .doc = "Height y at which depth begins; no deformable block may have its centroid above."},
       {.name = "pressure",
        .dimension = D::kStress,
        .range = kNonNegative,
        .usual = kGroundStress,
        .default_text = "\"0 Pa\"",
        .doc = "Vertical pressure at that level, of the ground above the model."},
       {.name = "density",
        .dimension = D::kDensity,
        .range = kPositive,
        .usual = kUsualDensity,
        .doc = "Of the ground below the level: the vertical pressure is `pressure` + density x gravity x "
               "depth."},
       {.name = "k0", .range = kNonNegative, .doc = "Horizontal / vertical pressure."},
       {.name = "horizontal_pressure",
        .dimension = D::kStress,
        .range = kNonNegative,
        .usual = kGroundStress,
        .doc = "Instead of `k0`: horizontal pressure at the level."},
       {.name = "horizontal_gradient",
        .dimension = D::kStiffness,
        .range = kNonNegative,
        .doc = "Instead of `k0`: growth of the horizontal pressure with depth."},
       {.name = "stress_xx",
        .dimension = D::kStress,
        .usual = kGroundStress,
        .doc = "Stress everywhere, tension > 0."},
       {.name = "stress_yy", .dimension = D::kStress, .usual = kGroundStress, .doc = "The same."},
       {.name = "stress_xy", .dimension = D::kStress, .usual = kGroundStress, .doc = "The same."}}};
}

SectionSpec stage_section() {
  return {
      "stage",
      SectionShape::kList,
      "Stages in the order they run.",
      {{.name = "name", .type = K::kText, .required = true, .doc = "Unique name."},
       {.name = "kind",
        .type = K::kChoice,
        .required = true,
        .choices = {"static", "dynamic"},
        .doc = "`dynamic`: in true time for `duration`. `static`: until at rest, at most for "
               "`duration`; with `path` from balance to balance."},
       {.name = "duration",
        .dimension = D::kTime,
        .range = kPositive,
        .usual = {.max = 1e5},
        .required = true,
        .doc = "Length; for a static stage the limit after which the run stops with an error."},
       {.name = "time_step",
        .type = K::kQuantityAuto,
        .dimension = D::kTime,
        .range = kPositive,
        .usual = {.min = 1e-9, .max = 0.1},
        .default_text = "\"auto\"",
        .doc =
            "Time step, rounded down so that the stage ends on a step. \"auto\": `safety` times the "
            "stable limit of the stiffest block; with implicit elasticity the time in which a wave crosses two "
            "blocks, in dynamic stages at most a tenth of the shortest period of the histories; where no block "
            "deforms the least of 0.005 sqrt(h/g) (0.02 in static stages), 0.1 h/v and 1/50 of the shortest period of the histories, h the "
            "least thickness of a block, v the fastest motion given, and of blocks that nothing holds the end of "
            "their fall to the lowest place of the model. Of the former at most 2 (with local damping 1), of the latter at most 1 sqrt(m/k), "
            "m the mass of a block, k half of the normal stiffness of the elastic joints around it, a tenth of the "
            "blocks left aside."},
       {.name = "integration",
        .type = K::kChoice,
        .default_text = "\"auto\"",
        .choices = {"auto", "dynamic", "implicit"},
        .doc =
            "Static stages. `dynamic`: they move, damped, until at rest. `implicit`: steps of backward Euler "
            "(theory 14.1), each from rest to what is nearly the balance of its loads, that grow from "
            "`time_step` (\"auto\": 20 ms) to 64 times that, and are halved where one fails; `relaxation` is "
            "then, unless given, over the first eight. What slides on by one and a half of its size, and is a "
            "hundredth of all that can move, is a mechanism and ends the run (exit code 6), and so does what is the fastest at "
            "the end of damped motion and has slid half its size. `auto`: implicit, "
            "from 20 ms on, and what has no balance near and is no mechanism is followed by damped motion, in steps "
            "of `time_step`; dynamic where explicit elasticity, damping, `safety` or `moment_clamp` say how blocks "
            "shall move, and where joints without stiffness have cohesion or tensile strength."},
       {.name = "path",
        .dimension = D::kTime,
        .range = kPositive,
        .doc =
            "Static stages, by `integration = \"implicit\"`: the clock of the histories goes on by this, from one balance to "
            "the next (theory 14.7): at the start, at the end of each of the `increments`, and wherever a history that "
            "something follows here turns. histories.csv has a row at its beginning, one for each balance, and none between. `duration` is then "
            "the limit for each of them; blocks that are not waited for (`strict_rest`) stay aside to the end of the stage."},
       {.name = "increments",
        .type = K::kInteger,
        .range = {.min = 1, .max = 1e5},
        .default_text = "20",
        .doc =
            "With `path`: number of equal parts of it. Friction and what breaks depend on the way there: twice as many "
            "tell whether these were enough. Friction of joints without stiffness is known to a per cent at the solver's usual tolerance (theory 14.7)."},
       {.name = "safety",
        .range = {.min = 0, .max = 1, .min_open = true, .max_open = true},
        .default_text = "0.8",
        .doc = "With \"auto\": share of the stable limit."},
       {.name = "elasticity",
        .type = K::kChoice,
        .default_text = "\"auto\"",
        .choices = {"auto", "explicit", "implicit"},
        .doc =
            "`auto`: implicit where a deformable block can slide on a hard contact with friction; in static "
            "stages where a few slivers would ask for a step below a seventh of the median block's; in dynamic ones "
            "with such slivers, or deformable blocks that can meet over joints with friction, where what "
            "shakes or pushes takes a hundred of the steps that implicit elasticity would have; "
            "else explicit, and explicit with `safety` or `moment_clamp`. `explicit`: central differences, "
            "with a stable limit. `implicit`: each block's own elasticity is part of its mass matrix "
            "(theory 4.9), so that no block limits the time step; \"auto\" is then the time in which a wave "
            "crosses two blocks of median size, and at most twice (with local damping, once) the inverse "
            "angular frequency of all but a tenth of the blocks on their elastic joints."},
       {.name = "moment_clamp",
        .type = K::kBool,
        .default_text = "false",
        .doc = "With a given `time_step`: raise the moment of inertia of blocks too thin for it (counted and "
               "reported; refused where a block of median size would need it, and on masonry, whose bricks "
               "rock)."},
       {.name = "damping_mass",
        .dimension = D::kRate,
        .range = kNonNegative,
        .default_text = "\"0 1/s\"",
        .doc =
            "Mass-proportional damping: force = -damping_mass x mass x velocity. An oscillation of angular "
            "frequency w gets the damping ratio damping_mass / (2 w)."},
       {.name = "damping_stiffness",
        .dimension = D::kTime,
        .range = kNonNegative,
        .usual = {.min = 1e-6, .max = 0.1},
        .doc =
            "Stiffness-proportional damping: stress = damping_stiffness x elastic stiffness x strain "
            "rate, in blocks, not in joints. An oscillation of angular frequency w gets the damping "
            "ratio damping_stiffness x w / 2. With implicit `elasticity` what contact.alpha damps is a part of "
            "it, and free-field columns have it, too; else it shortens the stable time step (`talus check` "
            "says by how much). Default \"0.5 ms\" in dynamic stages with implicit elasticity in which "
            "something shakes or pushes, none of it faster than 32 Hz (theory 4.9); else \"0 s\"."},
       {.name = "damping_local",
        .range = {.min = 0, .max = 1, .max_open = true},
        .doc = "Local damping: share of a block's unbalanced force that opposes its motion. Default 0.8 in "
               "static, 0 in dynamic stages."},
       {.name = "unbalanced",
        .range = {.min = 0, .max = 0.1, .min_open = true},
        .default_text = "1e-5",
        .doc = "Static stages: at rest when the largest unbalanced force of a block, as share of the mean "
               "force on blocks, and the velocity left, as share of its peak or of what the forces give in "
               "half a step, are below this."},
       {.name = "strict_rest",
        .type = K::kBool,
        .default_text = "false",
        .doc =
            "Static stages in steps from rest: true: all blocks have to rest. false: blocks that fall or slide on without an "
            "end, less than a hundredth of the area in all, are named, and the stage ends when the others rest; "
            "they weigh nothing from then on, what moves pushes them aside, and they go on in the stages after it."},
       {.name = "excavate",
        .type = K::kTexts,
        .refers_to = "block, grid, region or kept opening",
        .doc = "Blocks taken out at the start of the stage: names of groups or of single blocks. They leave "
               "no mass and no contact."},
       {.name = "relaxation",
        .type = K::kCurve,
        .range = {.min = 0, .max = 1},
        .doc = "List of [time since the start of the stage, share]: what the excavated blocks pushed on the "
               "others stays as forces, of which this share is gone. Linear between points and held; begins "
               "at 0 with the excavation (none: all gone at once) and where the stage before ended in a "
               "later stage."},
       {.name = "reset_displacements",
        .type = K::kBool,
        .default_text = "false",
        .doc = "Displacements in histories and frames count from the start of this stage on."}}};
}

SectionSpec change_section() {
  const auto value = [](std::string_view name, Dimension dimension, Range range, std::string_view doc) {
    return KeySpec{.name = name, .dimension = dimension, .range = range, .doc = doc};
  };
  return {
      "change",
      SectionShape::kList,
      "What changes at the start of a stage, for good: values of a `joint` or a `material`, or material and "
      "kind of blocks (`block`).",
      {{.name = "stage", .type = K::kName, .required = true, .refers_to = "stage", .doc = "At its start."},
       {.name = "joint", .type = K::kName, .refers_to = "joint", .doc = "Joint whose strength changes."},
       {.name = "material",
        .type = K::kName,
        .refers_to = "material",
        .doc = "Material whose values change; with `block`: what those blocks are made of from now on. The "
               "stress stays as it was; boundaries keep the medium behind them."},
       {.name = "block",
        .type = K::kText,
        .refers_to = "block, grid, region or kept opening",
        .doc = "Blocks that change."},
       {.name = "kind",
        .type = K::kChoice,
        .choices = {"fixed", "free"},
        .doc = "With `block`: `fixed`: they stay where they are; `free`: they move again."},
       value("friction_angle", D::kAngle, {.min = 0, .max = 1.5707, .max_open = true},
             "Of the joint. What a change leaves has to be a joint that `[joint.NAME]` could give: no less "
             "than `dilation_angle` and `residual_friction_angle`; strengths likewise no less than the "
             "residual ones."),
       value("cohesion", D::kStress, kNonNegative,
             "Of the joint; more than 0 only where it had strength at the start."),
       value("tensile_strength", D::kStress, kNonNegative, "The same."),
       value("density", D::kDensity, kPositive, "Of the material."),
       value("young", D::kStress, kPositive, "The same."),
       value("poisson", D::kNone, {.min = -1, .max = 0.5, .min_open = true, .max_open = true}, "The same.")}};
}

}  // namespace

std::vector<SectionSpec> stage_sections() { return {in_situ_section(), stage_section(), change_section()}; }

}  // namespace talus
