#include "talus/model/schema.h"

#include <fmt/format.h>

#include "talus/base/error.h"

namespace talus {

namespace {

using D = Dimension;
using K = KeyType;

constexpr Range kPositive{.min = 0, .min_open = true};
constexpr Range kNonNegative{.min = 0};

const std::vector<std::string> kKinds{"deformable", "rigid", "fixed", "driven"};

std::vector<SectionSpec> build_schema() {
  return {
      {"top",
       SectionShape::kTop,
       "First lines of the file.",
       {{.name = "talus",
         .type = K::kInteger,
         .range = {.min = 1},
         .required = true,
         .doc =
             "Number of the file format: 1. A newer number is refused, an older one is converted or refused "
             "with the program version that reads it."},
        {.name = "title",
         .type = K::kText,
         .default_text = "\"\"",
         .doc = "Free text, repeated in the results."}}},

      {"model",
       SectionShape::kTable,
       "What holds for the whole model.",
       {{.name = "thickness",
         .dimension = D::kLength,
         .range = kPositive,
         .default_text = "\"1 m\"",
         .doc = "Thickness of the section; all masses and forces carry it."},
        {.name = "plane",
         .type = K::kChoice,
         .default_text = "\"strain\"",
         .choices = {"strain", "stress"},
         .doc = "Plane strain or plane stress."},
        {.name = "gravity",
         .type = K::kVector,
         .dimension = D::kAcceleration,
         .default_text = "[0, 0]",
         .doc = "Acceleration of gravity, for example [0, -9.81]."},
        {.name = "inertia",
         .type = K::kChoice,
         .default_text = "\"consistent\"",
         .choices = {"consistent", "lumped"},
         .doc = "Moments of inertia of deformable blocks: exact, or three times as large (bonded continua "
                "only: a "
                "wave along a bar is then exact at Courant number 1, a free block bounces with e = 0.5 "
                "instead of "
                "0.75)."}}},

      {"material",
       SectionShape::kNamed,
       "Material of blocks.",
       {{.name = "density",
         .dimension = D::kDensity,
         .range = kPositive,
         .required = true,
         .doc = "Mass density."},
        {.name = "young",
         .dimension = D::kStress,
         .range = kPositive,
         .doc = "Young's modulus; needed by deformable blocks."},
        {.name = "poisson",
         .range = {.min = -1, .max = 0.5, .min_open = true, .max_open = true},
         .doc = "Poisson's ratio; needed by deformable blocks."}}},

      {"joint",
       SectionShape::kNamed,
       "Property of the contact between two blocks.",
       {{.name = "kind",
         .type = K::kChoice,
         .default_text = "\"frictional\"",
         .choices = {"frictional", "bonded"},
         .doc = "`bonded`: an artificial joint that never opens or slips (sub-division of one body). "
                "`frictional`: "
                "opens and slips by the strengths below."},
        {.name = "friction_angle",
         .dimension = D::kAngle,
         .range = {.min = 0, .max = 1.5533430342749532, .max_open = false},
         .default_text = "\"0 deg\"",
         .doc = "Friction angle (at most 89 deg)."},
        {.name = "cohesion",
         .dimension = D::kStress,
         .range = kNonNegative,
         .default_text = "\"0 Pa\"",
         .doc = "Cohesion of faces that touch at the start; lost for good, with the tensile strength, when "
                "the face "
                "breaks."},
        {.name = "tensile_strength",
         .dimension = D::kStress,
         .range = kNonNegative,
         .default_text = "\"0 Pa\"",
         .doc = "Tensile strength of faces that touch at the start."},
        {.name = "normal_stiffness",
         .dimension = D::kStiffness,
         .range = kNonNegative,
         .default_text = "\"0 Pa/m\"",
         .doc = "Elastic stiffness kn of the joint per area; 0: hard. Give it to natural rock joints: forces "
                "are then "
                "unique. It costs no time step."},
        {.name = "shear_stiffness",
         .dimension = D::kStiffness,
         .range = kNonNegative,
         .default_text = "\"0 Pa/m\"",
         .doc = "Elastic stiffness ks along the joint per area; 0: hard."},
        {.name = "restitution",
         .range = {.min = 0, .max = 1},
         .doc = "Ratio of the normal velocities after and before a touch; none: what the scheme gives "
                "(docs/theory.md "
                "7.1). Only for hard joints."}}},

      {"history",
       SectionShape::kNamed,
       "A quantity over time, linear between its points, held before the first and after the last. Its clock "
       "runs in dynamic "
       "stages only and starts with the first of them. Give "
       "`time` and "
       "`value`, or `expression` with `duration`.",
       {{.name = "time", .type = K::kNumbers, .dimension = D::kTime, .doc = "Rising times [s]."},
        {.name = "value",
         .type = K::kNumbers,
         .doc = "One value per time, SI (m, m/s, rad or rad/s by its use)."},
        {.name = "expression",
         .type = K::kText,
         .doc =
             "Formula in `t` [s] (muParser: sin, exp, _pi, a ? b : c ...), for example \"sin(2*_pi*5*t)\"."},
        {.name = "duration",
         .dimension = D::kTime,
         .range = kPositive,
         .doc = "With `expression`: the formula is sampled from 0 to here."},
        {.name = "samples",
         .type = K::kInteger,
         .range = {.min = 2, .max = 1e7},
         .default_text = "10000",
         .doc = "With `expression`: number of equal intervals."}}},

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
         .choices = kKinds,
         .doc = "`deformable`: constant strain; `rigid`; `fixed`: never moves; `driven`: moves as `motion_*` "
                "say."},
        {.name = "velocity",
         .type = K::kVector,
         .dimension = D::kVelocity,
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
         .default_text = "[0, 0]",
         .doc = "Initial velocity of all its blocks."}}},

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
                "corrected), "
                "for comparison only: its friction creeps."},
        {.name = "alpha",
         .range = {.min = 0, .max = 1},
         .default_text = "0.2",
         .doc = "Numerical damping of joints with stiffness: 0 loses nothing, 1 is backward Euler."},
        {.name = "slop",
         .range = {.min = 0, .max = 1e-2},
         .default_text = "1e-7",
         .doc = "Overlap of hard contacts that is left uncorrected, as share of the smaller block's size."},
        {.name = "smoothing_force",
         .dimension = D::kForce,
         .range = kPositive,
         .default_text = "\"1 N\"",
         .doc = "Width of the smoothed normal law."},
        {.name = "smoothing_slip",
         .dimension = D::kLength,
         .range = kPositive,
         .default_text = "\"6e-8 m\"",
         .doc = "Width of the smoothed friction law: slip per step at which half of the friction acts."}}},

      {"contact_pair",
       SectionShape::kList,
       "Joint between two blocks or grids.",
       {{.name = "between",
         .type = K::kNames,
         .required = true,
         .refers_to = "block or grid",
         .doc = "The two names."},
        {.name = "joint", .type = K::kName, .required = true, .refers_to = "joint", .doc = "The joint."}}},

      {"support",
       SectionShape::kList,
       "Points of blocks that are held or moved. Give `point` or `edge`.",
       {{.name = "name", .type = K::kText, .required = true, .doc = "Unique name."},
        {.name = "point",
         .type = K::kVector,
         .dimension = D::kLength,
         .doc = "A point: all corners there, else the block around it."},
        {.name = "edge",
         .type = K::kPoints,
         .dimension = D::kLength,
         .doc = "A segment [[x0, y0], [x1, y1]]: all block edges on it, held at their corners."},
        {.name = "block", .type = K::kName, .refers_to = "block or grid", .doc = "Only blocks of this name."},
        {.name = "x",
         .type = K::kMotion,
         .default_text = "\"fixed\"",
         .doc =
             "Along x: \"fixed\", \"free\", { velocity = \"HISTORY\" } or { displacement = \"HISTORY\" }."},
        {.name = "y", .type = K::kMotion, .default_text = "\"fixed\"", .doc = "The same along y."}}},

      {"load",
       SectionShape::kList,
       "A body force on blocks, as an acceleration added to gravity. In static stages it stands at its value "
       "of t = 0 on the clock of the histories.",
       {{.name = "name", .type = K::kText, .required = true, .doc = "Unique name."},
        {.name = "acceleration_x",
         .type = K::kName,
         .refers_to = "history",
         .doc = "History of the acceleration along x [m/s2]. A base that shakes with a(t) is the same as a "
                "load of -a(t) "
                "seen from the base."},
        {.name = "acceleration_y", .type = K::kName, .refers_to = "history", .doc = "The same along y."},
        {.name = "block",
         .type = K::kName,
         .refers_to = "block or grid",
         .doc = "Only blocks of this name; none: all."}}},

      {"solver",
       SectionShape::kTable,
       "Solution of the contact constraint equations.",
       {{.name = "method",
         .type = K::kChoice,
         .default_text = "\"newton\"",
         .choices = {"newton", "gauss_seidel"},
         .doc = "`newton`: semismooth, per island of touching blocks. `gauss_seidel`: projected, point by "
                "point. A step "
                "that one does not solve is tried by the other."},
        {.name = "jacobian",
         .type = K::kChoice,
         .default_text = "\"analytic\"",
         .choices = {"analytic", "difference"},
         .doc = "Sparse analytic Jacobian, or the difference quotients of the paper (dense: small models "
                "only)."},
        {.name = "tolerance",
         .range = {.min = 0, .max = 1e-2, .min_open = true},
         .default_text = "1e-8",
         .doc = "Largest contact error of a step, as share of the smallest block's size."},
        {.name = "max_iterations",
         .type = K::kInteger,
         .range = {.min = 1, .max = 10000},
         .default_text = "60",
         .doc = "Most Newton iterations of a step."},
        {.name = "max_sweeps",
         .type = K::kInteger,
         .range = {.min = 1, .max = 1e7},
         .default_text = "20000",
         .doc = "Most Gauss-Seidel sweeps of a step."},
        {.name = "on_failure",
         .type = K::kChoice,
         .default_text = "\"stop\"",
         .choices = {"stop", "continue"},
         .doc = "A step that misses the tolerance ends the run, or is counted and reported."}}},

      {"stage",
       SectionShape::kList,
       "Stages in the order they run.",
       {{.name = "name", .type = K::kText, .required = true, .doc = "Unique name."},
        {.name = "kind",
         .type = K::kChoice,
         .required = true,
         .choices = {"static", "dynamic"},
         .doc = "`dynamic`: in true time for `duration`. `static`: damped until at rest, at most for "
                "`duration`."},
        {.name = "duration",
         .dimension = D::kTime,
         .range = kPositive,
         .required = true,
         .doc = "Length; for a static stage the limit after which the run stops with an error."},
        {.name = "time_step",
         .type = K::kQuantityAuto,
         .dimension = D::kTime,
         .range = kPositive,
         .default_text = "\"auto\"",
         .doc = "Time step, rounded down so that the stage ends on a step. \"auto\": `safety` times the "
                "stable limit "
                "of the stiffest block."},
        {.name = "safety",
         .range = {.min = 0, .max = 1, .min_open = true, .max_open = true},
         .default_text = "0.8",
         .doc = "With \"auto\": share of the stable limit."},
        {.name = "moment_clamp",
         .type = K::kBool,
         .default_text = "false",
         .doc =
             "With a given `time_step`: raise the moment of inertia of blocks too thin for it (counted and "
             "reported; refused where a block of median size would need it)."},
        {.name = "damping_mass",
         .dimension = D::kRate,
         .range = kNonNegative,
         .default_text = "\"0 1/s\"",
         .doc =
             "Mass-proportional damping: force = -damping_mass x mass x velocity. An oscillation of angular "
             "frequency w gets the damping ratio damping_mass / (2 w)."},
        {.name = "damping_local",
         .range = {.min = 0, .max = 1, .max_open = true},
         .doc = "Local damping: share of a block's unbalanced force that opposes its motion. Default 0.8 in "
                "static, "
                "0 in dynamic stages."},
        {.name = "unbalanced",
         .range = {.min = 0, .max = 0.1, .min_open = true},
         .default_text = "1e-5",
         .doc = "Static stages: at rest when the largest unbalanced force of a block, as share of the mean "
                "force on "
                "blocks, and the share of its peak velocity left are below this."}}},

      {"monitor",
       SectionShape::kList,
       "Columns of histories.csv. Give one of `point`, `block`, `support`, `contact`.",
       {{.name = "name",
         .type = K::kText,
         .required = true,
         .doc = "Unique name; first part of the column titles."},
        {.name = "point",
         .type = K::kVector,
         .dimension = D::kLength,
         .doc = "Displacement and velocity of the material point that is here at the start."},
        {.name = "block", .type = K::kText, .doc = "Cauchy stress of the block of this name."},
        {.name = "support",
         .type = K::kName,
         .refers_to = "support",
         .doc = "Reaction: force of this support on the blocks."},
        {.name = "contact",
         .type = K::kNames,
         .refers_to = "block or grid",
         .doc = "Contact force of the second on the first of two blocks or grids, and its impulse."},
        {.name = "window",
         .dimension = D::kTime,
         .range = kNonNegative,
         .default_text = "\"0 s\"",
         .doc =
             "With `contact`: also the force as mean over a window of this length centred on each time."}}},

      {"output",
       SectionShape::kTable,
       "What is written, and how often.",
       {{.name = "history_interval",
         .dimension = D::kTime,
         .range = kNonNegative,
         .default_text = "\"0 s\"",
         .doc = "Spacing of the rows of histories.csv; 0: every step. Rows are values of single steps, not "
                "means: faster motion is aliased, impulses stay exact."},
        {.name = "steps_interval",
         .dimension = D::kTime,
         .range = kNonNegative,
         .default_text = "\"0 s\"",
         .doc = "Spacing of the rows of steps.csv (worst values since the row before); 0: every step."},
        {.name = "field_interval",
         .dimension = D::kTime,
         .range = kNonNegative,
         .default_text = "\"0 s\"",
         .doc = "Spacing of the ParaView frames; 0: only the start and the end of each stage."}}},
  };
}

