#include "talus/model/read_penalty.h"

#include "talus/model/joint_law.h"
#include "talus/model/model_sections.h"

namespace talus {

namespace {

class PenaltyReader : private ModelSections {
 public:
  using ModelSections::ModelSections;

  void read() {
    const Fields f = read_table("penalty");
    PenaltyInput& p = model_.penalty;
    f.fill(p);
    if (model_.formulation != Formulation::kPenalty) return;
    refuse();
  }

 private:
  void refuse_at(const Where& where, const std::string& path, const std::string& what) {
    findings_.error(where, path, what + " with model.formulation = \"penalty\"",
                    "leave it out, or use formulation = \"contact_forces\"");
  }

  // What conventional DDA does not know, section by section.
  void refuse() {
    for (const BoundaryInput& b : model_.boundaries)
      refuse_at(b.where, "boundary." + b.name, "there are no boundaries that let waves out");
    for (const BoltInput& b : model_.bolts) refuse_at(b.where, "bolt." + b.name, "there are no bolts");
    for (const BlockInput& b : model_.blocks)
      if (b.kind == BlockKind::kDriven)
        refuse_at(b.where, "block." + b.name + ".kind", "no block is driven; a support may follow a history");
    for (const JointProperty& j : model_.joints) {
      if (j.dilation_angle > 0) refuse_at(j.where, "joint." + j.name + ".dilation_angle", "no joint dilates");
      if (j.damping_time > 0)
        refuse_at(j.where, "joint." + j.name + ".damping_time",
                  "damping is the scheme's own: no joint has dashpots");
      if (j.restitution >= 0)
        refuse_at(j.where, "joint." + j.name + ".restitution", "no restitution can be given");
      if (j.kind > kBondedJoint)
        refuse_at(j.where, "joint." + j.name + ".kind", "only frictional and bonded joints are known");
    }
    for (const StageInput& s : model_.stages) {
      const std::string path = "stage." + s.name;
      if (!s.relaxation.empty()) refuse_at(s.where_relaxation, path + ".relaxation", "rock goes at once");
      if (s.from_rest && !s.from_rest_auto)
        refuse_at(s.path > 0 ? s.where_path : s.where, path + (s.path > 0 ? ".path" : ".integration"),
                  "every step is implicit, and static ones forget their velocity:");
      if (s.kind == StageKind::kDynamic && s.damping_mass + s.damping_stiffness + s.damping_local > 0)
        refuse_at(s.where, path, "damping is the scheme's own: there is none to be given");
      if (s.moment_clamp) refuse_at(s.where_clamp, path + ".moment_clamp", "no step has a stable limit");
    }
    if (model_.contact.law == ContactLaw::kSmoothed)
      findings_.error({}, "contact.law",
                      "\"smoothed\" is a law of contact forces as unknowns; penalty springs have their own",
                      "leave it out");
  }
};

}  // namespace

void read_penalty_section(const TomlSource& source, Model& model, Findings& findings) {
  PenaltyReader(source, model, findings).read();
}

}  // namespace talus
