// Blocks given one by one and as grids.

#include "talus/model/map_input.h"
#include "talus/model/schema_tables.h"

namespace talus {

std::vector<SectionSpec> block_sections() {
  return {
      {"block",
       SectionShape::kList,
       "One block.",
       {{.name = "name", .type = K::kText, .required = true, .doc = "Unique name."},
        {.name = "polygon",
         .type = K::kPoints,
         .dimension = D::kLength,
         .required = true,
         .doc = "Corners [[x, y], ...] of a simple polygon, in either order, convex or not."},
        {.name = "material",
         .type = K::kName,
         .required = true,
         .refers_to = "material",
         .doc = "Its material."},
        {.name = "kind",
         .type = K::kChoice,
         .default_text = "\"deformable\"",
         .choices = block_kinds(),
         .doc = "`deformable`: constant strain; `rigid`; `fixed`: never moves; `driven`: moves as `motion_*` "
                "say."},
        {.name = "velocity",
         .type = K::kVector,
         .dimension = D::kVelocity,
         .usual = {.max = 3000},
         .default_text = "[0, 0]",
         .doc = "Initial velocity of the centroid."},
        {.name = "spin",
         .dimension = D::kAngularVelocity,
         .default_text = "\"0 rad/s\"",
         .doc = "Initial angular velocity, counter-clockwise."},
        {.name = "motion_x",
         .type = K::kMotion,
         .default_text = "\"fixed\"",
         .doc = "Driven blocks: motion along x."},
        {.name = "motion_y",
         .type = K::kMotion,
         .default_text = "\"fixed\"",
         .doc = "Driven blocks: motion along y."},
        {.name = "motion_rotation",
         .type = K::kMotion,
         .default_text = "\"fixed\"",
         .doc = "Driven blocks: rotation about the centroid, counter-clockwise (velocity in rad/s, "
                "displacement in "
                "rad)."}}},

      {"mesh",
       SectionShape::kList,
       "A plane mesh of Gmsh (.msh 2.2 or 4.1, ASCII) whose triangles and quadrilaterals are blocks, called "
       "NAME[i] in the order of the file from 0. A physical surface called like a material has it, and its "
       "blocks "
       "are the group NAME-SURFACE; a physical curve called like a joint has it, and supports, boundaries "
       "and "
       "loads follow it by its name (`along`).",
       {{.name = "name",
         .type = K::kText,
         .required = true,
         .doc = "Unique name; stands for all its blocks."},
        {.name = "file",
         .type = K::kText,
         .required = true,
         .doc =
             "The mesh; the path counts from the folder of the model. Its content belongs to the hash of the "
             "model."},
        {.name = "unit",
         .type = K::kChoice,
         .default_text = "\"m\"",
         .choices = drawing_unit_names(),
         .doc = "Of its coordinates."},
        {.name = "material",
         .type = K::kName,
         .refers_to = "material",
         .doc = "Of elements whose physical surface is not called like a material."},
        {.name = "joint",
         .type = K::kName,
         .refers_to = "joint",
         .doc =
             "Between its blocks, but along curves called like a joint; none: glued. Its outside meets other "
             "blocks by the joint of `[contact]`."},
        {.name = "kind",
         .type = K::kChoice,
         .default_text = "\"deformable\"",
         .choices = {"deformable", "rigid", "fixed"},
         .doc = "Kind of all its blocks."}}},

      {"grid",
       SectionShape::kList,
       "A rectangle divided into equal blocks. Blocks are named NAME[column,row] or NAME[column,row,k] "
       "(triangles: k "
       "= 0 bottom, 1 right, 2 top, 3 left), counted from 0 at the lower left.",
       {{.name = "name",
         .type = K::kText,
         .required = true,
         .doc = "Unique name; stands for all its blocks."},
        {.name = "min",
         .type = K::kVector,
         .dimension = D::kLength,
         .required = true,
         .doc = "Lower left corner."},
        {.name = "max",
         .type = K::kVector,
         .dimension = D::kLength,
         .required = true,
         .doc = "Upper right corner."},
        {.name = "cells",
         .type = K::kIntegers,
         .range = {.min = 1, .max = 1e6},
         .required = true,
         .doc = "Number of columns and rows."},
        {.name = "pattern",
         .type = K::kChoice,
         .default_text = "\"rectangles\"",
         .choices = {"rectangles", "crossed_triangles"},
         .doc = "One rectangle per cell, or four triangles (both diagonals). A single row of tied rectangles "
                "stretches but cannot bend; use triangles where a body bends."},
        {.name = "material",
         .type = K::kName,
         .required = true,
         .refers_to = "material",
         .doc = "Its material."},
        {.name = "joint",
         .type = K::kName,
         .required = true,
         .refers_to = "joint",
         .doc = "Joint between its blocks, usually a bonded one."},
        {.name = "kind",
         .type = K::kChoice,
         .default_text = "\"deformable\"",
         .choices = {"deformable", "rigid", "fixed"},
         .doc = "Kind of all its blocks."},
        {.name = "velocity",
         .type = K::kVector,
         .dimension = D::kVelocity,
         .usual = {.max = 3000},
         .default_text = "[0, 0]",
         .doc = "Initial velocity of all its blocks."}}},
  };
}

}  // namespace talus
