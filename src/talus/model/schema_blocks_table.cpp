// Blocks given one by one and as grids.

#include "talus/model/map_input.h"
#include "talus/model/schema_tables.h"

namespace talus {

std::vector<SectionSpec> block_sections() {
  return {
      {"block",
       SectionShape::kList,
       "One block.",
       {key("name", K::kText, kRequired, to(&BlockInput::name), "Unique name."),
        key("polygon", K::kPoints, D::kLength, kRequired, to(&BlockInput::polygon),
            "Corners [[x, y], ...] of a simple polygon, in either order, convex or not."),
        key("material", K::kName, RefersTo{"material"}, kRequired, "Its material."),
        key("kind", Choices{block_kinds()}, to(&BlockInput::kind),
            "`deformable`: constant strain; `rigid`; `fixed`: never moves; `driven`: moves as `motion_*` "
            "say."),
        rotate_key(), rotate_about_key(), move_key(),
        key("velocity", K::kVector, D::kVelocity, Usual{Range{.max = 3000}}, to(&BlockInput::velocity),
            "Initial velocity of the centroid."),
        key("spin", D::kAngularVelocity, to(&BlockInput::spin),
            "Initial angular velocity, counter-clockwise."),
        key("motion_x", K::kMotion, Default{"\"fixed\""}, "Driven blocks: motion along x."),
        key("motion_y", K::kMotion, Default{"\"fixed\""}, "Driven blocks: motion along y."),
        key("motion_rotation", K::kMotion, Default{"\"fixed\""},
            "Driven blocks: rotation about the centroid, counter-clockwise (velocity in rad/s, "
            "displacement in rad).")}},

      {"mesh",
       SectionShape::kList,
       "A plane mesh of Gmsh (.msh 2.2 or 4.1, ASCII) whose triangles and quadrilaterals are blocks, called "
       "NAME[i] in the order of the file from 0. A physical surface called like a material has it, and its "
       "blocks are the group NAME-SURFACE; a physical curve called like a joint has it, and supports, "
       "boundaries and loads follow it by its name (`along`).",
       {key("name", K::kText, kRequired, to(&MeshInput::name), "Unique name; stands for all its blocks."),
        key("file", K::kText, kRequired,
            "The mesh; the path counts from the folder of the model. Its content belongs to the hash of the "
            "model."),
        key("unit", Choices{drawing_unit_names()}, Default{"\"m\""}, "Of its coordinates."), rotate_key(),
        rotate_about_key("Point it is turned about; none: the middle of its extent."), move_key(),
        key("material", K::kName, RefersTo{"material"},
            "Of elements whose physical surface is not called like a material."),
        key("joint", K::kName, RefersTo{"joint"},
            "Between its blocks, but along curves called like a joint; none: glued. Its outside meets other "
            "blocks by the joint of `[contact]`."),
        key("kind", Choices{undriven_kinds()}, to(&MeshInput::kind), "Kind of all its blocks.")}},

      {"grid",
       SectionShape::kList,
       "A rectangle divided into equal blocks. Blocks are named NAME[column,row] or NAME[column,row,k] "
       "(triangles: k = 0 bottom, 1 right, 2 top, 3 left), counted from 0 at the lower left.",
       {key("name", K::kText, kRequired, to(&GridInput::name), "Unique name; stands for all its blocks."),
        key("min", K::kVector, D::kLength, kRequired, to(&GridInput::min), "Lower left corner."),
        key("max", K::kVector, D::kLength, kRequired, to(&GridInput::max), "Upper right corner."),
        key("cells", K::kIntegers, Range{.min = 1, .max = 1e6}, kRequired, "Number of columns and rows."),
        key("pattern", Choices{{"rectangles", "crossed_triangles"}}, to(&GridInput::pattern),
            "One rectangle per cell, or four triangles (both diagonals). A single row of tied rectangles "
            "stretches but cannot bend; use triangles where a body bends."),
        key("material", K::kName, RefersTo{"material"}, kRequired, "Its material."),
        key("joint", K::kName, RefersTo{"joint"}, kRequired,
            "Joint between its blocks, usually a bonded one."),
        key("kind", Choices{undriven_kinds()}, to(&GridInput::kind), "Kind of all its blocks."), rotate_key(),
        rotate_about_key(), move_key(),
        key("velocity", K::kVector, D::kVelocity, Usual{Range{.max = 3000}}, to(&GridInput::velocity),
            "Initial velocity of all its blocks.")}},
  };
}

}  // namespace talus
