// What ties blocks to each other and to the ground: contact and supports.

#include "talus/model/schema_tables.h"

namespace talus {

std::vector<SectionSpec> action_sections() {
  return {
      {"contact",
       SectionShape::kTable,
       "Contact between blocks that no other section names.",
       {{.name = "joint",
         .type = K::kName,
         .refers_to = "joint",
         .doc = "Joint of all pairs of blocks without their own; none: hard and frictionless."},
        {.name = "law",
         .type = K::kChoice,
         .default_text = "\"exact\"",
         .choices = {"exact", "smoothed"},
         .doc = "`exact`: the contact law. `smoothed`: the paper's approximation (its eqs 26-29 with units "
                "corrected), for comparison only: its friction creeps."},
        {.name = "alpha",
         .range = {.min = 0, .max = 1},
         .default_text = "0.2",
         .doc =
             "Numerical damping of joints with stiffness: 0 loses nothing, 1 is backward Euler. Of what steps of dt resolve it is a "
             "damping time of alpha dt, which is counted in the joint's own (`damping_time`)."},
        {.name = "stiffness",
         .type = K::kChoice,
         .default_text = "\"auto\"",
         .choices = {"auto", "none"},
         .doc =
             "Of contacts whose joint has no stiffness. `auto`: under the largest stress that the model gives to be "
             "foreseen a face closes by 1e-5 of its length, less than rock itself, so that redundant contacts "
             "share a load in one way and large masses can be solved (theory 4.22). `none`: nothing gives; with "
             "`law = \"smoothed\"` it never does."},
        {.name = "slop",
         .range = {.min = 0, .max = 1e-2},
         .default_text = "1e-7",
         .doc = "Overlap that is left uncorrected where contacts give nothing: with "
                "`stiffness = \"none\"`. Share of the smaller block's size."},
        {.name = "smoothing_force",
         .dimension = D::kForce,
         .range = kPositive,
         .default_text = "\"1 N\"",
         .doc =
             "Width of the smoothed normal law. With `formulation = \"as_printed\"` it is a bare number, of metres and "
             "newtons alike, and `smoothing_slip` unless given."},
        {.name = "smoothing_slip",
         .dimension = D::kLength,
         .range = kPositive,
         .default_text = "\"6e-8 m\"",
         .doc = "Width of the smoothed friction law: slip per step at which half of the friction acts."}}},

      {"contact_pair",
       SectionShape::kList,
       "Joint between two blocks, grids or regions; it goes before the joints of their edges.",
       {{.name = "between",
         .type = K::kNames,
         .required = true,
         .refers_to = "block, grid or region",
         .doc = "The two names."},
        {.name = "joint", .type = K::kName, .required = true, .refers_to = "joint", .doc = "The joint."}}},

      {"support",
       SectionShape::kList,
       "Points of blocks that are held or moved. Give `point`, `edge` or `along`.",
       {{.name = "name", .type = K::kText, .required = true, .doc = "Unique name."},
        {.name = "point",
         .type = K::kVector,
         .dimension = D::kLength,
         .doc = "A point: all corners there, else the block around it."},
        {.name = "edge",
         .type = K::kPoints,
         .dimension = D::kLength,
         .doc = "A segment [[x0, y0], [x1, y1]]: all block edges on it, held at their corners."},
        {.name = "along",
         .type = K::kName,
         .refers_to = "side, opening, fault or joint set",
         .doc = "All block edges along it, held at their corners."},
        {.name = "block",
         .type = K::kName,
         .refers_to = "block, grid or region",
         .doc = "Only blocks of this name."},
        {.name = "x",
         .type = K::kMotion,
         .default_text = "\"fixed\"",
         .doc =
             "Along x: \"fixed\", \"free\", { velocity = \"HISTORY\" } or { displacement = \"HISTORY\" }."},
        {.name = "y", .type = K::kMotion, .default_text = "\"fixed\"", .doc = "The same along y."},
        stages_key()}}};
}

}  // namespace talus
