#include "talus/run/plausible.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "talus/model/toml_source.h"
#include "talus/run/resolution.h"

namespace talus {

namespace {

// From aerogel to lead and platinum would be all there is; these leave foam out, and tungsten.
constexpr double kLeastDensity = 50, kMostDensity = 2.3e4;  // [kg/m3]
// From loose soil to diamond.
constexpr double kLeastYoung = 1e5, kMostYoung = 1.2e12;        // [Pa]
constexpr double kLeastStiffness = 1e4, kMostStiffness = 1e15;  // of joints [Pa/m]
constexpr double kMostStress = 1e9;                             // of the ground [Pa], below 30 km of rock
constexpr double kMostSpeed = 3000;                             // [m/s]
constexpr double kMostGravity = 300;                            // [m/s2], of a centrifuge
// Blocks of one stress throughout, longer than so many times their width, are stiff where they should bend.
constexpr double kCannotBend = 8;
// A step that is a larger share of the shortest period of a motion does not follow it.
constexpr double kStepsPerPeriod = 10;

class Plausible {
 public:
  Plausible(const TomlSource& source, const Scene& scene, const std::vector<StagePlan>& plans,
            Findings& findings)
      : source_(source), scene_(scene), model_(scene.model), plans_(plans), findings_(findings) {}

  void check() {
    check_names();
    check_materials();
    check_joints();
    check_gravity();
    check_ground();
    check_what_holds();
    check_friction();
    check_bending();
    check_steps();
  }

 private:
  Where where_of(const toml::node* node) const {
    if (!node || node->source().begin.line == 0) return {1, 1, ""};
    return {static_cast<int>(node->source().begin.line), static_cast<int>(node->source().begin.column), ""};
  }
  // Of [section.name], of its key when it has it.
  Where where_of(const std::string& section, const std::string& name, const std::string& key = "") const {
    const toml::node* at = source_.root[section].node();
    if (!name.empty() && at && at->is_table()) at = at->as_table()->get(name);
    if (!key.empty() && at && at->is_table() && at->as_table()->get(key)) at = at->as_table()->get(key);
    return where_of(at);
  }

  static void collect(const toml::node& node, std::set<std::string>& texts) {
    if (const auto* text = node.as_string()) texts.insert(text->get());
    if (const auto* list = node.as_array())
      for (const toml::node& item : *list) collect(item, texts);
    if (const auto* table = node.as_table())
      for (const auto& [key, item] : *table) collect(item, texts);
  }

  void check_names() {
    std::set<std::string> texts;
    collect(source_.root, texts);
    // physical groups of meshes take materials and joints by their own names
    for (const MeshInput& m : model_.meshes) {
      texts.insert(m.mesh.surface_groups.begin(), m.mesh.surface_groups.end());
      texts.insert(m.mesh.curve_groups.begin(), m.mesh.curve_groups.end());
    }
    for (const char* section : {"material", "joint", "history", "bolt_type"}) {
      const toml::table* entries = source_.root[section].as_table();
      if (!entries) continue;
      for (const auto& [key, node] : *entries) {
        const std::string name(key.str());
        if (texts.count(name)) continue;
        findings_.warning(where_of(&node), fmt::format("{}.{}", section, name),
                          "is named by nothing in the file", "is another name mistyped? Else leave it out");
      }
    }
  }

  void unusual(const std::string& section, const std::string& name, const std::string& key, double value,
               double least, double most, const std::string& unit) {
    if (std::isnan(value) || (value >= least && value <= most)) return;
    findings_.warning(where_of(section, name, key), fmt::format("{}.{}.{}", section, name, key),
                      fmt::format("{:.4g} {} is unusual: {:.3g} to {:.3g} {} is what materials have", value,
                                  unit, least, most, unit),
                      "is a unit wrong, or missing? Numbers without one are in SI units");
  }

  void check_materials() {
    for (const Material& m : model_.materials) {
      unusual("material", m.name, "density", m.density, kLeastDensity, kMostDensity, "kg/m3");
      unusual("material", m.name, "young", m.young, kLeastYoung, kMostYoung, "Pa");
    }
  }

  void check_joints() {
    for (const JointProperty& j : model_.joints) {
      if (j.bonded) continue;
      for (const auto& [key, value] : {std::pair("normal_stiffness", j.normal_stiffness),
                                       std::pair("shear_stiffness", j.shear_stiffness)})
        if (value > 0) unusual("joint", j.name, key, value, kLeastStiffness, kMostStiffness, "Pa/m");
    }
  }

  void check_gravity() {
    const Where where = where_of("model", "", "gravity");
    const Where line =
        source_.root["model"]["gravity"] ? where_of(source_.root["model"]["gravity"].node()) : where;
    if (model_.gravity.y > 0)
      findings_.warning(line, "model.gravity",
                        fmt::format("{:g} m/s2 along y: things fall upwards", model_.gravity.y),
                        "downwards is [0, -9.81]");
    else if (norm(model_.gravity) > kMostGravity)
      findings_.warning(line, "model.gravity",
                        fmt::format("{:.3g} m/s2 is more than a centrifuge has", norm(model_.gravity)),
                        "downwards is [0, -9.81]");
    if (norm(model_.gravity) > 0 || is_driven()) return;
    findings_.warning(line, "model.gravity",
                      "is none, and nothing else drives the model: nothing will happen",
                      "give [model] gravity = [0, -9.81], or a load, a motion, a velocity");
  }

