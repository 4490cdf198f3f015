#include "talus/model/read_stages.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "talus/base/index.h"
#include "talus/model/joint_law.h"
#include "talus/model/model_sections.h"
#include "talus/schema/units.h"

namespace talus {

namespace {

// What says how blocks shall move.
constexpr std::initializer_list<const char*> kOfMotion = {"safety", "moment_clamp", "damping_mass",
                                                          "damping_stiffness", "damping_local"};

constexpr int64_t kIncrements = 20;

class StageReader : private ModelSections {
 public:
  using ModelSections::ModelSections;

  void read() {
    read_in_situ();
    std::set<std::string> used;
    for_list("stage", [this, &used](const Fields& f) {
      claim_name(f, used, "stage");
      read_stage(f);
    });
    warn_left();
    for_list("change", [this](const Fields& f) { read_change(f); });
    check_changed_joints();
  }

 private:
  // --- stages ---

  void read_stage(const Fields& f) {
    auto s = f.filled<StageInput>();
    s.implicit = f.get<std::string>("elasticity") == "implicit";
    // a share of the stable step, or a clamp for it, asks for the explicit way
    s.elasticity_auto = f.get<std::string>("elasticity") == "auto" && !f.given("safety") && !s.moment_clamp;
    s.damping_auto = !f.given("damping_stiffness");
    s.damping_local = f.get("damping_local", s.kind == StageKind::kStatic ? kStaticDamping : 0.0);
    read_integration(f, s);
    read_path(f, s);
    s.where_path = f.where("path");
    if (s.kind == StageKind::kDynamic && f.given("unbalanced"))
      error(f, "unbalanced", "is only for static stages");
    if (s.kind == StageKind::kDynamic && f.given("strict_rest"))
      error(f, "strict_rest", "is only for static stages");
    check_step(f, s);
    check_excavation(f, s);
    model_.stages.push_back(s);
  }

  // Theory 14.1. What is said about how the blocks move asks for the dynamic way.
  void read_integration(const Fields& f, StageInput& s) {
    const auto integration = f.get<std::string>("integration");
    s.from_rest_auto = integration == "auto" && s.kind == StageKind::kStatic && !any_given(f, kOfMotion) &&
                       f.get<std::string>("elasticity") != "explicit";
    if (integration != "implicit") return;
    if (s.kind == StageKind::kDynamic)
      error(f, "integration", "is \"implicit\", which knows no inertia: it is for static stages",
            "leave it out, or say kind = \"static\"");
    for (const char* key : kOfMotion)
      if (f.given(key))
        error(f, key, "has nothing to do where integration = \"implicit\": every step begins at rest",
              "leave one of the two out");
    if (f.get<std::string>("elasticity") == "explicit")
      error(f, "elasticity", "is \"explicit\", and integration = \"implicit\" has no stable limit to keep",
            "leave one of the two out");
    s.go_from_rest();
  }

  // Theory 14.7.
  void read_path(const Fields& f, StageInput& s) {
    if (!f.given("path")) {
      if (f.given("increments"))
        error(f, "increments", "are parts of a path, and there is none", "give path, or leave it out");
      return;
    }
    s.path = f.get("path", 0.0), s.increments = static_cast<int>(f.get<int64_t>("increments", kIncrements));
    if (s.kind == StageKind::kDynamic)
      error(f, "path", "is only for static stages: in a dynamic one the histories run with the time",
            "leave it out");
    if (f.get<std::string>("integration") == "dynamic")
      error(f, "path", "goes from balance to balance, and integration = \"dynamic\" moves",
            "leave one of the two out");
    for (const char* key : {"excavate", "relaxation"})
      if (f.given(key))
        error(f, key, "is no part of a path", "excavate in a static stage of its own, before this one");
    for (const char* key : kOfMotion)
      if (f.given(key) && !s.from_rest)
        error(f, key, "has nothing to do on a path: every step begins at rest", "leave one of the two out");
    if (f.get<std::string>("elasticity") == "explicit" && !s.from_rest)
      error(f, "elasticity", "is \"explicit\", and a path has no stable limit to keep",
            "leave one of the two out");
    if (model_.contact.law == ContactLaw::kSmoothed)
      error(f, "path", "needs contact.law = \"exact\": balances of smoothed friction creep",
            "leave contact.law out, or path");
    s.go_from_rest();
  }

