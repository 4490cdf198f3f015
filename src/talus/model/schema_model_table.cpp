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
       {key("talus", K::kInteger, Range{.min = 1}, kRequired,
            "Number of the file format: 1. A newer number is refused, an older one is converted or refused "
            "with the program version that reads it."),
        key("title", K::kText, Default{"\"\""}, to(&Model::title), "Free text, repeated in the results."),
        key("folder", K::kText, Default{"\"\""},
            "Folder that relative paths in this file count from, itself relative to the file; \"\": "
            "that of the file. `talus cut` gives it to the model that it makes of one with maps.")}},

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
       {key("thickness", D::kLength, kPositive, to(&Model::thickness),
            "Thickness of the section; all masses and forces carry it."),
        key("plane", Choices{{"strain", "stress"}}, to(&Model::plane), "Plane strain or plane stress."),
        key("gravity", K::kVector, D::kAcceleration, to(&Model::gravity, &Model::where_gravity),
            "Acceleration of gravity, for example [0, -9.81]."),
        key("inertia", Choices{{"consistent", "lumped"}}, to(&Model::inertia),
            "Moments of inertia of deformable blocks: exact, or three times as large (bonded continua "
            "only: a wave along a bar is then exact at Courant number 1, a free block bounces with e = "
            "0.5 instead of 0.75)."),
        key("formulation", Choices{{"contact_forces", "penalty", "as_printed"}}, to(&Model::formulation),
            "`contact_forces`: they are the unknowns of an explicit step. `penalty`: conventional DDA, implicit steps with "
            "penalty springs and open-close iteration (theory 13), for comparison; boundaries, bolts, driven blocks, damping and "
            "relaxation are refused then. `as_printed`: the contact equations of Zhao et al. 2016 letter by letter (theory 5.9), to show "
            "what they do: no product.")}},

      {"penalty",
       SectionShape::kTable,
       "Conventional DDA: what `model.formulation = \"penalty\"` goes by (theory 13).",
       {key("normal_stiffness", D::kStress, kPositive, kNoDefault, to(&PenaltyInput::normal_stiffness),
            "Stiffness of the normal spring of a contact point, per thickness; none: 40 times the largest Young's modulus, or, where no block deforms, that on which the heaviest sinks by 3e-8 of its size. Usual are 10 to 100 times Young's modulus. Joints with a "
            "normal_stiffness of their own keep it along faces."),
        key("shear_share", Range{.min = 0, .max = 10, .min_open = true}, to(&PenaltyInput::shear_share),
            "Stiffness of the shear spring over that of the normal spring."),
        key("support_stiffness", D::kStress, kPositive, kNoDefault, to(&PenaltyInput::support_stiffness),
            "Stiffness of the springs that hold supported points, per thickness; none: the normal stiffness."),
        key("rotation", Choices{{"linear", "exact"}}, to(&PenaltyInput::exact_rotation),
            "`linear`: as first published; blocks grow as they turn, and stress keeps its axes. `exact`: displacements and stress turn "
            "with the block."),
        key("scheme", Choices{{"constant_acceleration", "mean_acceleration"}},
            to(&PenaltyInput::mean_acceleration),
            "Newmark's beta and gamma: 1/2 and 1, as first published, which loses energy; or 1/4 and 1/2, which loses none."),
        key("dynamic_factor", Range{.min = 0, .max = 1}, to(&PenaltyInput::dynamic_factor),
            "Share of the velocity that goes on from step to step in dynamic stages; static stages have 0."),
        key("max_iterations", K::kInteger, Range{.min = 1, .max = 1000}, to(&PenaltyInput::most_iterations),
            "Open-close iterations of a step before it is cut to a third; as first published 6."),
        key("largest_displacement", Range{.min = 0, .max = 1, .min_open = true},
            to(&PenaltyInput::largest_displacement),
            "Displacement of a step above which it is cut, as share of half the height of the model.")}},

      {"material",
       SectionShape::kNamed,
       "Material of blocks.",
       {key("density", D::kDensity, kPositive, Usual{kUsualDensity}, kRequired, to(&Material::density),
            "Mass density."),
        key("young", D::kStress, kPositive, Usual{kUsualYoung},
            "Young's modulus; needed by deformable blocks."),
        key("poisson", Range{.min = -1, .max = 0.5, .min_open = true, .max_open = true},
            "Poisson's ratio; needed by deformable blocks.")}},

      {"joint",
       SectionShape::kNamed,
       "Property of the contact between two blocks.",
       {key("kind", Choices{names_of_choices(joint_kinds())}, Default{"\"frictional\""}, joint_kind_doc()),
        key("friction_angle", K::kStrength, D::kAngle,
            Range{.min = 0, .max = 1.5533430342749532, .max_open = false}, Usual{Range{.min = kDegree}},
            Default{"\"0 deg\""},
            "Friction angle (at most 89 deg). This and the two strengths below may scatter from face to face: "
            "`{ mean = \"35 deg\", normal = \"3 deg\", seed = 1 }`, or `lognormal`, both the standard deviation of the "
            "strength itself. Drawn for each pair of blocks; draws beyond 4 standard deviations or the allowed range are drawn anew; residual "
            "strengths scatter in proportion."),
        key("cohesion", K::kStrength, D::kStress, kNonNegative, Usual{Range{.min = 100, .max = 1e9}},
            Default{"\"0 Pa\""},
            "Cohesion of faces that touch at the start; lost for good, with the tensile strength, when "
            "the face breaks."),
        key("tensile_strength", K::kStrength, D::kStress, kNonNegative, Usual{Range{.min = 100, .max = 1e9}},
            Default{"\"0 Pa\""}, "Tensile strength of faces that touch at the start."),
        key("normal_stiffness", D::kStiffness, kNonNegative, Usual{Range{.min = 1e4, .max = 1e15}},
            to(&JointProperty::normal_stiffness),
            "Elastic stiffness kn of the joint per area; 0: hard. Give it to natural rock joints: "
            "forces are then unique. It costs no time step."),
        key("shear_stiffness", D::kStiffness, kNonNegative, Usual{Range{.min = 1e4, .max = 1e15}},
            to(&JointProperty::shear_stiffness), "Elastic stiffness ks along the joint per area; 0: hard."),
        key("damping_time", D::kTime, kNonNegative, Usual{Range{.min = 1e-6, .max = 0.01}},
            Default{"\"0.25 ms\""},
            "Dashpots beside kn and ks: each bears its stiffness x this time x the velocity (theory 4.6). A block of mass m "
            "that hits ground on a joint of stiffness k is damped by damping_time sqrt(k/m)/2 of critical: 0.2 to 0.3 ms for one "
            "of 1 m at 20 GPa/m, which then rebounds with 0.47 to 0.35 of its speed. None while a face is intact or apart, in "
            "steps from rest, and beside no stiffness. Of steps above damping_time / contact.alpha the numerical damping is the larger."),
        key("restitution", Range{.min = 0, .max = 1},
            "Ratio of the normal velocities after and before a blow, of blocks of any kind and of what bonds tie together, as "
            "whole bodies (theory 4.7); in dynamic stages. None: what the scheme gives (7.1). Only for hard joints and contact.law = \"exact\"."),
        key("dilation_angle", D::kAngle, Range{.min = 0, .max = 1.5533430342749532},
            to(&JointProperty::dilation_angle),
            "Rise of the joint as it slips, either way: the faces part by tan(dilation_angle) x slip. "
            "At most the residual friction angle, else slip would give energy."),
        key("dilation_slip", D::kLength, kPositive, kNoDefault, to(&JointProperty::dilation_slip),
            "Slip, added up over both ways, at which the rise ends; none: it never does."),
        key("residual_friction_angle", D::kAngle, Range{.min = 0, .max = 1.5533430342749532}, kNoDefault,
            to(&JointProperty::residual_friction_angle),
            "Friction angle once a face that touched at the start has slipped or opened, and of all "
            "that comes into touch later; none: `friction_angle`."),
        key("residual_cohesion", D::kStress, kNonNegative, to(&JointProperty::residual_cohesion),
            "Cohesion of a face once it has slipped or opened, where the two blocks still touch along it."),
        key("residual_tensile_strength", D::kStress, kNonNegative,
            to(&JointProperty::residual_tensile_strength),
            "Tensile strength of a face once it has slipped; where it opens nothing is left.")}},

      {"history",
       SectionShape::kNamed,
       "A quantity over time, linear between its points, held before the first and after the last. Its "
       "clock runs in dynamic stages and along the `path` of static ones, and starts with the first of them. Give `time` and `value`, or "
       "`expression` with `duration`, or `file` with `column`.",
       {key("time", K::kNumbers, D::kTime, "Rising times [s]."),
        key("value", K::kNumbers, "One value per time, SI (m, m/s, rad or rad/s by its use)."),
        key("expression", K::kText,
            "Formula in `t` [s] (muParser: sin, exp, _pi, a ? b : c ...), for example \"sin(2*_pi*5*t)\"."),
        key("duration", D::kTime, kPositive, "With `expression`: the formula is sampled from 0 to here."),
        key("samples", K::kInteger, Range{.min = 2, .max = 1e7}, Default{"10000"},
            "With `expression`: number of equal intervals."),
        key("file", K::kText,
            "A table (CSV with a column \"time [s]\") or a strong-motion record (PEER, K-NET, JMA, ESM, GeoNet, CSMIP, COSMOS, SMC); the "
            "path counts from the folder of the model. Its content belongs to the hash of the model."),
        key("column", K::kText,
            "With `file`: title of the column, or its quantity (acceleration, velocity, displacement); "
            "none: the only one beside the time. Values become SI by the unit in the title."),
        key("dt", D::kTime, kPositive,
            "With `file`: the time step of a file of bare values, one a line or in rows, without a column of time."),
        key("unit", K::kText,
            "With `file`: the unit of values whose file names none: one of motion (m/s2, gal, g, m/s, cm/s, m, mm ...), rad, rad/s, rad/s2, N, Pa, -."),
        key("scale", Default{"1"},
            "Factor on all values; -1 turns the motion of a base into the load seen from it.")}},
  };
}

}  // namespace

std::vector<SectionSpec> model_sections() {
  std::vector<SectionSpec> sections = sections_of_model();
  add_joint_kinds(sections);
  return sections;
}

}  // namespace talus
