#include "talus/run/plausible.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "talus/base/index.h"
#include "talus/base/rank.h"
#include "talus/model/joint_law.h"
#include "talus/run/path.h"
#include "talus/run/resolution.h"

namespace talus {

namespace {

// Blocks of one stress throughout, longer than so many times their width, are stiff where they should bend.
constexpr double kCannotBend = 8;
// Share of a block's size over which points that hold it must reach; share of its thickness by which the
// weight above may close its joints.
constexpr double kLeastHeld = 0.05, kMostClosing = 0.05;
// A history that stands beyond its end at more than this share of its peak drives on; one that lasts so many
// times as long as all stages hardly begins; shaking of so many times gravity is no earthquake.
constexpr double kDrivesOn = 0.05, kHardlyBegins = 10, kMostShaking = 10;

class Plausible {
 public:
  Plausible(const Scene& scene, const std::vector<StagePlan>& plans, Findings& findings)
      : scene_(scene), model_(scene.model), plans_(plans), findings_(findings) {}

  void check() {
    check_gravity();
    check_what_holds();
    check_glue();
    check_friction();
    check_bending();
    check_steps();
    check_static_only();
    check_paths();
    check_histories();
    check_outputs();
    check_held();
    check_closing();
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

  // Whether anything holds the model along y, or moves it there, in a stage.
  bool is_held_in(int stage) const {
    for (const BlockShape& b : scene_.layout.blocks)
      if (b.kind == BlockKind::kFixed || b.kind == BlockKind::kDriven) return true;
    for (const SupportInput& s : model_.supports)
      if (s.acts_in(stage) && s.y.kind != Motion::kFree) return true;
    const bool is_static = model_.stages[stage].kind == StageKind::kStatic;
    for (const BoundaryInput& b : model_.boundaries)
      if (b.acts_in(stage) && b.kind != BoundaryKind::kTied && (!is_static || b.hold != StaticHold::kFree))
        return true;
    return false;
  }

  void check_what_holds() {
    if (model_.gravity.y == 0) return;
    for (int i = 0; i < count_of(model_.stages); ++i) {
      if (is_held_in(i)) continue;
      const bool nothing = model_.supports.empty() && model_.boundaries.empty();
      findings_.warning(nothing ? model_.where_gravity : model_.stages[i].where,
                        nothing ? "support" : "stage." + model_.stages[i].name,
                        nothing ? "nothing holds the model: all of it falls"
                                : "nothing holds the model along y in this stage: all of it falls",
                        "give a [[support]] with y, a [[boundary]] or a block of kind = \"fixed\"");
      return;
    }
  }

  bool glues(int joint) const { return joint >= 0 && JointLaw(model_.joints[joint]).holds(); }

  // Pairs that a joint with strength shall hold together, and which share no face.
  void check_glue() {
    const Layout& layout = scene_.layout;
    const auto group = [&layout](int block) { return layout.blocks[block].group; };
    std::set<std::pair<int, int>> joined;  // groups
    bool default_used = false;
    for (const BondFace& face : scene_.bonds.faces) {
      joined.insert(std::minmax(group(face.block_a), group(face.block_b)));
      default_used = default_used || face.joint == layout.default_joint;
    }
    for (const ContactPairInput& p : model_.contact_pairs) {
      if (!glues(p.joint)) continue;
      bool found = false;
      for (const int a : layout.groups_called(p.name_a))
        for (const int b : layout.groups_called(p.name_b))
          found = found || joined.count(std::minmax(a, b)) > 0;
      if (found) continue;
      findings_.warning(
          p.where, "contact_pair",
          fmt::format("joint \"{}\" shall hold \"{}\" and \"{}\" together, which share no face{}",
                      model_.joints[p.joint].name, p.name_a, p.name_b, gap_text(p.name_a, p.name_b)),
          "draw their corners at the same place, or take a joint without strength");
    }
    if (!glues(layout.default_joint) || default_used || layout.blocks.size() < 2 ||
        !layout.pair_joint.empty())
      return;
    if (layout.blocks.back().group >= layout.first_mesh_group) return;  // edges have joints of their own
    findings_.warning({1, 1, ""}, "contact.joint",
                      fmt::format("\"{}\" shall hold blocks together, and no two of them share a face",
                                  model_.joints[layout.default_joint].name),
                      "draw blocks that touch with their corners at the same place");
  }

  // How far the blocks of two names are apart.
  std::string gap_text(const std::string& a, const std::string& b) const {
    constexpr size_t kMost = 300;  // blocks: every edge is held against every corner
    const std::vector<int> of_a = scene_.layout.blocks_called(a), of_b = scene_.layout.blocks_called(b);
    if (of_a.size() * of_b.size() > kMost * kMost) return "";
    double gap = std::numeric_limits<double>::infinity();
    const auto look = [&](const Polygon& corners, const Polygon& edges) {
      for (const Vec2 p : corners)
        for (size_t k = 0; k < edges.size(); ++k)
          gap = std::min(gap, distance_to_segment(p, edges[k], edges[(k + 1) % edges.size()]));
    };
    for (const int i : of_a)
      for (const int j : of_b) {
        const Polygon& one = scene_.layout.blocks[i].polygon;
        const Polygon& other = scene_.layout.blocks[j].polygon;
        look(one, other), look(other, one);
      }
    return std::isfinite(gap) && gap > 0 ? fmt::format(": they lie {:.3g} m apart", gap) : "";
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
      if (b.kind[i] != BlockKind::kDeformable || !is_written(i)) continue;
      const double aspect = std::sqrt(b.principal[i].x / b.principal[i].y);
      if (aspect <= kCannotBend) continue;
      ++count;
      if (aspect > worst) worst = aspect, block = i;
    }
    if (block < 0) return;
    const BlockShape& shape = scene_.layout.blocks[block];
    findings_.warning(
        scene_.layout.group_where[shape.group], shape.name,
        fmt::format(
            "is {:.3g} times as long as wide ({} such block{}): it has one strain throughout and cannot bend",
            worst, count, count == 1 ? "" : "s"),
        fmt::format("divide it into pieces below {:g}, glued if it is one body: [[grid]] or [[tessellation]]",
                    kCannotBend));
  }

