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
      {key("kind", Choices{{"anchored", "grouted", "superposed"}}, kRequired, to(&BoltType::kind),
           "`anchored`: a spring between its two ends, which carries tension only. `grouted`: a bar held "
           "along its length by grout that slips at its bond strength, with dowel stiffness where it "
           "crosses a joint. `superposed`: only stiffens the blocks that it passes, for comparison with "
           "the paper."),
       key("diameter", D::kLength, kPositive, Usual{kUsualDiameter}, kRequired, to(&BoltType::diameter),
           "Of the bar."),
       key("young", D::kStress, kPositive, Usual{kUsualBar}, to(&BoltType::young), Default{"\"200 GPa\""},
           "Young's modulus of the bar (default: steel)."),
       key("yield_stress", D::kStress, kPositive, Usual{Range{.min = 1e6, .max = 1e10}},
           "Stress at which the bar yields; or give `yield_force`; none: it never does."),
       key("yield_force", D::kForce, kPositive, "Force at which the bar yields."),
       key("rupture_strain", Range{.min = 0, .max = 1, .min_open = true}, kNoDefault,
           to(&BoltType::rupture_strain),
           "Elongation over length, that of the pretension included, at which the bar breaks for good; "
           "none: it never does."),
       key("spacing", D::kLength, kPositive, kRequired, to(&BoltType::spacing),
           "Distance between bolts out of the plane."),
       key("pretension", D::kForce, kNonNegative, to(&BoltType::pretension),
           "Tension at installation. A grouted bolt with pretension is fixed to the rock at both ends, as "
           "if it had been anchored, tensioned and then grouted."),
       key("grout_stiffness", D::kStress, kPositive, to(&BoltType::grout_stiffness), Default{"\"1 GPa\""},
           "Grouted: force per length and slip between bar and rock (theory 4.21 has a formula)."),
       key("bond_strength", D::kLineForce, kPositive, to(&BoltType::bond_strength), Default{"\"200 kN/m\""},
           "Grouted: force per length at which it slips; pi x hole diameter x strength of the grout."),
       key("dowel_stiffness", D::kLineForce, kNonNegative,
           "Grouted: force across the bar per displacement of a joint along itself; default (theory "
           "4.21): bar as a beam in the grout. 0: none."),
       key("dowel_yield", D::kForce, kPositive,
           "Grouted: largest force across the bar; default: yield force / sqrt(3)."),
       key("segment_length", D::kLength, kPositive, to(&BoltType::segment_length),
           "Grouted: longest piece of bar between two springs of grout; at most 10,000 to a bolt."),
       key("plate", K::kBool, to(&BoltType::plate),
           "Grouted: the end `from` has a face plate, which moves with the rock.")}};
}

SectionSpec bolt_section() {
  return {"bolt",
          SectionShape::kList,
          "A rock bolt along a straight line. It is tied to the blocks as they lie when its stage begins; an "
          "anchored or grouted one must not be tied to a block that a later stage excavates.",
          {key("name", K::kText, kRequired, "Unique name."), use_key(),
           key("from", K::kVector, D::kLength, kRequired, "Its head."),
           key("to", K::kVector, D::kLength, kRequired, "Its end."),
           key("type", K::kName, RefersTo{"bolt_type"}, kRequired, "What it is."),
           key("stage", K::kName, RefersTo{"stage"}, "At whose start it is installed; default: the first.")}};
}

SectionSpec pattern_section() {
  return {
      "bolt_pattern",
      SectionShape::kList,
      "Many bolts of one type, called NAME[0], NAME[1] and so on. Give `opening`, or `center` and `radius` "
      "(radial), or `from` and `to` (a row).",
      {key("name", K::kText, kRequired, "Unique name."), use_key(),
       key("kind", Choices{{"radial", "row"}}, kRequired,
           "`radial`: outwards from the wall of an opening. `row`: parallel, from a line."),
       key("type", K::kName, RefersTo{"bolt_type"}, kRequired, "What they are."),
       key("stage", K::kName, RefersTo{"stage"}, "At whose start they are installed; default: the first."),
       key("length", D::kLength, kPositive, kRequired, "Of each bolt."),
       key("opening", K::kName, RefersTo{"opening"},
           "Radial: bolts begin where rays from its centroid meet its outline."),
       key("center", K::kVector, D::kLength, "Radial, of a circle."),
       key("radius", D::kLength, kPositive, "Radial, of a circle."),
       key("count", K::kInteger, Range{.min = 1, .max = 10000},
           "Radial: number of bolts, evenly over the angles; or give `angle_spacing`."),
       key("angle_spacing", D::kAngle, kPositive, "Radial: angle between bolts."),
       key("angle_from", D::kAngle, Default{"\"0 deg\""},
           "Radial: angle of the first bolt, counter-clockwise from +x."),
       key("angle_to", D::kAngle,
           "Radial: angle of the last bolt; default: once around, without a second bolt at the first."),
       key("from", K::kVector, D::kLength, "Row: head of the first bolt."),
       key("to", K::kVector, D::kLength, "Row: end of the line of heads."),
       key("spacing", D::kLength, kPositive, "Row: distance between heads in the plane."),
       key("direction", D::kAngle, "Row: of the bolts, counter-clockwise from +x.")}};
}

}  // namespace

std::vector<SectionSpec> bolt_sections() { return {type_section(), bolt_section(), pattern_section()}; }

}  // namespace talus
