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
       {{.name = "name",
         .type = K::kText,
         .required = true,
         .doc = "Of the section that comes of it; of several NAME-1, NAME-2 ... in the order of the file."},
        {.name = "file",
         .type = K::kText,
         .required = true,
         .doc = "The drawing; the path counts from the folder of the model."},
        {.name = "layer",
         .type = K::kText,
         .default_text = "\"*\"",
         .doc = "Layer of the file; a `*` at the end stands for any text."},
        {.name = "attribute",
         .type = K::kText,
         .doc = "With `values`: only features whose attribute of this name has one of them."},
        {.name = "values", .type = K::kTexts, .doc = "Texts of the attribute, as they stand in the file."},
        {.name = "unit",
         .type = K::kChoice,
         .default_text = "\"auto\"",
         .choices = units,
         .doc =
             "Of the coordinates; `auto`: what the file says ($INSUNITS of a DXF, the coordinate system of "
             "others)."},
        {.name = "becomes",
         .type = K::kChoice,
         .required = true,
         .choices = map_use_names(),
         .doc =
             "`joints`: one `[[traces]]`. `fault`: a `[[fault]]` per line. `outline`, `opening`, `stone`: a "
             "`[[region]]`, an `[[opening]]`, a `[[block]]` per closed line or area; an area has no holes. "
             "`bolt`: a `[[bolt]]` per line, from its first point. `monitor`: a point monitor per point. "
             "`ignored`: nothing, without a warning."},
        {.name = "joint",
         .type = K::kName,
         .refers_to = "joint",
         .doc = "Key `joint` of what it becomes (joints, faults, outlines, openings with kept rock)."},
        {.name = "material",
         .type = K::kName,
         .refers_to = "material",
         .doc = "Material of outlines and stones."},
        {.name = "kind",
         .type = K::kChoice,
         .default_text = "\"deformable\"",
         .choices = undriven_kinds(),
         .doc = "Key `kind` of outlines and stones."},
        {.name = "type", .type = K::kName, .refers_to = "bolt_type", .doc = "Type of bolts."},
        {.name = "rock",
         .type = K::kChoice,
         .default_text = "\"removed\"",
         .choices = {"removed", "kept"},
         .doc = "Key `rock` of openings."}}},

      {"maps",
       SectionShape::kTable,
       "What holds for all `[[map]]`s. Every change that cleaning makes is counted, and shown in `map.png`.",
       {{.name = "snap",
         .dimension = D::kLength,
         .range = kNonNegative,
         .default_text = "\"0 m\"",
         .doc =
             "Ends of joints and faults that stop this near to another line are brought to it, those that "
             "cross it by no more are cut back to it; lines that lie this near to another along their whole "
             "length are left out. 0: only exact duplicates."},
        {.name = "shortest",
         .dimension = D::kLength,
         .range = kNonNegative,
         .default_text = "\"0 m\"",
         .doc = "Shorter lines are left out, and points of a line that lie nearer to the one before."},
        {.name = "curve_step",
         .dimension = D::kAngle,
         .range = {.min = kDegree, .max = 1.5707963267948966},
         .default_text = "\"10 deg\"",
         .doc =
             "Angle between two points of an arc, circle, ellipse or bulge, 1 to 90 deg; a spline has eight "
             "points per control point."},
        {.name = "origin",
         .type = K::kVector,
         .dimension = D::kLength,
         .doc = "Point of the map that becomes (0, 0); none: the lower left corner of all that is taken, in "
                "whole metres, when it lies further from zero than ten times their size; else (0, 0)."}}},
  };
}

}  // namespace talus