  // Whether anything but gravity acts or moves.
  bool is_driven() const {
    if (!model_.loads.empty() || model_.in_situ.given || !model_.bolts.empty()) return true;
    for (const BlockShape& b : scene_.layout.blocks) {
      if (norm(b.velocity) > 0 || b.spin != 0 || b.kind == BlockKind::kDriven) return true;
    }
    for (const SupportInput& s : model_.supports)
      if (s.x.history >= 0 || s.y.history >= 0) return true;
    for (const BoundaryInput& b : model_.boundaries)
      if (b.history_x >= 0 || b.history_y >= 0) return true;
    return false;
  }

  void check_ground() {
    const InSituInput& g = model_.in_situ;
    if (!g.given) return;
    const double largest = std::max({std::abs(g.pressure), std::abs(g.stress.xx), std::abs(g.stress.yy)});
    const Where where = where_of("in_situ", "");
    if (largest > kMostStress)
      findings_.warning(where, "in_situ", fmt::format("{:.3g} Pa is more than the crust bears", largest),
                        "is a unit wrong?");
    if (g.pressure < 0 || g.stress.xx > 0 || g.stress.yy > 0)
      findings_.warning(where, "in_situ", "pulls: the ground is under tension",
                        "stresses count tension as positive, pressures the other way");
  }

  void check_what_holds() {
    if (norm(model_.gravity) == 0) return;
    const auto held = [](const BlockShape& b) {
      return b.kind == BlockKind::kFixed || b.kind == BlockKind::kDriven;
    };
    if (!model_.supports.empty() || !model_.boundaries.empty() ||
        std::any_of(scene_.layout.blocks.begin(), scene_.layout.blocks.end(), held))
      return;
    findings_.warning(where_of(source_.root["model"].node()), "support",
                      "nothing holds the model: all of it falls",
                      "give a [[support]], a [[boundary]] or a block of kind = \"fixed\"");
  }

  void check_friction() {
    if (norm(model_.gravity) == 0 || scene_.layout.default_joint >= 0 || scene_.layout.blocks.size() < 2)
      return;
    if (!scene_.layout.pair_joint.empty()) return;  // somebody has thought about it
    const auto has_joint = [](const BlockShape& b) {
      return std::any_of(b.edge_joint.begin(), b.edge_joint.end(), [](int j) { return j >= 0; });
    };
    if (std::any_of(scene_.layout.blocks.begin(), scene_.layout.blocks.end(), has_joint)) return;
    findings_.warning({1, 1, ""}, "contact.joint", "is not given: all contacts are hard and without friction",
                      "give [joint.NAME] with friction_angle, and [contact] joint = \"NAME\"");
  }

  void check_bending() {
    const BlockSet& b = scene_.blocks;
    double worst = kCannotBend;
    int block = -1, count = 0;
    for (int i = 0; i < b.count; ++i) {
      const auto k = static_cast<size_t>(i);
      if (b.kind[k] != BlockKind::kDeformable || !is_written(i)) continue;
      const double aspect = std::sqrt(b.principal[k].x / b.principal[k].y);
      if (aspect <= kCannotBend) continue;
      ++count;
      if (aspect > worst) worst = aspect, block = i;
    }
    if (block < 0) return;
    const BlockShape& shape = scene_.layout.blocks[static_cast<size_t>(block)];
    findings_.warning(
        scene_.layout.group_where[static_cast<size_t>(shape.group)], shape.name,
        fmt::format(
            "is {:.3g} times as long as wide ({} such block{}): it has one strain throughout and cannot bend",
            worst, count, count == 1 ? "" : "s"),
        fmt::format("divide it into pieces below {:g}, glued if it is one body: [[grid]] or [[tessellation]]",
                    kCannotBend));
  }

  // Not one of many that were cut: slices of rock between joints bend by slip.
  bool is_written(int block) const {
    return scene_.layout.blocks[static_cast<size_t>(block)].group < scene_.layout.first_mesh_group;
  }

  void check_steps() {
    for (const Resolution& r : resolutions(scene_)) {
      for (size_t i = 0; i < plans_.size(); ++i) {
        const StageInput& stage = model_.stages[i];
        if (stage.kind != StageKind::kDynamic || !(r.frequency > 0)) continue;
        if (std::isnan(stage.time_step) && !stage.implicit) continue;  // what its blocks ask for
        const double most = 1 / (kStepsPerPeriod * r.frequency);
        if (plans_[i].dt <= most) continue;
        const History& h = model_.histories[static_cast<size_t>(r.history)];
        findings_.warning(std::isnan(stage.time_step) ? stage.where : stage.where_step,
                          "stage." + stage.name + ".time_step",
                          fmt::format("{:.3g} s is long for history \"{}\", which has {:.3g} Hz in it",
                                      plans_[i].dt, h.name, r.frequency),
                          fmt::format("{:.2g} s would be a tenth of its shortest period", most));
        return;
      }
    }
  }

  const TomlSource& source_;
  const Scene& scene_;
  const Model& model_;
  const std::vector<StagePlan>& plans_;
  Findings& findings_;
};

}  // namespace

void check_plausible(const std::string& text, const std::vector<std::string>& overrides, const Scene& scene,
                     const std::vector<StagePlan>& plans, Findings& findings) {
  Findings scratch(scene.model.file, text);
  const TomlSource source = parse_toml(text, overrides, scratch);
  Plausible(source, scene, plans, findings).check();
}

}  // namespace talus
