#include "talus/run/plausible.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/run/resolution.h"

namespace talus {

namespace {

// Blocks of one stress throughout, longer than so many times their width, are stiff where they should bend.
constexpr double kCannotBend = 8;
// A step that is a larger share of the shortest period of a motion does not follow it.
constexpr double kStepsPerPeriod = 10;

class Plausible {
 public:
  Plausible(const Scene& scene, const std::vector<StagePlan>& plans, Findings& findings)
      : scene_(scene), model_(scene.model), plans_(plans), findings_(findings) {}

  void check() {
    check_gravity();
    check_what_holds();
    check_friction();
    check_bending();
    check_steps();
  }

 private:
  void check_gravity() {
    if (norm(model_.gravity) > 0 || is_driven()) return;
    findings_.warning(model_.where_gravity, "model.gravity",
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

  void check_what_holds() {
    if (norm(model_.gravity) == 0) return;
    const auto held = [](const BlockShape& b) {
      return b.kind == BlockKind::kFixed || b.kind == BlockKind::kDriven;
    };
    if (!model_.supports.empty() || !model_.boundaries.empty() ||
        std::any_of(scene_.layout.blocks.begin(), scene_.layout.blocks.end(), held))
      return;
    findings_.warning(model_.where_gravity, "support", "nothing holds the model: all of it falls",
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

  const Scene& scene_;
  const Model& model_;
  const std::vector<StagePlan>& plans_;
  Findings& findings_;
};

}  // namespace

void check_plausible(const Scene& scene, const std::vector<StagePlan>& plans, Findings& findings) {
  Plausible(scene, plans, findings).check();
}

}  // namespace talus