  // Not one of many that were cut: slices of rock between joints bend by slip.
  bool is_written(int block) const {
    return scene_.layout.blocks[block].group < scene_.layout.first_mesh_group;
  }

  void check_steps() {
    for (const Resolution& r : resolutions(scene_)) {
      for (size_t i = 0; i < plans_.size(); ++i) {
        const StageInput& stage = model_.stages[i];
        if (stage.kind != StageKind::kDynamic || !(r.frequency > 0)) continue;
        if (std::isnan(stage.time_step)) continue;
        const double most = 1 / (kStepsPerPeriod * r.frequency);
        if (plans_[i].dt <= most) continue;
        const History& h = model_.histories[r.history];
        findings_.warning(stage.where_step, "stage." + stage.name + ".time_step",
                          fmt::format("{:.3g} s is long for history \"{}\", which has {:.3g} Hz in it",
                                      plans_[i].dt, h.name, r.frequency),
                          fmt::format("{:.2g} s would be a tenth of its shortest period", most));
        return;
      }
    }
  }

  // A path on which nothing goes, and motions of dynamic stages that a path before them has used up.
  void check_paths() {
    for (int i = 0; i < count_of(model_.stages); ++i) {
      const StageInput& s = model_.stages[i];
      if (s.path > 0 && !follows_history(scene_, i))
        findings_.error(
            s.where_path, "stage." + s.name + ".path",
            "leads nowhere: no support, load or driven block that acts in this stage follows a history",
            "name a history in one of them, or leave path out");
      const double begun = model_.history_time_at(i);
      if (s.kind != StageKind::kDynamic || !(begun > 0)) continue;
      for (const BoundaryInput& b : model_.boundaries)
        warn_used_up(b.where, "boundary." + b.name, b, true, i, {b.history_x, b.history_y});
      for (const SupportInput& p : model_.supports)
        warn_used_up(p.where, "support." + p.name, p, false, i, {p.x.history, p.y.history});
      for (const LoadInput& l : model_.loads)
        warn_used_up(l.where, "load." + l.name, l, false, i, {l.x.history, l.y.history, l.pressure.history});
    }
  }

