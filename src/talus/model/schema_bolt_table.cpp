// Rock bolts: what they are made of, where they lie, and patterns of them.

#include "talus/model/schema_tables.h"

namespace talus {

namespace {

SectionSpec type_section() {
  return {
      "bolt_type",
      SectionShape::kNamed,
      "A kind of rock bolt. All forces and stiffnesses are those of one bolt; the model takes them over "
      "`spacing`.",
      {{.name = "kind",
        .type = K::kChoice,
        .required = true,
        .choices = {"anchored", "grouted", "superposed"},
        .doc = "`anchored`: a spring between its two ends, which carries tension only. `grouted`: a bar held "
               "along its length by grout that slips at its bond strength, with dowel stiffness where it "
               "crosses a joint. `superposed`: only stiffens the blocks that it passes, for comparison with "
               "the paper."},
       {.name = "diameter",
        .dimension = D::kLength,
        .range = kPositive,
        .usual = {.min = 5e-4, .max = 1},  // of a model's wire and a pile
        .required = true,
        .doc = "Of the bar."},
       {.name = "young",
        .dimension = D::kStress,
        .range = kPositive,
        .usual = {.min = 1e8, .max = 1e12},  // of fibres and steel
        .default_text = "\"200 GPa\"",
        .doc = "Young's modulus of the bar (default: steel)."},
       {.name = "yield_stress",
        .dimension = D::kStress,
        .range = kPositive,
        .usual = {.min = 1e6, .max = 1e10},
        .doc = "Stress at which the bar yields; or give `yield_force`; none: it never does."},
       {.name = "yield_force",
        .dimension = D::kForce,
        .range = kPositive,
        .doc = "Force at which the bar yields."},
       {.name = "rupture_strain",
        .range = {.min = 0, .max = 1, .min_open = true},
        .doc = "Elongation over length, that of the pretension included, at which the bar breaks for good; "
               "none: it never does."},
       {.name = "spacing",
        .dimension = D::kLength,
        .range = kPositive,
        .required = true,
        .doc = "Distance between bolts out of the plane."},
       {.name = "pretension",
        .dimension = D::kForce,
        .range = kNonNegative,
        .default_text = "\"0 N\"",
        .doc =
            "Tension at installation. A grouted bolt with pretension is fixed to the rock at both ends, as "
            "if it had been anchored, tensioned and then grouted."},
       {.name = "grout_stiffness",
        .dimension = D::kStress,
        .range = kPositive,
        .default_text = "\"1 GPa\"",
        .doc = "Grouted: force per length and slip between bar and rock (theory 4.21 has a formula)."},
       {.name = "bond_strength",
        .dimension = D::kLineForce,
        .range = kPositive,
        .default_text = "\"200 kN/m\"",
        .doc = "Grouted: force per length at which it slips; pi x hole diameter x strength of the grout."},
       {.name = "dowel_stiffness",
        .dimension = D::kLineForce,
        .range = kNonNegative,
        .doc = "Grouted: force across the bar per displacement of a joint along itself; default (theory "
               "4.21): bar as a beam in the grout. 0: none."},
       {.name = "dowel_yield",
        .dimension = D::kForce,
        .range = kPositive,
        .doc = "Grouted: largest force across the bar; default: yield force / sqrt(3)."},
       {.name = "segment_length",
        .dimension = D::kLength,
        .range = kPositive,
        .default_text = "\"0.25 m\"",
        .doc = "Grouted: longest piece of bar between two springs of grout; at most 10,000 to a bolt."},
       {.name = "plate",
        .type = K::kBool,
        .default_text = "false",
        .doc = "Grouted: the end `from` has a face plate, which moves with the rock."}}};
}

SectionSpec bolt_section() {
  return {
      "bolt",
      SectionShape::kList,
      "A rock bolt along a straight line. It is tied to the blocks as they lie when its stage begins; an "
      "anchored or grouted one must not be tied to a block that a later stage excavates.",
      {{.name = "name", .type = K::kText, .required = true, .doc = "Unique name."},
       use_key(),
       {.name = "from", .type = K::kVector, .dimension = D::kLength, .required = true, .doc = "Its head."},
       {.name = "to", .type = K::kVector, .dimension = D::kLength, .required = true, .doc = "Its end."},
       {.name = "type", .type = K::kName, .required = true, .refers_to = "bolt_type", .doc = "What it is."},
       {.name = "stage",
        .type = K::kName,
        .refers_to = "stage",
        .doc = "At whose start it is installed; default: the first."}}};
}

SectionSpec pattern_section() {
  return {
      "bolt_pattern",
      SectionShape::kList,
      "Many bolts of one type, called NAME[0], NAME[1] and so on. Give `opening`, or `center` and `radius` "
      "(radial), or `from` and `to` (a row).",
      {{.name = "name", .type = K::kText, .required = true, .doc = "Unique name."},
       use_key(),
       {.name = "kind",
        .type = K::kChoice,
        .required = true,
        .choices = {"radial", "row"},
        .doc = "`radial`: outwards from the wall of an opening. `row`: parallel, from a line."},
       {.name = "type",
        .type = K::kName,
        .required = true,
        .refers_to = "bolt_type",
        .doc = "What they are."},
       {.name = "stage",
        .type = K::kName,
        .refers_to = "stage",
        .doc = "At whose start they are installed; default: the first."},
       {.name = "length",
        .dimension = D::kLength,
        .range = kPositive,
        .required = true,
        .doc = "Of each bolt."},
       {.name = "opening",
        .type = K::kName,
        .refers_to = "opening",
        .doc = "Radial: bolts begin where rays from its centroid meet its outline."},
       {.name = "center", .type = K::kVector, .dimension = D::kLength, .doc = "Radial, of a circle."},
       {.name = "radius", .dimension = D::kLength, .range = kPositive, .doc = "Radial, of a circle."},
       {.name = "count",
        .type = K::kInteger,
        .range = {.min = 1, .max = 10000},
        .doc = "Radial: number of bolts, evenly over the angles; or give `angle_spacing`."},
       {.name = "angle_spacing",
        .dimension = D::kAngle,
        .range = kPositive,
        .doc = "Radial: angle between bolts."},
       {.name = "angle_from",
        .dimension = D::kAngle,
        .default_text = "\"0 deg\"",
        .doc = "Radial: angle of the first bolt, counter-clockwise from +x."},
       {.name = "angle_to",
        .dimension = D::kAngle,
        .doc = "Radial: angle of the last bolt; default: once around, without a second bolt at the first."},
       {.name = "from", .type = K::kVector, .dimension = D::kLength, .doc = "Row: head of the first bolt."},
       {.name = "to", .type = K::kVector, .dimension = D::kLength, .doc = "Row: end of the line of heads."},
       {.name = "spacing",
        .dimension = D::kLength,
        .range = kPositive,
        .doc = "Row: distance between heads in the plane."},
       {.name = "direction",
        .dimension = D::kAngle,
        .doc = "Row: of the bolts, counter-clockwise from +x."}}};
}

}  // namespace

std::vector<SectionSpec> bolt_sections() { return {type_section(), bolt_section(), pattern_section()}; }

}  // namespace talus