// --- markdown ---

std::string_view type_text(const KeySpec& k) {
  switch (k.type) {
    case K::kBool:
      return "true or false";
    case K::kInteger:
      return "whole number";
    case K::kQuantity:
      return k.dimension == D::kNone ? "number" : "quantity";
    case K::kQuantityAuto:
      return "quantity or \"auto\"";
    case K::kText:
      return "text";
    case K::kChoice:
      return "choice";
    case K::kName:
      return "name";
    case K::kNames:
      return "two names";
    case K::kVector:
      return "[x, y]";
    case K::kIntegers:
      return "[nx, ny]";
    case K::kPoints:
      return "list of [x, y]";
    case K::kNumbers:
      return "list of numbers";
    case K::kMotion:
      return "motion";
  }
  return "";
}

std::string allowed_text(const KeySpec& k) {
  std::string out = k.range.describe(k.dimension == D::kAngle ? D::kAngle : D::kNone);
  for (const std::string& c : k.choices) out += (out.empty() ? "`" : ", `") + c + "`";
  if (!k.refers_to.empty()) out = fmt::format("name of a {}", k.refers_to);
  return out;
}

std::string heading(const SectionSpec& s) {
  switch (s.shape) {
    case SectionShape::kTop:
      return "Top of the file";
    case SectionShape::kTable:
      return fmt::format("`[{}]`", s.name);
    case SectionShape::kNamed:
      return fmt::format("`[{}.NAME]`", s.name);
    case SectionShape::kList:
      return fmt::format("`[[{}]]`", s.name);
  }
  return "";
}