  // What acts in a dynamic stage and not on a path before it, which has gone on with its history. Waves come in while time
  // runs, and on no path. Told once: at the first stage behind such a path.
  void warn_used_up(const Where& where, const std::string& name, const Staged& what, bool is_wave, int stage,
                    std::initializer_list<int> histories) {
    if (!what.acts_in(stage)) return;
    double used_up = -1;
    for (int k = 0; k < stage; ++k) {
      if (model_.stages[k].path > 0 && (is_wave || !what.acts_in(k)))
        used_up = model_.history_time_at(k + 1);
      else if (model_.stages[k].kind == StageKind::kDynamic && what.acts_in(k) && used_up >= 0)
        return;
    }
    if (used_up < 0) return;
    for (const int h : histories) {
      if (h < 0 || model_.histories[h].time.front() >= used_up) continue;
      findings_.warning(
          where, name,
          fmt::format(
              "acts in stage \"{}\" from {:.6g} s of history \"{}\" on, as a path has used up the time before",
              model_.stages[stage].name, model_.history_time_at(static_cast<int>(stage)),
              model_.histories[h].name),
          fmt::format("let the times of that history begin at {:.6g} s", used_up));
    }
  }

  // Whether a history drives something in static stages only, where it stands at its value of t = 0.
  // @param is_wave  which comes in while time runs, and on no path
  bool stands_still(const Staged& what, int history, bool is_wave) const {
    if (history < 0) return false;
    const std::vector<double>& v = model_.histories[history].value;
    if (std::all_of(v.begin(), v.end(), [&v](double x) { return x == v[0]; })) return false;
    for (int i = 0; i < count_of(model_.stages); ++i)
      if (what.acts_in(i) &&
          (model_.stages[i].kind == StageKind::kDynamic || (model_.stages[i].path > 0 && !is_wave)))
        return false;
    return true;
  }

  void tell_static_only(const Where& where, const std::string& path, const Staged& what,
                        std::initializer_list<int> histories, bool is_wave = false) {
    for (const int h : histories) {
      if (!stands_still(what, h, is_wave)) continue;
      findings_.warning(
          where, path,
          fmt::format("acts in static stages only, where history \"{}\" stands at its value of t = 0",
                      model_.histories[h].name),
          "let it act in a stage of kind = \"dynamic\"");
      return;
    }
  }

  void check_static_only() {
    for (const LoadInput& l : model_.loads)
      tell_static_only(l.where, "load." + l.name, l, {l.x.history, l.y.history, l.pressure.history});
    for (const SupportInput& s : model_.supports)
      tell_static_only(s.where, "support." + s.name, s, {s.x.history, s.y.history});
    for (const BoundaryInput& b : model_.boundaries)
      tell_static_only(b.where, "boundary." + b.name, b, {b.history_x, b.history_y}, true);
    for (const BlockInput& b : model_.blocks)
      tell_static_only(b.where, "block." + b.name, {},
                       {b.motion_x.history, b.motion_y.history, b.motion_rotation.history});
  }

  double history_time() const { return model_.history_time_at(count_of(model_.stages)); }

  // Histories that swing and are used as if they ended, or began, elsewhere.
  void check_histories() {
    const double time = history_time();
    if (!(time > 0)) return;
    std::set<int> velocities, accelerations;
    const auto add_motion = [&](const Motion& m) {
      if (m.kind == Motion::kVelocity) velocities.insert(m.history);
    };
    for (const SupportInput& s : model_.supports) add_motion(s.x), add_motion(s.y);
    for (const BlockInput& b : model_.blocks) add_motion(b.motion_x), add_motion(b.motion_y);
    // those of boundaries are looked at where they are read
    std::map<int, double> factor;
    for (const LoadInput& l : model_.loads) {
      if (l.kind != LoadKind::kAcceleration) continue;
      accelerations.insert({l.x.history, l.y.history});
      for (const Signal& s : {l.x, l.y}) factor[s.history] = std::max(factor[s.history], std::abs(s.factor));
    }
    for (int i = 0; i < count_of(model_.histories); ++i) {
      const History& h = model_.histories[i];
      const bool is_velocity = velocities.count(i) > 0, is_acceleration = accelerations.count(i) > 0;
      if ((is_velocity || is_acceleration) && swings(h))
        check_motion(h, time, is_acceleration ? factor[i] : 0);
    }
  }

