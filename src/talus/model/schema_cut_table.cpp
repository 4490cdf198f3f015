// What is cut into blocks, and along what.

#include "talus/model/schema_tables.h"

namespace talus {

std::vector<SectionSpec> cut_sections() {
  return {
      {"region",
       SectionShape::kList,
       "A piece of the section that joints, faults, masonry or a sub-division cut into blocks. Its blocks "
       "are named NAME[number]. Where regions overlap, the later one in the file holds, and an arch before "
       "any.",
       {key("name", K::kText, kRequired, "Unique name; stands for all its blocks."),
        key("polygon", K::kPoints, D::kLength, kRequired,
            "Outline [[x, y], ...], a simple polygon in either order."),
        key("sides", K::kTexts,
            "One name per edge of the polygon, the first for the edge from the first to the second "
            "corner; a name may come more than once. None: NAME-1, NAME-2 ... Supports take these names "
            "(`along`)."),
        key("material", K::kName, RefersTo{"material"}, kRequired, "Its material."),
        key("joint", K::kName, RefersTo{"joint"},
            "Joint of all block edges inside whose trace names none; none: that of `[contact]`."),
        key("kind", Choices{undriven_kinds()}, Default{"\"deformable\""}, "Kind of all its blocks."),
        rotate_key(), rotate_about_key(), move_key(),
        key("sliver_area", D::kArea, kNonNegative, "Least area of its blocks; none: that of `[cut]`."),
        key("sliver_width", D::kLength, kNonNegative, "Least width of its blocks; none: that of `[cut]`.")}},

      {"arch",
       SectionShape::kList,
       "A ring of equal voussoirs with straight faces: a region of its own. Its sides are called "
       "NAME-intrados, NAME-extrados, NAME-start and NAME-end.",
       {key("name", K::kText, kRequired, "Unique name; stands for all its blocks."),
        key("center", K::kVector, D::kLength, kRequired, "Centre of the ring."),
        key("radius", D::kLength, kPositive, kRequired, "Radius of the intrados at the joints."),
        key("thickness", D::kLength, kPositive, kRequired, "From intrados to extrados."),
        key("from", D::kAngle, Default{"\"0 deg\""},
            "Angle of the first springing, counter-clockwise from +x."),
        key("to", D::kAngle, Default{"\"180 deg\""}, "Angle of the last springing."),
        key("voussoirs", K::kInteger, Range{.min = 1, .max = 1e5}, kRequired, "Number of blocks."),
        key("material", K::kName, RefersTo{"material"}, kRequired, "Its material."),
        key("joint", K::kName, RefersTo{"joint"}, "Joint between the voussoirs; none: that of `[contact]`."),
        key("kind", Choices{undriven_kinds()}, Default{"\"deformable\""}, "Kind of all its blocks."),
        rotate_key(), rotate_about_key("Point it is turned about; none: `center`."), move_key()}},

      {"joint_set",
       SectionShape::kList,
       "Parallel joints. Give `angle`, or `dip` and `dip_direction` with `cut.section_azimuth`. Quantities "
       "that scatter are written `{ mean = \"3 m\", normal = \"0.5 m\" }` (standard deviation), `{ mean = "
       "\"3 m\", uniform = \"1 m\" }` (half width) or `{ exponential = \"3 m\" }` (mean); values that must "
       "be positive and are not are drawn again. Ends that stop inside a block are taken back to the last "
       "crossing.",
       {key("name", K::kText, kRequired, "Unique name."),
        key("angle", K::kScattered, D::kAngle, "Of the traces, counter-clockwise from +x."),
        key("dip", D::kAngle, Range{.min = 0, .max = 1.5707963267948966},
            "Steepest slope of the joint planes below the horizontal, 0 to 90 deg."),
        key("dip_direction", D::kAngle, "Direction in which the planes dip, clockwise from north."),
        key("fisher", Range{.min = 0, .max = 1e6}, Default{"0"},
            "With `dip`: concentration of the poles about their mean (Fisher's kappa); 0: no scatter."),
        key("spacing", K::kScattered, D::kLength, kPositive, kRequired,
            "Distance between neighbours, across: with `angle` that of the traces, with `dip` the true "
            "one of the planes."),
        key("trace_length", K::kScattered, D::kLength, kPositive,
            "Length of each trace; none: through-going."),
        key("gap", K::kScattered, D::kLength, kNonNegative, Default{"\"0 m\""},
            "Length of rock between two traces on one line."),
        key("origin", K::kVector, D::kLength, Default{"[0, 0]"},
            "A point that one of the lines passes through."),
        key("offset", K::kScattered, D::kLength, Default{"\"0 m\""},
            "Distance of that line from the origin, to the left of the direction `angle`; drawn once."),
        key("start", K::kScattered, D::kLength, Default{"\"0 m\""},
            "Where a trace begins on each line, along `angle` from the foot of the origin; drawn for "
            "each line."),
        key("region", K::kName, RefersTo{"region"}, "Only in this region; none: in all."),
        key("joint", K::kName, RefersTo{"joint"},
            "Joint of the block edges along it; none: that of the region.")}},

      {"fault",
       SectionShape::kList,
       "A single joint, straight or bent.",
       {key("name", K::kText, kRequired, "Unique name."),
        key("points", K::kPoints, D::kLength, kRequired,
            "Points [[x, y], ...] from end to end, two or more."),
        key("joint", K::kName, RefersTo{"joint"},
            "Joint of the block edges along it; none: that of the region.")}},

      {"traces",
       SectionShape::kList,
       "Joints of one set as they were surveyed, each with its own line. Ends that stop inside a block are "
       "taken back to the last crossing. `talus import` writes this section from a map.",
       {key("name", K::kText, kRequired, "Unique name."),
        key("lines", K::kLines, D::kLength, kRequired,
            "Lines [[[x, y], [x, y], ...], ...], each of two points or more from end to end."),
        key("joint", K::kName, RefersTo{"joint"},
            "Joint of the block edges along them; none: that of the region.")}},

      {"opening",
       SectionShape::kList,
       "An excavation: its boundary always becomes block edges, and its rock is taken out, or kept as a "
       "group of its own. Curves are drawn with equal-area segments: the polygon has the area of the curve.",
       {key("name", K::kText, kRequired, "Unique name."),
        key("shape", Choices{{"circle", "horseshoe", "polygon"}}, kRequired,
            "`circle`: `center`, `diameter`. `horseshoe`: half a circle over straight walls and a flat "
            "floor: `center` of the half circle, `width`, `height` from floor to crown. `polygon`: "
            "`polygon`."),
        key("center", K::kVector, D::kLength, "Centre of the circle or half circle."),
        key("diameter", D::kLength, kPositive, "Of the circle."),
        key("width", D::kLength, kPositive, "Of the horseshoe."),
        key("height", D::kLength, kPositive, "Of the horseshoe, at least half its width."),
        key("polygon", K::kPoints, D::kLength, "Corners [[x, y], ...]."),
        key("segments", K::kInteger, Range{.min = 3, .max = 1e4}, Default{"32"},
            "Straight pieces of the circle, or of the half circle of the horseshoe."),
        key("rock", Choices{{"removed", "kept"}}, Default{"\"removed\""},
            "`removed`: taken out before the run. `kept`: stays, as the blocks NAME[number]. Numbers of "
            "all other blocks are the same either way."),
        key("joint", K::kName, RefersTo{"joint"}, "With kept rock: joint along the boundary; none: glued.")}},

      {"masonry",
       SectionShape::kList,
       "Running bond in a region: courses of equal blocks, every second one shifted. Its joints are called "
       "NAME-bed and NAME-head.",
       {key("name", K::kText, kRequired, "Unique name."),
        key("region", K::kName, RefersTo{"region"}, kRequired, "The region it fills."),
        key("length", D::kLength, kPositive, kRequired, "Of a block."),
        key("height", D::kLength, kPositive, kRequired, "Of a course."),
        key("overlap", Range{.min = 0, .max = 1, .max_open = true}, Default{"0.5"},
            "Shift of every second course, as share of the length."),
        key("origin", K::kVector, D::kLength, Default{"[0, 0]"},
            "Lower left corner of a block of an unshifted course."),
        key("bed_joint", K::kName, RefersTo{"joint"}, "Joint between courses; none: that of the region."),
        key("head_joint", K::kName, RefersTo{"joint"},
            "Joint between blocks of a course; none: that of the region.")}},

      {"tessellation",
       SectionShape::kList,
       "Artificial sub-division of a region into cells.",
       {key("name", K::kText, kRequired, "Unique name."),
        key("region", K::kName, RefersTo{"region"}, kRequired, "The region it divides."),
        key("cells", Choices{{"voronoi", "triangles"}}, kRequired,
            "Voronoi polygons, or triangles (Delaunay), which as glued cells bend freely."),
        key("size", D::kLength, kPositive, kRequired,
            "Square root of the mean area of Voronoi cells; mean edge of triangles."),
        key("irregularity", Range{.min = 0, .max = 1}, Default{"0.5"},
            "0: a regular lattice of points; 1: each moved by up to half their distance."),
        key("joint", K::kName, RefersTo{"joint"}, "Joint between the cells; none: glued.")}},

      {"cut",
       SectionShape::kTable,
       "How regions are cut into blocks.",
       {key("section_azimuth", D::kAngle,
            "Direction of +x of the section, clockwise from north; needed by joint sets given by dip."),
        key("seed", K::kInteger, Range{.min = 0}, Default{"1"},
            "Of everything drawn at random. The same seed gives the same blocks on every machine."),
        key("grid", K::kQuantityAuto, D::kLength, kPositive, Default{"\"auto\""},
            "Corners lie on a grid of this width, rounded down to a power of two; `auto`: 2^-20 m, or "
            "finer for models below 95 m (1e-8 of their size)."),
        key("slivers", Choices{{"keep", "merge", "delete"}}, Default{"\"keep\""},
            "What becomes of blocks below one of the four limits: `keep`: they stay, whatever step they ask "
            "for (`talus check` says what merging would buy); `merge`: those inside the rock are joined to "
            "a neighbour across edges of joint sets, never across a fault, a surveyed trace or an edge that "
            "ends at a free face; `delete`: taken out. `merge` and `delete` may hide a mechanism: `talus "
            "safety` refuses them unless `safety.accept_merged`. Needles without a joint of their own "
            "(theory.md 10.3) are merged whatever is said here."),
        key("merge_along", K::kTexts,
            "Joint sets whose lines merging may interrupt although they reach the outline or an opening: "
            "such a line may be the one that something slides on. None: only lines that end inside."),
        key("sliver_area", D::kArea, kNonNegative, Default{"\"0 m2\""}, "Least area of a block."),
        key("sliver_width", D::kLength, kNonNegative, Default{"\"0 m\""},
            "Least width of a block: of the rectangle with the same smaller second moment and area."),
        key("sliver_area_share", Range{.min = 0, .max = 0.5}, Default{"0.02"},
            "The same as share of the median area of the blocks of the region."),
        key("sliver_width_share", Range{.min = 0, .max = 0.5}, Default{"0.3"},
            "The same as share of the median width; merged, it bounds the loss of time step."),
        key("blocks", K::kText,
            "A blocks file of an earlier `talus cut` of the same regions and joints, relative to the "
            "model file: it is read instead of cutting again.")}},
  };
}

}  // namespace talus