// --- JSON schema: written by hand as text, because the shapes are few and the order of keys matters to
// readers ---

std::string json_text(std::string_view s) {
  std::string out = "\"";
  for (const char c : s) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string json_range(const Range& r) {
  std::string out;
  const double infinity = std::numeric_limits<double>::infinity();
  if (r.min > -infinity)
    out += fmt::format(", \"{}\": {:g}", r.min_open ? "exclusiveMinimum" : "minimum", r.min);
  if (r.max < infinity)
    out += fmt::format(", \"{}\": {:g}", r.max_open ? "exclusiveMaximum" : "maximum", r.max);
  return out;
}

std::string json_type(const KeySpec& k) {
  const std::string quantity = R"("type": ["number", "string"])";
  const auto array = [](const std::string& item, const std::string& count) {
    return fmt::format(R"("type": "array", "items": {{{}}}{})", item, count);
  };
  const std::string two = R"(, "minItems": 2, "maxItems": 2)";
  switch (k.type) {
    case K::kBool:
      return R"("type": "boolean")";
    case K::kInteger:
      return R"("type": "integer")" + json_range(k.range);
    case K::kQuantity:
    case K::kQuantityAuto:
      return quantity + json_range(k.range);
    case K::kText:
    case K::kName:
      return R"("type": "string")";
    case K::kChoice: {
      std::string list;
      for (const std::string& c : k.choices) list += (list.empty() ? "" : ", ") + json_text(c);
      return fmt::format(R"("enum": [{}])", list);
    }
    case K::kNames:
      return array(R"("type": "string")", two);
    case K::kVector:
      return array(quantity, two);
    case K::kIntegers:
      return array(R"("type": "integer")" + json_range(k.range), two);
    case K::kPoints:
      return array(array(quantity, two), R"(, "minItems": 2)");
    case K::kNumbers:
      return array(R"("type": "number")", R"(, "minItems": 2)");
    case K::kMotion:
      return R"("oneOf": [{"enum": ["fixed", "free"]}, {"type": "object", "additionalProperties": false, )"
             R"("properties": {"velocity": {"type": "string"}, "displacement": {"type": "string"}}, )"
             R"("minProperties": 1, "maxProperties": 1}])";
  }
  return "";
}

std::string json_properties(const SectionSpec& s, const std::string& indent) {
  std::string out, required;
  for (const KeySpec& k : s.keys) {
    std::string doc(k.doc);
    if (k.dimension != D::kNone) doc += fmt::format(" Unit: {}.", si_symbol(k.dimension));
    out += fmt::format("{}{}{}: {{{}, \"description\": {}{}}}", out.empty() ? "" : ",\n", indent,
                       json_text(k.name), json_type(k), json_text(doc),
                       k.default_text.empty() ? "" : fmt::format(", \"default\": {}", k.default_text));
    if (k.required) required += (required.empty() ? "" : ", ") + json_text(k.name);
  }
  return fmt::format("\"additionalProperties\": false, \"required\": [{}], \"properties\": {{\n{}}}",
                     required, out);
}

}  // namespace