  // Whether it goes to and fro, as shaking does.
  static bool swings(const History& h) {
    int turns = 0;
    double sign = 0;
    for (const double v : h.value) {
      if (v * sign < 0) ++turns;
      if (v != 0) sign = v;
    }
    return turns >= 3;
  }

  void check_motion(const History& h, double time, double factor) {
    double peak = 0;
    for (const double v : h.value) peak = std::max(peak, std::abs(v));
    const std::string path = "history." + h.name;
    if (h.time.back() < time && std::abs(h.value.back()) > kDrivesOn * peak)
      findings_.warning(
          h.where, path,
          fmt::format("ends at {:.4g} s with {:.3g}, {:.0f} % of its peak, and is held there to the end "
                      "of the stages at {:.4g} s",
                      h.time.back(), h.value.back(), 100 * std::abs(h.value.back()) / peak, time),
          "let it end at 0, or end the stage with it");
    if (factor == 0 && std::abs(h.value.front()) > kDrivesOn * peak)
      findings_.warning(h.where, path,
                        fmt::format("begins with {:.3g}, {:.0f} % of its peak: a blow at t = 0",
                                    h.value.front(), 100 * std::abs(h.value.front()) / peak),
                        "let it begin at 0");
    if (h.time.back() > kHardlyBegins * time)
      findings_.warning(h.where, path,
                        fmt::format("lasts {:.4g} s, and histories run for {:.4g} s: only its beginning acts",
                                    h.time.back(), time),
                        "is its time in ms? Else make the stage longer");
    const double gravity = norm(model_.gravity), shaking = factor * peak;
    if (gravity > 0 && shaking > kMostShaking * gravity)
      findings_.warning(
          h.where, path,
          fmt::format("shakes with {:.4g} m/s2, {:.0f} times gravity", shaking, shaking / gravity),
          "is the record in cm/s2 (gal)? Then give scale = 0.01");
  }

  // Rows between two steps are on the straight line between these, and wait in memory together.
  void check_rows() {
    constexpr double kMostRows = 1e5;  // of a step; with twenty columns 16 MB
    const double interval = model_.output.history_interval;
    double longest = 0;
    for (const StagePlan& plan : plans_) longest = std::max(longest, plan.dt);
    if (!(interval > 0) || interval * kMostRows >= longest) return;
    findings_.error(
        model_.output.where_history, "output.history_interval",
        fmt::format("{:.3g} s makes more than {:g} rows of a step of {:.3g} s", interval, kMostRows, longest),
        "0 writes every step");
  }

  void check_outputs() {
    check_rows();
    double longest = 0;
    bool all_dynamic = true;
    for (const StageInput& s : model_.stages) {
      longest = std::max(longest, s.duration);
      all_dynamic = all_dynamic && s.kind == StageKind::kDynamic;
    }
    if (!all_dynamic) return;
    const OutputInput& o = model_.output;
    const auto check = [&](const Where& where, const char* path, double interval) {
      if (interval > longest)
        findings_.warning(
            where, path,
            fmt::format("{:.4g} s is longer than any stage: nothing is written between its ends", interval),
            "make it shorter");
    };
    check(o.where_history, "output.history_interval", o.history_interval);
    check(o.where_field, "output.field_interval", o.field_interval);
  }

