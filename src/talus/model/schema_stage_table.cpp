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
      {key("level", D::kLength, kNoDefault, to(&InSituInput::level),
           "Height y at which depth begins; no deformable block may have its centroid above."),
       key("pressure", D::kStress, kNonNegative, Usual{kGroundStress}, to(&InSituInput::pressure),
           "Vertical pressure at that level, of the ground above the model."),
       key("density", D::kDensity, kPositive, Usual{kUsualDensity}, kNoDefault, to(&InSituInput::density),
           "Of the ground below the level: the vertical pressure is `pressure` + density x gravity x "
           "depth."),
       key("k0", kNonNegative, kNoDefault, to(&InSituInput::k0), "Horizontal / vertical pressure."),
       key("horizontal_pressure", D::kStress, kNonNegative, Usual{kGroundStress}, kNoDefault,
           to(&InSituInput::horizontal_pressure), "Instead of `k0`: horizontal pressure at the level."),
       key("horizontal_gradient", D::kStiffness, kNonNegative, kNoDefault,
           to(&InSituInput::horizontal_gradient),
           "Instead of `k0`: growth of the horizontal pressure with depth."),
       key("stress_xx", D::kStress, Usual{kGroundStress}, "Stress everywhere, tension > 0."),
       key("stress_yy", D::kStress, Usual{kGroundStress}, "The same."),
       key("stress_xy", D::kStress, Usual{kGroundStress}, "The same.")}};
}