  void check_step(const Fields& f, const StageInput& s) {
    if (s.moment_clamp && s.implicit)
      error(f, "moment_clamp", "has nothing to do where elasticity = \"implicit\": no block limits the step",
            "leave one of the two out");
    else if (s.moment_clamp && !model_.masonry.empty())
      error(f, "moment_clamp", "changes how blocks rock, and this model has masonry",
            "use elasticity = \"implicit\", or leave time_step to \"auto\"");
    else if (s.moment_clamp && std::isnan(s.time_step))
      error(f, "moment_clamp", "needs a time_step to clamp for", "give time_step = \"... s\"");
    if (s.implicit && f.given("safety"))
      error(f, "safety", "is a share of the stable limit, which elasticity = \"implicit\" does not have",
            "leave it out");
    if (!std::isnan(s.time_step) && f.given("safety"))
      error(f, "safety", "belongs to time_step = \"auto\"; the stage gives its own time_step");
    if (!std::isnan(s.time_step) && s.time_step > s.duration)
      error(f, "time_step", "is longer than the stage");
  }

  // Shares of earlier excavations go on where they ended; two at a time would need two.
  void check_excavation(const Fields& f, const StageInput& s) {
    const bool first = model_.stages.empty();
    if (f.has("excavate") && s.excavate.empty())
      error(f, "excavate", "is empty", "name groups or blocks, or leave it out");
    if (!s.excavate.empty() && pending_)
      error(f, "excavate",
            fmt::format("comes while {:g} of the tractions of an earlier excavation still stand", 1 - share_),
            "let relaxation reach 1 first, at the latest in the stage before");
    if (f.has("relaxation")) check_relaxation(f, s, first);
    if (s.excavate.empty() && !f.has("relaxation")) return;
    if (!s.excavate.empty()) share_ = f.has("relaxation") ? 0 : 1;
    if (!s.relaxation.empty()) share_ = s.relaxation.back().y;
    pending_ = share_ < 1;
  }

  void check_relaxation(const Fields& f, const StageInput& s, bool first) {
    const auto wrong = [&](const std::string& text, const std::string& hint) {
      error(f, "relaxation", text, hint);
    };
    const std::vector<Vec2>& r = s.relaxation;
    if (r.empty()) return wrong("is empty", "write [[\"0 s\", 0], [\"0.1 s\", 1]]");
    if (first)
      return wrong("has nothing to relax: no stage comes before in which forces come to balance",
                   "add a static stage before, or leave it out");
    if (s.excavate.empty() && !pending_)
      return wrong("has nothing to relax", "name what is taken out in excavate");
    const double start = s.excavate.empty() ? share_ : 0;
    if (r.front().x != 0 || std::abs(r.front().y - start) > 1e-12)
      return wrong(fmt::format("begins with [{:g} s, {:g}]", r.front().x, r.front().y),
                   fmt::format("the first entry is [\"0 s\", {:g}], the share gone so far", start));
    for (size_t i = 1; i < r.size(); ++i) {
      if (!(r[i].x > r[i - 1].x))
        return wrong(fmt::format("does not go on in time: {:g} s is followed by {:g} s", r[i - 1].x, r[i].x),
                     "let times rise");
      if (r[i].y < r[i - 1].y)
        return wrong(fmt::format("falls from {:g} to {:g}", r[i - 1].y, r[i].y),
                     "what has gone does not come back: let shares rise or stay");
    }
    if (r.back().x > s.duration)
      wrong(fmt::format("ends at {:g} s, after the stage ({:g} s)", r.back().x, s.duration),
            "give a longer duration, or end it earlier and go on in the next stage");
  }