  // Points that alone hold a block, nearer to each other than a share of its size: it turns about them all
  // the same.
  void check_held() {
    struct Held {
      std::vector<Vec2> points;
      int support = -1;
    };
    std::map<int, Held> held;
    std::map<int, std::set<int>> blocks;  // of each support: a side of cut rock ends in tips of blocks
    for (const SupportedPoint& p : scene_.supported) {
      blocks[p.support].insert(p.block);
      held[p.block].points.push_back(p.arm);
      held[p.block].support = p.support;
    }
    for (const auto& [block, h] : held) {
      double extent = 0;
      for (const Vec2 a : h.points)
        for (const Vec2 b : h.points) extent = std::max(extent, norm(a - b));
      const double size = scene_.blocks.size[block];
      if (h.points.size() < 2 || blocks[h.support].size() > 1 || extent >= kLeastHeld * size) continue;
      const SupportInput& s = model_.supports[h.support];
      findings_.warning(
          s.where, "support." + s.name,
          fmt::format("holds block \"{}\" over {:.3g} m of its {:.3g} m: a torque there takes huge forces",
                      scene_.blocks.name[block], extent, size),
          "hold it over more of its length, or at one point");
      return;
    }
  }

  // The weight above each block against the stiffness of the joints around it: blocks that close their joints
  // by a share of their thickness are no longer where they were drawn.
  void check_closing() {
    const double gravity = -model_.gravity.y;
    if (!(gravity > 0) || scene_.layout.blocks.empty()) return;
    const std::vector<double> top = tops();
    const double usual = median(scene_.blocks.thinness);
    double worst = kMostClosing;
    int worst_block = -1, worst_joint = -1;
    for (int i = 0; i < scene_.blocks.count; ++i) {
      if (scene_.blocks.kind[i] != BlockKind::kDeformable || scene_.blocks.thinness[i] < 0.2 * usual)
        continue;
      const BlockShape& shape = scene_.layout.blocks[i];
      const double density = model_.materials[shape.material].density;
      const Vec2 at = scene_.blocks.centroid[i];
      const double weight = density * gravity * std::max(0.0, top[column_of(at.x)] - at.y);
      std::set<int> joints(shape.edge_joint.begin(), shape.edge_joint.end());
      if (joints.empty()) joints.insert(scene_.layout.default_joint);
      for (const int j : joints) {
        if (j < 0) continue;
        const JointProperty& joint = model_.joints[j];
        if (joint.bonded || !(joint.normal_stiffness > 0)) continue;
        const double share = weight / joint.normal_stiffness / scene_.blocks.thinness[i];
        if (share > worst) worst = share, worst_block = i, worst_joint = j;
      }
    }
    if (worst_block < 0) return;
    const JointProperty& joint = model_.joints[worst_joint];
    findings_.warning(
        joint.where, "joint." + joint.name + ".normal_stiffness",
        fmt::format("{:.3g} Pa/m is soft: the weight above block \"{}\" closes the joint by {:.2g} % "
                    "of the block's thickness",
                    joint.normal_stiffness, scene_.blocks.name[worst_block], 100 * worst),
        fmt::format("about {:.2g} Pa/m would close it by 1 %", joint.normal_stiffness * worst / 0.01));
  }

  // Highest corner in each of kColumns strips of the model [m].
  std::vector<double> tops() {
    std::vector<double> top(kColumns, -std::numeric_limits<double>::infinity());
    left_ = std::numeric_limits<double>::infinity(), width_ = 0;
    double right = -left_;
    for (const BlockShape& b : scene_.layout.blocks)
      for (const Vec2 p : b.polygon) left_ = std::min(left_, p.x), right = std::max(right, p.x);
    width_ = (right - left_) / kColumns;
    for (const BlockShape& b : scene_.layout.blocks) {
      const Box box = bounding_box(b.polygon);
      for (size_t c = column_of(box.min.x); c <= column_of(box.max.x); ++c)
        top[c] = std::max(top[c], box.max.y);
    }
    return top;
  }
  size_t column_of(double x) const {
    return static_cast<size_t>(std::clamp((x - left_) / width_, 0.0, kColumns - 1.0));
  }

  static constexpr int kColumns = 200;
  double left_ = 0, width_ = 1;

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
