// What holds for the whole model: materials, joints, histories.

#include "talus/model/joint_law.h"
#include "talus/model/schema_tables.h"

namespace talus {

namespace {

std::string_view joint_kind_doc() {
  static const std::string doc = doc_of_choices(joint_kinds());
  return doc;
}

// Keys that joints of one kind alone have, behind those of all.
void add_joint_kinds(std::vector<SectionSpec>& sections) {
  for (SectionSpec& section : sections)
    if (section.name == "joint")
      for (const JointKind& kind : joint_kinds())
        section.keys.insert(section.keys.end(), kind.keys.begin(), kind.keys.end());
}

std::vector<SectionSpec> sections_of_model() {
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
         .doc = "Free text, repeated in the results."},
        {.name = "folder",
         .type = K::kText,
         .default_text = "\"\"",
         .doc = "Folder that relative paths in this file count from, itself relative to the file; \"\": "
                "that of the file. `talus cut` gives it to the model that it makes of one with maps."}}},

      {"variables",
       SectionShape::kFree,
       "Values under names of your own (letters, digits, _), of any type: `phi = \"35 deg\"`. A text `\"$phi\"` elsewhere stands for that "
       "value, `\"$(height / 3)\"` for the value of an expression (muParser: + - * / ^, sqrt, sin, min, max, a ? b : c ...), `\"$(2 * phi) rad\"` and "
       "`\"motions/$name.csv\"` for texts with the digits or the text in it, `$$` for a dollar sign. In expressions quantities count in SI, "
       "angles in rad. Variables may stand on others, and are changed like keys: `--set variables.phi=\"30 deg\"`.",
       {}},

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
                "only: a wave along a bar is then exact at Courant number 1, a free block bounces with e = "
                "0.5 instead of 0.75)."},
        {.name = "formulation",
         .type = K::kChoice,
         .default_text = "\"contact_forces\"",
         .choices = {"contact_forces", "penalty", "as_printed"},
         .doc =
             "`contact_forces`: they are the unknowns of an explicit step. `penalty`: conventional DDA, implicit steps with "
             "penalty springs and open-close iteration (theory 13), for comparison; boundaries, bolts, driven blocks, damping and "
             "relaxation are refused then. `as_printed`: the contact equations of Zhao et al. 2016 letter by letter (theory 5.9), to show "
             "what they do: no product."}}},

      {"penalty",
       SectionShape::kTable,
       "Conventional DDA: what `model.formulation = \"penalty\"` goes by (theory 13).",
       {{.name = "normal_stiffness",
         .dimension = D::kStress,
         .range = kPositive,
         .doc =
             "Stiffness of the normal spring of a contact point, per thickness; none: 40 times the largest Young's modulus, or, where no block deforms, that on which the heaviest sinks by 3e-8 of its size. Usual are 10 to 100 times Young's modulus. Joints with a "
             "normal_stiffness of their own keep it along faces."},
        {.name = "shear_share",
         .range = {.min = 0, .max = 10, .min_open = true},
         .default_text = "0.4",
         .doc = "Stiffness of the shear spring over that of the normal spring."},
        {.name = "support_stiffness",
         .dimension = D::kStress,
         .range = kPositive,
         .doc =
             "Stiffness of the springs that hold supported points, per thickness; none: the normal stiffness."},
        {.name = "rotation",
         .type = K::kChoice,
         .default_text = "\"linear\"",
         .choices = {"linear", "exact"},
         .doc =
             "`linear`: as first published; blocks grow as they turn, and stress keeps its axes. `exact`: displacements and stress turn "
             "with the block."},
        {.name = "scheme",
         .type = K::kChoice,
         .default_text = "\"constant_acceleration\"",
         .choices = {"constant_acceleration", "mean_acceleration"},
         .doc =
             "Newmark's beta and gamma: 1/2 and 1, as first published, which loses energy; or 1/4 and 1/2, which loses none."},
        {.name = "dynamic_factor",
         .range = {.min = 0, .max = 1},
         .default_text = "1",
         .doc =
             "Share of the velocity that goes on from step to step in dynamic stages; static stages have 0."},
        {.name = "max_iterations",
         .type = K::kInteger,
         .range = {.min = 1, .max = 1000},
         .default_text = "25",
         .doc = "Open-close iterations of a step before it is cut to a third; as first published 6."},
        {.name = "largest_displacement",
         .range = {.min = 0, .max = 1, .min_open = true},
         .default_text = "0.02",
         .doc = "Displacement of a step above which it is cut, as share of half the height of the model."}}},

      {"material",
       SectionShape::kNamed,
       "Material of blocks.",
       {{.name = "density",
         .dimension = D::kDensity,
         .range = kPositive,
         .usual = kUsualDensity,
         .required = true,
         .doc = "Mass density."},
        {.name = "young",
         .dimension = D::kStress,
         .range = kPositive,
         .usual = {.min = 1e5, .max = 1.2e12},  // loose soil to diamond
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
         .choices = names_of_choices(joint_kinds()),
         .doc = joint_kind_doc()},
        {.name = "friction_angle",
         .type = K::kStrength,
         .dimension = D::kAngle,
         .range = {.min = 0, .max = 1.5533430342749532, .max_open = false},
         .usual = {.min = kDegree},
         .default_text = "\"0 deg\"",
         .doc =
             "Friction angle (at most 89 deg). This and the two strengths below may scatter from face to face: "
             "`{ mean = \"35 deg\", normal = \"3 deg\", seed = 1 }`, or `lognormal`, both the standard deviation of the "
             "strength itself. Drawn for each pair of blocks; draws beyond 4 standard deviations or the allowed range are drawn anew; residual "
             "strengths scatter in proportion."},
        {.name = "cohesion",
         .type = K::kStrength,
         .dimension = D::kStress,
         .range = kNonNegative,
         .usual = {.min = 100, .max = 1e9},
         .default_text = "\"0 Pa\"",
         .doc = "Cohesion of faces that touch at the start; lost for good, with the tensile strength, when "
                "the face breaks."},
        {.name = "tensile_strength",
         .type = K::kStrength,
         .dimension = D::kStress,
         .range = kNonNegative,
         .usual = {.min = 100, .max = 1e9},
         .default_text = "\"0 Pa\"",
         .doc = "Tensile strength of faces that touch at the start."},
        {.name = "normal_stiffness",
         .dimension = D::kStiffness,
         .range = kNonNegative,
         .usual = {.min = 1e4, .max = 1e15},
         .default_text = "\"0 Pa/m\"",
         .doc = "Elastic stiffness kn of the joint per area; 0: hard. Give it to natural rock joints: "
                "forces are then unique. It costs no time step."},
        {.name = "shear_stiffness",
         .dimension = D::kStiffness,
         .range = kNonNegative,
         .usual = {.min = 1e4, .max = 1e15},
         .default_text = "\"0 Pa/m\"",
         .doc = "Elastic stiffness ks along the joint per area; 0: hard."},
        {.name = "damping_time",
         .dimension = D::kTime,
         .range = kNonNegative,
         .usual = {.min = 1e-6, .max = 0.01},
         .default_text = "\"0.25 ms\"",
         .doc =
             "Dashpots beside kn and ks: each bears its stiffness x this time x the velocity (theory 4.6). A block of mass m "
             "that hits ground on a joint of stiffness k is damped by damping_time sqrt(k/m)/2 of critical: 0.2 to 0.3 ms for one "
             "of 1 m at 20 GPa/m, which then rebounds with 0.47 to 0.35 of its speed. None while a face is intact or apart, in "
             "steps from rest, and beside no stiffness. Of steps above damping_time / contact.alpha the numerical damping is the larger."},
        {.name = "restitution",
         .range = {.min = 0, .max = 1},
         .doc =
             "Ratio of the normal velocities after and before a blow, of blocks of any kind and of what bonds tie together, as "
             "whole bodies (theory 4.7); in dynamic stages. None: what the scheme gives (7.1). Only for hard joints and contact.law = \"exact\"."},
        {.name = "dilation_angle",
         .dimension = D::kAngle,
         .range = {.min = 0, .max = 1.5533430342749532},
         .default_text = "\"0 deg\"",
         .doc = "Rise of the joint as it slips, either way: the faces part by tan(dilation_angle) x slip. "
                "At most the residual friction angle, else slip would give energy."},
        {.name = "dilation_slip",
         .dimension = D::kLength,
         .range = kPositive,
         .doc = "Slip, added up over both ways, at which the rise ends; none: it never does."},
        {.name = "residual_friction_angle",
         .dimension = D::kAngle,
         .range = {.min = 0, .max = 1.5533430342749532},
         .doc = "Friction angle once a face that touched at the start has slipped or opened, and of all "
                "that comes into touch later; none: `friction_angle`."},
        {.name = "residual_cohesion",
         .dimension = D::kStress,
         .range = kNonNegative,
         .default_text = "\"0 Pa\"",
         .doc =
             "Cohesion of a face once it has slipped or opened, where the two blocks still touch along it."},
        {.name = "residual_tensile_strength",
         .dimension = D::kStress,
         .range = kNonNegative,
         .default_text = "\"0 Pa\"",
         .doc = "Tensile strength of a face once it has slipped; where it opens nothing is left."}}},

      {"history",
       SectionShape::kNamed,
       "A quantity over time, linear between its points, held before the first and after the last. Its "
       "clock runs in dynamic stages and along the `path` of static ones, and starts with the first of them. Give `time` and `value`, or "
       "`expression` with `duration`, or `file` with `column`.",
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
         .doc = "With `expression`: number of equal intervals."},
        {.name = "file",
         .type = K::kText,
         .doc =
             "A table (CSV with a column \"time [s]\") or a strong-motion record (PEER, K-NET, JMA, ESM, GeoNet, CSMIP, COSMOS, SMC); the "
             "path counts from the folder of the model. Its content belongs to the hash of the model."},
        {.name = "column",
         .type = K::kText,
         .doc = "With `file`: title of the column, or its quantity (acceleration, velocity, displacement); "
                "none: the only one beside the time. Values become SI by the unit in the title."},
        {.name = "dt",
         .dimension = D::kTime,
         .range = kPositive,
         .doc =
             "With `file`: the time step of a file of bare values, one a line or in rows, without a column of time."},
        {.name = "unit",
         .type = K::kText,
         .doc =
             "With `file`: the unit of values whose file names none: one of motion (m/s2, gal, g, m/s, cm/s, m, mm ...), rad, rad/s, rad/s2, N, Pa, -."},
        {.name = "scale",
         .default_text = "1",
         .doc = "Factor on all values; -1 turns the motion of a base into the load seen from it."}}},
  };
}

}  // namespace

std::vector<SectionSpec> model_sections() {
  std::vector<SectionSpec> sections = sections_of_model();
  add_joint_kinds(sections);
  return sections;
}

}  // namespace talus