SectionSpec stage_section() {
  return {
      "stage",
      SectionShape::kList,
      "Stages in the order they run.",
      {key("name", K::kText, kRequired, to(&StageInput::name), "Unique name."),
       key("kind", Choices{{"static", "dynamic"}}, kRequired, to(&StageInput::kind),
           "`dynamic`: in true time for `duration`. `static`: until at rest, at most for "
           "`duration`; with `path` from balance to balance."),
       key("duration", D::kTime, kPositive, Usual{Range{.max = 1e5}}, kRequired, to(&StageInput::duration),
           "Length; for a static stage the limit after which the run stops with an error."),
       key("time_step", K::kQuantityAuto, D::kTime, kPositive, Usual{Range{.min = 1e-9, .max = 0.1}},
           to(&StageInput::time_step, &StageInput::where_step),
           "Time step, rounded down so that the stage ends on a step. \"auto\": `safety` times the "
           "stable limit of the stiffest block; with implicit elasticity the time in which a wave crosses two "
           "blocks, in dynamic stages at most a tenth of the shortest period of the histories; where no block "
           "deforms the least of 0.005 sqrt(h/g) (0.02 in static stages), 0.1 h/v and 1/50 of the shortest period of the histories, h the "
           "least thickness of a block, v the fastest motion given, and of blocks that nothing holds the end of "
           "their fall to the lowest place of the model. Of the former at most 2 (with local damping 1), of the latter at most 1 sqrt(m/k), "
           "m the mass of a block, k half of the normal stiffness of the elastic joints around it, a tenth of the "
           "blocks left aside."),
       key("integration", Choices{{"auto", "dynamic", "implicit"}}, Default{"\"auto\""},
           "Static stages. `dynamic`: they move, damped, until at rest. `implicit`: steps of backward Euler "
           "(theory 14.1), each from rest to what is nearly the balance of its loads, that grow from "
           "`time_step` (\"auto\": 20 ms) to 64 times that, and are halved where one fails; `relaxation` is "
           "then, unless given, over the first eight. What slides on by one and a half of its size, and is a "
           "hundredth of all that can move, is a mechanism and ends the run (exit code 6), and so does what is the fastest at "
           "the end of damped motion and has slid half its size. `auto`: implicit, "
           "from 20 ms on, and what has no balance near and is no mechanism is followed by damped motion, in steps "
           "of `time_step`; dynamic where explicit elasticity, damping, `safety` or `moment_clamp` say how blocks "
           "shall move, and where joints without stiffness have cohesion or tensile strength."),
       key("path", D::kTime, kPositive,
           "Static stages, by `integration = \"implicit\"`: the clock of the histories goes on by this, from one balance to "
           "the next (theory 14.7): at the start, at the end of each of the `increments`, and wherever a history that "
           "something follows here turns. histories.csv has a row at its beginning, one for each balance, and none between. `duration` is then "
           "the limit for each of them; blocks that are not waited for (`strict_rest`) stay aside to the end of the stage."),
       key("increments", K::kInteger, Range{.min = 1, .max = 1e5}, Default{"20"},
           "With `path`: number of equal parts of it. Friction and what breaks depend on the way there: twice as many "
           "tell whether these were enough. Friction of joints without stiffness is known to a per cent at the solver's usual tolerance (theory 14.7)."),
       key("safety", Range{.min = 0, .max = 1, .min_open = true, .max_open = true}, to(&StageInput::safety),
           "With \"auto\": share of the stable limit."),
       key("elasticity", Choices{{"auto", "explicit", "implicit"}}, Default{"\"auto\""},
           "`auto`: implicit where a deformable block can slide on a hard contact with friction; in static "
           "stages where a few slivers would ask for a step below a seventh of the median block's; in dynamic ones "
           "with such slivers, or deformable blocks that can meet over joints with friction, where what "
           "shakes or pushes takes a hundred of the steps that implicit elasticity would have; "
           "else explicit, and explicit with `safety` or `moment_clamp`. `explicit`: central differences, "
           "with a stable limit. `implicit`: each block's own elasticity is part of its mass matrix "
           "(theory 4.9), so that no block limits the time step; \"auto\" is then the time in which a wave "
           "crosses two blocks of median size, and at most twice (with local damping, once) the inverse "
           "angular frequency of all but a tenth of the blocks on their elastic joints."),
       key("moment_clamp", K::kBool, to(&StageInput::moment_clamp, &StageInput::where_clamp),
           "With a given `time_step`: raise the moment of inertia of blocks too thin for it (counted and "
           "reported; refused where a block of median size would need it, and on masonry, whose bricks "
           "rock)."),
       key("damping_mass", D::kRate, kNonNegative, to(&StageInput::damping_mass),
           "Mass-proportional damping: force = -damping_mass x mass x velocity. An oscillation of angular "
           "frequency w gets the damping ratio damping_mass / (2 w)."),
       key("damping_stiffness", D::kTime, kNonNegative, Usual{Range{.min = 1e-6, .max = 0.1}}, kNoDefault,
           to(&StageInput::damping_stiffness),
           "Stiffness-proportional damping: stress = damping_stiffness x elastic stiffness x strain "
           "rate, in blocks, not in joints. An oscillation of angular frequency w gets the damping "
           "ratio damping_stiffness x w / 2. With implicit `elasticity` what contact.alpha damps is a part of "
           "it, and free-field columns have it, too; else it shortens the stable time step (`talus check` "
           "says by how much). Default \"0.5 ms\" in dynamic stages with implicit elasticity in which "
           "something shakes or pushes, none of it faster than 32 Hz (theory 4.9); else \"0 s\"."),
       key("damping_local", Range{.min = 0, .max = 1, .max_open = true},
           "Local damping: share of a block's unbalanced force that opposes its motion. Default 0.8 in "
           "static, 0 in dynamic stages."),
       key("unbalanced", Range{.min = 0, .max = 0.1, .min_open = true}, to(&StageInput::unbalanced),
           "Static stages: at rest when the largest unbalanced force of a block, as share of the mean "
           "force on blocks, and the velocity left, as share of its peak or of what the forces give in "
           "half a step, are below this."),
       key("strict_rest", K::kBool, to(&StageInput::strict_rest),
           "Static stages in steps from rest: true: all blocks have to rest. false: blocks that fall or slide on without an "
           "end, less than a hundredth of the area in all, are named, and the stage ends when the others rest; "
           "they weigh nothing from then on, what moves pushes them aside, and they go on in the stages after it."),
       key("excavate", K::kTexts, RefersTo{"block, grid, region or kept opening"}, kNoDefault,
           to(&StageInput::excavate, &StageInput::where_excavate),
           "Blocks taken out at the start of the stage: names of groups or of single blocks. They leave "
           "no mass and no contact."),
       key("relaxation", K::kCurve, Range{.min = 0, .max = 1}, kNoDefault,
           to(&StageInput::relaxation, &StageInput::where_relaxation),
           "List of [time since the start of the stage, share]: what the excavated blocks pushed on the "
           "others stays as forces, of which this share is gone. Linear between points and held; begins "
           "at 0 with the excavation (none: all gone at once) and where the stage before ended in a "
           "later stage."),
       key("reset_displacements", K::kBool, to(&StageInput::reset_displacements),
           "Displacements in histories and frames count from the start of this stage on.")}};
}

SectionSpec change_section() {
  const auto value = [](std::string_view name, Dimension dimension, Range range, std::string_view doc) {
    return key(name, dimension, range, doc);
  };
  return {
      "change",
      SectionShape::kList,
      "What changes at the start of a stage, for good: values of a `joint` or a `material`, or material and "
      "kind of blocks (`block`).",
      {key("stage", K::kName, RefersTo{"stage"}, kRequired, "At its start."),
       key("joint", K::kName, RefersTo{"joint"}, "Joint whose strength changes."),
       key("material", K::kName, RefersTo{"material"},
           "Material whose values change; with `block`: what those blocks are made of from now on. The "
           "stress stays as it was; boundaries keep the medium behind them."),
       key("block", K::kText, RefersTo{"block, grid, region or kept opening"}, kNoDefault,
           to(&ChangeInput::block), "Blocks that change."),
       key("kind", Choices{{"fixed", "free"}},
           "With `block`: `fixed`: they stay where they are; `free`: they move again."),
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