std::string Range::describe(Dimension dimension) const {
  const double infinity = std::numeric_limits<double>::infinity();
  const bool low = min > -infinity, high = max < infinity;
  const auto show = [dimension](double v) { return with_unit(v, dimension); };
  if (low && high)
    return fmt::format("{} {} and {} {}", min_open ? ">" : ">=", show(min), max_open ? "<" : "<=", show(max));
  if (low) return fmt::format("{} {}", min_open ? ">" : ">=", show(min));
  if (high) return fmt::format("{} {}", max_open ? "<" : "<=", show(max));
  return "";
}

const std::vector<SectionSpec>& model_schema() {
  static const std::vector<SectionSpec> schema = build_schema();
  return schema;
}

const SectionSpec& section_spec(std::string_view name) {
  for (const SectionSpec& s : model_schema())
    if (s.name == name) return s;
  TALUS_ASSERT(!"unknown section");
  return model_schema().front();
}

std::string schema_markdown() {
  std::string out;
  for (const SectionSpec& s : model_schema()) {
    out += fmt::format(
        "### {}\n\n{}\n\n| key | type | unit | default | allowed | meaning |\n|---|---|---|---|---|---|\n",
        heading(s), s.doc);
    for (const KeySpec& k : s.keys) {
      const std::string def = k.required               ? "required"
                              : k.default_text.empty() ? "none"
                                                       : fmt::format("`{}`", k.default_text);
      out += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", k.name, type_text(k), si_symbol(k.dimension),
                         def, allowed_text(k), k.doc);
    }
    out += "\n";
  }
  out += "### Units\n\n| quantity | units (SI first) |\n|---|---|\n";
  for (int d = static_cast<int>(D::kLength); d <= static_cast<int>(D::kStiffness); ++d) {
    const std::string text = describe(static_cast<D>(d));
    const size_t open = text.find(" (");
    out += fmt::format("| {} | {} |\n", text.substr(0, open), text.substr(open + 2, text.size() - open - 3));
  }
  return out;
}

std::string schema_json() {
  const SectionSpec& top = section_spec("top");
  std::string out = json_properties(top, "    ");
  out.pop_back();  // the closing brace of the properties: sections follow
  for (const SectionSpec& s : model_schema()) {
    if (s.shape == SectionShape::kTop) continue;
    const std::string object = fmt::format("\"type\": \"object\", {}", json_properties(s, "      "));
    std::string body;
    if (s.shape == SectionShape::kTable) body = object;
    if (s.shape == SectionShape::kNamed)
      body = fmt::format("\"type\": \"object\", \"additionalProperties\": {{{}}}", object);
    if (s.shape == SectionShape::kList) body = fmt::format("\"type\": \"array\", \"items\": {{{}}}", object);
    out += fmt::format(",\n    {}: {{\"description\": {}, {}}}", json_text(s.name), json_text(s.doc), body);
  }
  return fmt::format(
      "{{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": \"talus model "
      "file, format 1\",\n"
      "  \"type\": \"object\",\n  {}}}\n}}\n",
      out);
}

}  // namespace talus
