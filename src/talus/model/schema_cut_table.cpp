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
       {key("name", K::kText, kRequired, to(&RegionInput::name), "Unique name; stands for all its blocks."),
        key("polygon", K::kPoints, D::kLength, kRequired, to(&RegionInput::polygon),
            "Outline [[x, y], ...], a simple polygon in either order."),
        key("sides", K::kTexts, kNoDefault, to(&RegionInput::sides),
            "One name per edge of the polygon, the first for the edge from the first to the second "
            "corner; a name may come more than once. None: NAME-1, NAME-2 ... Supports take these names "
            "(`along`)."),
        key("material", K::kName, RefersTo{"material"}, kRequired, "Its material."),
        key("joint", K::kName, RefersTo{"joint"},
            "Joint of all block edges inside whose trace names none; none: that of `[contact]`."),
        key("kind", Choices{undriven_kinds()}, to(&RegionInput::kind), "Kind of all its blocks."),
        rotate_key(), rotate_about_key(), move_key(),
        key("sliver_area", D::kArea, kNonNegative, kNoDefault, to(&RegionInput::sliver_area),
            "Least area of its blocks; none: that of `[cut]`."),
        key("sliver_width", D::kLength, kNonNegative, kNoDefault, to(&RegionInput::sliver_width),
            "Least width of its blocks; none: that of `[cut]`.")}},

      {"arch",
       SectionShape::kList,
       "A ring of equal voussoirs with straight faces: a region of its own. Its sides are called "
       "NAME-intrados, NAME-extrados, NAME-start and NAME-end.",
       {key("name", K::kText, kRequired, to(&ArchInput::name), "Unique name; stands for all its blocks."),
        key("center", K::kVector, D::kLength, kRequired, to(&ArchInput::center), "Centre of the ring."),
        key("radius", D::kLength, kPositive, kRequired, to(&ArchInput::radius),
            "Radius of the intrados at the joints."),
        key("thickness", D::kLength, kPositive, kRequired, to(&ArchInput::thickness),
            "From intrados to extrados."),
        key("from", D::kAngle, to(&ArchInput::from),
            "Angle of the first springing, counter-clockwise from +x."),
        key("to", D::kAngle, to(&ArchInput::to), "Angle of the last springing."),
        key("voussoirs", K::kInteger, Range{.min = 1, .max = 1e5}, kRequired, to(&ArchInput::voussoirs),
            "Number of blocks."),
        key("material", K::kName, RefersTo{"material"}, kRequired, "Its material."),
        key("joint", K::kName, RefersTo{"joint"}, "Joint between the voussoirs; none: that of `[contact]`."),
        key("kind", Choices{undriven_kinds()}, to(&ArchInput::kind), "Kind of all its blocks."), rotate_key(),
        rotate_about_key("Point it is turned about; none: `center`."), move_key()}},

      {"joint_set",
       SectionShape::kList,
       "Parallel joints. Give `angle`, or `dip` and `dip_direction` with `cut.section_azimuth`. Quantities "
       "that scatter are written `{ mean = \"3 m\", normal = \"0.5 m\" }` (standard deviation), `{ mean = "
       "\"3 m\", uniform = \"1 m\" }` (half width) or `{ exponential = \"3 m\" }` (mean); values that must "
       "be positive and are not are drawn again. Ends that stop inside a block are taken back to the last "
       "crossing.",
       {key("name", K::kText, kRequired, to(&JointSetInput::name), "Unique name."),
        key("angle", K::kScattered, D::kAngle, kNoDefault, to(&JointSetInput::angle),
            "Of the traces, counter-clockwise from +x."),
        key("dip", D::kAngle, Range{.min = 0, .max = 1.5707963267948966}, kNoDefault, to(&JointSetInput::dip),
            "Steepest slope of the joint planes below the horizontal, 0 to 90 deg."),
        key("dip_direction", D::kAngle, kNoDefault, to(&JointSetInput::dip_direction),
            "Direction in which the planes dip, clockwise from north."),
        key("fisher", Range{.min = 0, .max = 1e6}, to(&JointSetInput::fisher),
            "With `dip`: concentration of the poles about their mean (Fisher's kappa); 0: no scatter."),
        key("spacing", K::kScattered, D::kLength, kPositive, kRequired, to(&JointSetInput::spacing),
            "Distance between neighbours, across: with `angle` that of the traces, with `dip` the true "
            "one of the planes."),
        key("trace_length", K::kScattered, D::kLength, kPositive, kNoDefault,
            to(&JointSetInput::trace_length), "Length of each trace; none: through-going."),
        key("gap", K::kScattered, D::kLength, kNonNegative, to(&JointSetInput::gap),
            "Length of rock between two traces on one line."),
        key("origin", K::kVector, D::kLength, to(&JointSetInput::origin),
            "A point that one of the lines passes through."),
        key("offset", K::kScattered, D::kLength, to(&JointSetInput::offset),
            "Distance of that line from the origin, to the left of the direction `angle`; drawn once."),
        key("start", K::kScattered, D::kLength, to(&JointSetInput::start),
            "Where a trace begins on each line, along `angle` from the foot of the origin; drawn for "
            "each line."),
        key("region", K::kName, RefersTo{"region"}, "Only in this region; none: in all."),
        key("joint", K::kName, RefersTo{"joint"},
            "Joint of the block edges along it; none: that of the region.")}},

      {"fault",
       SectionShape::kList,
       "A single joint, straight or bent.",
       {key("name", K::kText, kRequired, to(&FaultInput::name), "Unique name."),
        key("points", K::kPoints, D::kLength, kRequired, to(&FaultInput::points),
            "Points [[x, y], ...] from end to end, two or more."),
        key("joint", K::kName, RefersTo{"joint"},
            "Joint of the block edges along it; none: that of the region.")}},

      {"traces",
       SectionShape::kList,
       "Joints of one set as they were surveyed, each with its own line. Ends that stop inside a block are "
       "taken back to the last crossing. `talus import` writes this section from a map.",
       {key("name", K::kText, kRequired, to(&TracesInput::name), "Unique name."),
        key("lines", K::kLines, D::kLength, kRequired, to(&TracesInput::lines),
            "Lines [[[x, y], [x, y], ...], ...], each of two points or more from end to end."),
        key("joint", K::kName, RefersTo{"joint"},
            "Joint of the block edges along them; none: that of the region.")}},

      {"opening",
       SectionShape::kList,
       "An excavation: its boundary always becomes block edges, and its rock is taken out, or kept as a "
       "group of its own. Curves are drawn with equal-area segments: the polygon has the area of the curve.",
       {key("name", K::kText, kRequired, to(&OpeningInput::name), "Unique name."),
        key("shape", Choices{{"circle", "horseshoe", "polygon"}}, kRequired, to(&OpeningInput::shape),
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
        key("rock", Choices{{"removed", "kept"}}, to(&OpeningInput::kept),
            "`removed`: taken out before the run. `kept`: stays, as the blocks NAME[number]. Numbers of "
            "all other blocks are the same either way."),
        key("joint", K::kName, RefersTo{"joint"}, "With kept rock: joint along the boundary; none: glued.")}},

      {"masonry",
       SectionShape::kList,
       "Running bond in a region: courses of equal blocks, every second one shifted. Its joints are called "
       "NAME-bed and NAME-head.",
       {key("name", K::kText, kRequired, to(&MasonryInput::name), "Unique name."),
        key("region", K::kName, RefersTo{"region"}, kRequired, "The region it fills."),
        key("length", D::kLength, kPositive, kRequired, to(&MasonryInput::length), "Of a block."),
        key("height", D::kLength, kPositive, kRequired, to(&MasonryInput::height), "Of a course."),
        key("overlap", Range{.min = 0, .max = 1, .max_open = true}, to(&MasonryInput::overlap),
            "Shift of every second course, as share of the length."),
        key("origin", K::kVector, D::kLength, to(&MasonryInput::origin),
            "Lower left corner of a block of an unshifted course."),
        key("bed_joint", K::kName, RefersTo{"joint"}, "Joint between courses; none: that of the region."),
        key("head_joint", K::kName, RefersTo{"joint"},
            "Joint between blocks of a course; none: that of the region.")}},

      {"tessellation",
       SectionShape::kList,
       "Artificial sub-division of a region into cells.",
       {key("name", K::kText, kRequired, to(&TessellationInput::name), "Unique name."),
        key("region", K::kName, RefersTo{"region"}, kRequired, "The region it divides."),
        key("cells", Choices{{"voronoi", "triangles"}}, kRequired, to(&TessellationInput::triangles),
            "Voronoi polygons, or triangles (Delaunay), which as glued cells bend freely."),
        key("size", D::kLength, kPositive, kRequired, to(&TessellationInput::size),
            "Square root of the mean area of Voronoi cells; mean edge of triangles."),
        key("irregularity", Range{.min = 0, .max = 1}, to(&TessellationInput::irregularity),
            "0: a regular lattice of points; 1: each moved by up to half their distance."),
        key("joint", K::kName, RefersTo{"joint"}, "Joint between the cells; none: glued.")}},

      {"cut",
       SectionShape::kTable,
       "How regions are cut into blocks.",
       {key("section_azimuth", D::kAngle, kNoDefault, to(&CutInput::section_azimuth),
            "Direction of +x of the section, clockwise from north; needed by joint sets given by dip."),
        key("seed", K::kInteger, Range{.min = 0}, to(&CutInput::seed),
            "Of everything drawn at random. The same seed gives the same blocks on every machine."),
        key("grid", K::kQuantityAuto, D::kLength, kPositive, to(&CutInput::grid, &CutInput::where_grid),
            "Corners lie on a grid of this width, rounded down to a power of two; `auto`: 2^-20 m, or "
            "finer for models below 95 m (1e-8 of their size)."),
        key("slivers", Choices{{"keep", "merge", "delete"}}, to(&CutInput::slivers, &CutInput::where_slivers),
            "What becomes of blocks below one of the four limits: `keep`: they stay, whatever step they ask "
            "for (`talus check` says what merging would buy); `merge`: those inside the rock are joined to "
            "a neighbour across edges of joint sets, never across a fault, a surveyed trace or an edge that "
            "ends at a free face; `delete`: taken out. `merge` and `delete` may hide a mechanism: `talus "
            "safety` refuses them unless `safety.accept_merged`. Needles without a joint of their own "
            "(theory.md 10.3) are merged whatever is said here."),
        key("merge_along", K::kTexts, kNoDefault, to(&CutInput::merge_along),
            "Joint sets whose lines merging may interrupt although they reach the outline or an opening: "
            "such a line may be the one that something slides on. None: only lines that end inside."),
        key("sliver_area", D::kArea, kNonNegative, to(&CutInput::sliver_area), "Least area of a block."),
        key("sliver_width", D::kLength, kNonNegative, to(&CutInput::sliver_width),
            "Least width of a block: of the rectangle with the same smaller second moment and area."),
        key("sliver_area_share", Range{.min = 0, .max = 0.5}, to(&CutInput::sliver_area_share),
            "The same as share of the median area of the blocks of the region."),
        key("sliver_width_share", Range{.min = 0, .max = 0.5}, to(&CutInput::sliver_width_share),
            "The same as share of the median width; merged, it bounds the loss of time step."),
        key("blocks", K::kText, kNoDefault, to(&CutInput::blocks_file),
            "A blocks file of an earlier `talus cut` of the same regions and joints, relative to the "
            "model file: it is read instead of cutting again.")}},
  };
}

}  // namespace talus
