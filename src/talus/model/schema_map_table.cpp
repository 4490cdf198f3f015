// Drawings and maps: which layers become what, and the cleaning of their lines.

#include "talus/model/map_input.h"
#include "talus/model/schema_tables.h"

namespace talus {

std::vector<SectionSpec> map_sections() {
  std::vector<std::string> units = drawing_unit_names();
  units.insert(units.begin(), "auto");
  return {
      {"map",
       SectionShape::kList,
       "Features of a drawing or map (DXF, shapefile, GeoPackage, GeoJSON) that become sections of the "
       "model: `talus cut` reads it, replaces every `[[map]]` by the sections that come of it and writes "
       "the result as `model.toml`, which every verb takes. Features that no `[[map]]` takes are listed, "
       "with the reason. Where several would take one, the first in the file has it.",
       {key("name", K::kText, kRequired, to(&MapInput::name),
            "Of the section that comes of it; of several NAME-1, NAME-2 ... in the order of the file."),
        key("file", K::kText, kRequired, to(&MapInput::file, &MapInput::where_file),
            "The drawing; the path counts from the folder of the model."),
        key("layer", K::kText, to(&MapInput::layer),
            "Layer of the file; a `*` at the end stands for any text."),
        key("attribute", K::kText, kNoDefault, to(&MapInput::attribute),
            "With `values`: only features whose attribute of this name has one of them."),
        key("values", K::kTexts, kNoDefault, to(&MapInput::values),
            "Texts of the attribute, as they stand in the file."),
        key("unit", Choices{units}, Default{"\"auto\""},
            "Of the coordinates; `auto`: what the file says ($INSUNITS of a DXF, the coordinate system of "
            "others)."),
        key("becomes", Choices{map_use_names()}, kRequired, to(&MapInput::use),
            "`joints`: one `[[traces]]`. `fault`: a `[[fault]]` per line. `outline`, `opening`, `stone`: a "
            "`[[region]]`, an `[[opening]]`, a `[[block]]` per closed line or area; an area has no holes. "
            "`bolt`: a `[[bolt]]` per line, from its first point. `monitor`: a point monitor per point. "
            "`ignored`: nothing, without a warning."),
        key("joint", K::kName, RefersTo{"joint"}, kNoDefault, to(&MapInput::joint),
            "Key `joint` of what it becomes (joints, faults, outlines, openings with kept rock)."),
        key("material", K::kName, RefersTo{"material"}, kNoDefault, to(&MapInput::material),
            "Material of outlines and stones."),
        key("kind", Choices{undriven_kinds()}, Default{"\"deformable\""},
            "Key `kind` of outlines and stones."),
        key("type", K::kName, RefersTo{"bolt_type"}, kNoDefault, to(&MapInput::type), "Type of bolts."),
        key("rock", Choices{{"removed", "kept"}}, to(&MapInput::rock_kept), "Key `rock` of openings.")}},

      {"maps",
       SectionShape::kTable,
       "What holds for all `[[map]]`s. Every change that cleaning makes is counted, and shown in `map.png`.",
       {key("snap", D::kLength, kNonNegative, to(&MapsInput::snap),
            "Ends of joints and faults that stop this near to another line are brought to it, those that "
            "cross it by no more are cut back to it; lines that lie this near to another along their whole "
            "length are left out. 0: only exact duplicates."),
        key("shortest", D::kLength, kNonNegative, to(&MapsInput::shortest),
            "Shorter lines are left out, and points of a line that lie nearer to the one before."),
        key("curve_step", D::kAngle, Range{.min = kDegree, .max = 1.5707963267948966},
            to(&MapsInput::curve_step),
            "Angle between two points of an arc, circle, ellipse or bulge, 1 to 90 deg; a spline has eight "
            "points per control point."),
        key("origin", K::kVector, D::kLength, kNoDefault, to(&MapsInput::origin),
            "Point of the map that becomes (0, 0); none: the lower left corner of all that is taken, in "
            "whole metres, when it lies further from zero than ten times their size; else (0, 0).")}},
  };
}

}  // namespace talus
