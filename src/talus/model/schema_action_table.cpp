// What ties blocks to each other and to the ground: contact and supports.

#include "talus/model/schema_tables.h"

namespace talus {

std::vector<SectionSpec> action_sections() {
  return {
      {"contact",
       SectionShape::kTable,
       "Contact between blocks that no other section names.",
       {key("joint", K::kName, RefersTo{"joint"},
            "Joint of all pairs of blocks without their own; none: hard and frictionless."),
        key("law", Choices{{"exact", "smoothed"}}, Default{"\"exact\""},
            "`exact`: the contact law. `smoothed`: the paper's approximation (its eqs 26-29 with units "
            "corrected), for comparison only: its friction creeps."),
        key("alpha", Range{.min = 0, .max = 1}, to(&ContactInput::alpha),
            "Numerical damping of joints with stiffness: 0 loses nothing, 1 is backward Euler. Of what steps of dt resolve it is a "
            "damping time of alpha dt, which is counted in the joint's own (`damping_time`)."),
        key("stiffness", Choices{{"auto", "none"}}, Default{"\"auto\""},
            "Of contacts whose joint has no stiffness. `auto`: under the largest stress that the model gives to be "
            "foreseen a face closes by 1e-5 of its length, less than rock itself, so that redundant contacts "
            "share a load in one way and large masses can be solved (theory 4.22). `none`: nothing gives; with "
            "`law = \"smoothed\"` it never does."),
        key("slop", Range{.min = 0, .max = 1e-2}, to(&ContactInput::slop),
            "Overlap that is left uncorrected where contacts give nothing: with "
            "`stiffness = \"none\"`. Share of the smaller block's size."),
        key("smoothing_force", D::kForce, kPositive, to(&ContactInput::smoothing_force),
            "Width of the smoothed normal law. With `formulation = \"as_printed\"` it is a bare number, of metres and "
            "newtons alike, and `smoothing_slip` unless given."),
        key("smoothing_slip", D::kLength, kPositive, to(&ContactInput::smoothing_slip),
            "Width of the smoothed friction law: slip per step at which half of the friction acts.")}},

      {"contact_pair",
       SectionShape::kList,
       "Joint between two blocks, grids or regions; it goes before the joints of their edges.",
       {key("between", K::kNames, RefersTo{"block, grid or region"}, kRequired, "The two names."),
        key("joint", K::kName, RefersTo{"joint"}, kRequired, "The joint.")}},

      {"support",
       SectionShape::kList,
       "Points of blocks that are held or moved. Give `point`, `edge` or `along`.",
       {key("name", K::kText, kRequired, to(&SupportInput::name), "Unique name."),
        key("point", K::kVector, D::kLength, "A point: all corners there, else the block around it."),
        key("edge", K::kPoints, D::kLength,
            "A segment [[x0, y0], [x1, y1]]: all block edges on it, held at their corners."),
        key("along", K::kName, RefersTo{"side, opening, fault or joint set"},
            "All block edges along it, held at their corners."),
        key("block", K::kName, RefersTo{"block, grid or region"}, "Only blocks of this name."),
        key("x", K::kMotion, Default{"\"fixed\""},
            "Along x: \"fixed\", \"free\", { velocity = \"HISTORY\" } or { displacement = \"HISTORY\" }."),
        key("y", K::kMotion, Default{"\"fixed\""}, "The same along y."), stages_key()}}};
}

}  // namespace talus
