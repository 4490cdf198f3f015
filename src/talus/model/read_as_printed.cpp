#include "talus/model/read_as_printed.h"

#include <cmath>

#include "talus/model/joint_law.h"

namespace talus {

namespace {

class AsPrinted {
 public:
  AsPrinted(const Model& model, Findings& findings) : model_(model), findings_(findings) {}

  void refuse() {
    for (const JointProperty& j : model_.joints) refuse_joint(j);
    for (const BoundaryInput& b : model_.boundaries) {
      if (b.kind != BoundaryKind::kViscous || b.history_x >= 0 || b.history_y >= 0)
        refuse_at(b.where, "boundary." + b.name,
                  "the printed edge (theory 5.9) lets waves out at a viscous edge, and none in");
    }
    for (const BoltInput& b : model_.bolts)
      refuse_at(b.where, "bolt." + b.name, "the equations of bolts are not printed");
    for (const StageInput& s : model_.stages) {
      const bool implicit = s.implicit && !s.elasticity_auto;
      if ((s.from_rest && !s.from_rest_auto) || implicit)
        refuse_at(s.path > 0 ? s.where_path : s.where,
                  "stage." + s.name +
                      (s.path > 0 ? ".path"
                       : implicit ? ".elasticity"
                                  : ".integration"),
                  "every step is an explicit central difference");
    }
  }

 private:
  void refuse_at(const Where& where, const std::string& path, const std::string& what) {
    findings_.error(where, path, what + " with model.formulation = \"as_printed\"",
                    "leave it out, or use formulation = \"contact_forces\"");
  }

  void refuse_joint(const JointProperty& j) {
    const std::string path = "joint." + j.name;
    if (j.kind == kBondedJoint) return;
    if (j.kind > kBondedJoint || j.dilation_angle > 0 || j.restitution >= 0 || j.normal_stiffness > 0 ||
        j.shear_stiffness > 0)
      refuse_at(j.where, path, "the printed equations know hard contacts with a friction angle;");
    else if (j.cohesion > 0 || j.tensile_strength > 0 || j.residual_cohesion > 0 ||
             j.residual_tensile_strength > 0 ||
             (!std::isnan(j.residual_friction_angle) && j.residual_friction_angle != j.friction_angle))
      refuse_at(j.where, path,
                "cohesion, tensile strength and strengths after slip stand in no printed equation;");
  }

  const Model& model_;
  Findings& findings_;
};

}  // namespace

void refuse_as_printed(const Model& model, Findings& findings) {
  if (model.formulation == Formulation::kAsPrinted) AsPrinted(model, findings).refuse();
}

}  // namespace talus