  void warn_left() {
    if (!pending_ || model_.stages.empty()) return;
    findings_.warning(
        model_.stages.back().where, "stage." + model_.stages.back().name,
        fmt::format("ends the run while {:g} of the tractions of the excavated rock still stand", 1 - share_),
        "let relaxation reach 1 if the opening shall carry itself");
  }

  // --- changes ---

  void read_change(const Fields& f) {
    auto c = f.filled<ChangeInput>();
    c.stage = refer(f, "stage", model_.stages, "stage");
    c.joint = refer(f, "joint", model_.joints, "joint");
    c.material = refer(f, "material", model_.materials, "material");
    const auto kind = f.get<std::string>("kind");
    c.kind = kind == "fixed" ? ChangeInput::kFixed : kind == "free" ? ChangeInput::kFree : ChangeInput::kSame;
    const auto value = [&](const char* key, double& to) { to = f.get(key, to); };
    value("friction_angle", c.friction_angle), value("cohesion", c.cohesion);
    value("tensile_strength", c.tensile_strength);
    value("density", c.density), value("young", c.young), value("poisson", c.poisson);
    check_change(f, c);
    model_.changes.push_back(c);
    if (c.stage >= 0 && c.joint >= 0) joint_changes_.emplace_back(c, f);
  }

  static bool any_given(const Fields& f, std::initializer_list<const char*> keys) {
    return std::any_of(keys.begin(), keys.end(), [&f](const char* k) { return f.given(k); });
  }

  void check_change(const Fields& f, const ChangeInput& c) {
    const bool of_joint = any_given(f, {"friction_angle", "cohesion", "tensile_strength"});
    const bool of_material = any_given(f, {"density", "young", "poisson"});
    if (f.given("joint") + (f.given("material") && !f.given("block")) + f.given("block") != 1) {
      findings_.error(f.where(), f.path(), "does not say what changes, or names more than one thing",
                      "give one of joint, material, block (block may go with material and kind)");
      return;
    }
    const char* hint = "write one [[change]] for each joint, material or block";
    if (f.given("joint") && (of_material || f.given("kind") || !of_joint))
      findings_.error(f.where(), f.path(), "a joint changes its friction_angle, cohesion or tensile_strength",
                      hint);
    else if (f.given("block") && (of_joint || of_material || !(f.given("material") || f.given("kind"))))
      findings_.error(f.where(), f.path(), "blocks change their material or their kind", hint);
    else if (f.given("material") && !f.given("block") && (of_joint || f.given("kind") || !of_material))
      findings_.error(f.where(), f.path(), "a material changes its density, young or poisson", hint);
    if (c.joint < 0) return;
    const JointProperty& joint = model_.joints[c.joint];
    if (joint.bonded)
      error(f, "joint", fmt::format("\"{}\" is bonded: it has no strength to change", joint.name),
            "give the joint cohesion and tensile_strength instead of kind = \"bonded\"");
    else if ((c.cohesion > 0 || c.tensile_strength > 0) && joint.cohesion <= 0 && joint.tensile_strength <= 0)
      error(f, c.cohesion > 0 ? "cohesion" : "tensile_strength",
            fmt::format("joint \"{}\" has no strength at the start, so that none of its faces is intact",
                        joint.name),
            "give it cohesion or tensile_strength in [joint." + joint.name + "]");
  }

  // What a joint may not be at the start it may not become. It is judged when all changes of a stage are
  // made.
  void check_changed_joints() {
    std::vector<JointProperty> joints = model_.joints;
    for (int stage = 0; stage < count_of(model_.stages); ++stage) {
      const std::vector<JointProperty> before = joints;
      for (const auto& [c, f] : joint_changes_) {
        JointProperty& joint = joints[c.joint];
        if (c.stage == stage) joint = changed(joint, c);
      }
      for (int j = 0; j < count_of(joints); ++j) {
        std::set<std::string_view> known;
        for (const JointDefect& d : JointLaw::defects(before[j])) known.insert(d.key);
        for (const JointDefect& d : JointLaw::defects(joints[j]))
          if (!known.count(d.key)) tell_defect(stage, j, joints[j].name, d);
      }
    }
  }

  // At the last change of the stage that gives the value at fault.
  void tell_defect(int stage, int joint, const std::string& name, const JointDefect& d) {
    for (auto it = joint_changes_.rbegin(); it != joint_changes_.rend(); ++it) {
      const auto& [c, f] = *it;
      if (c.stage != stage || c.joint != joint) continue;
      for (const auto& [key, unit] :
           {std::pair("friction_angle", Dimension::kAngle), std::pair("cohesion", Dimension::kStress),
            std::pair("tensile_strength", Dimension::kStress)}) {
        if (!f.given(key) || (*d.bound != 0 && std::string_view(d.bound) != key)) continue;
        return error(f, key,
                     fmt::format("is {}, with which the {} of joint \"{}\" {}",
                                 with_unit(f.get(key, 0.0), unit), d.key, name, d.text),
                     std::isnan(d.least) ? d.hint
                                         : fmt::format("give at least {}, or a smaller {} in [joint.{}]",
                                                       with_unit(d.least, unit), d.key, name));
      }
    }
  }

  // --- stress of the ground ---

  void read_in_situ() {
    if (!source_.root.contains("in_situ")) return;
    const Fields f = read_table("in_situ");
    InSituInput& s = model_.in_situ;
    f.fill(s);
    s.given = true;
    s.where_level = f.where("level");
    s.with_depth = f.given("level");
    const double xy = f.get("stress_xy", 0.0);
    s.stress = {f.get("stress_xx", 0.0), xy, xy, f.get("stress_yy", 0.0)};

    const bool constant = any_given(f, {"stress_xx", "stress_yy", "stress_xy"});
    const bool gradient = any_given(f, {"horizontal_pressure", "horizontal_gradient"});
    if (s.stress.xx > 0 || s.stress.yy > 0)
      findings_.warning(f.where(s.stress.xx > 0 ? "stress_xx" : "stress_yy"), f.path(),
                        "pulls: the ground is under tension",
                        "stresses count tension as positive, pressures the other way");
    if (constant == s.with_depth) {
      findings_.error(f.where(), f.path(), constant ? "is given in two ways" : "has no stress",
                      "give level, density and k0, or stress_xx, stress_yy, stress_xy");
      return;
    }
    if (constant) {
      for (const char* key : {"pressure", "density", "k0", "horizontal_pressure", "horizontal_gradient"})
        if (f.given(key))
          error(f, key, "belongs to a stress that grows with depth", "give level, or leave it out");
      return;
    }
    if (!f.given("density"))
      error(f, "density", "is missing: the pressure below the level grows with it",
            "give the density of the ground, as in [material]");
    if (f.given("k0") == gradient)
      error(f, "k0", gradient ? "and a horizontal pressure are given: one too many" : "is missing",
            "give k0, or horizontal_pressure and horizontal_gradient");
    if (model_.gravity.x != 0 || model_.gravity.y > 0)
      error(f, "level",
            fmt::format("needs gravity along -y; it is [{:g}, {:g}]", model_.gravity.x, model_.gravity.y),
            "give stress_xx, stress_yy, stress_xy, or model.gravity = [0, -9.81]");
  }

  std::vector<std::pair<ChangeInput, Fields>> joint_changes_;
  double share_ = 1;      // of the tractions of the last excavation that is gone
  bool pending_ = false;  // whether some stand at the end of the stages read so far
};

}  // namespace

void read_stage_sections(const TomlSource& source, Model& model, Findings& findings) {
  StageReader(source, model, findings).read();
}

}  // namespace talus
