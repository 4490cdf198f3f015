#include "support/contact_paths_laws.h"

#include <algorithm>
#include <utility>

#include "support/block_scene.h"
#include "talus/contact/patch_rows.h"

namespace talus::test {

namespace {

constexpr double kStiffness = 1e9;  // normal and shear [Pa/m]
// what slides stays where its law has put it: the blocks go on by themselves
constexpr StepClock kClock{.dt = 1e-3, .dt_kick = 1e-3, .alpha = 1};

Scene path_scene(const ContactPath& path) {
  Model model = jointed_rock();
  model.joints[0].normal_stiffness = model.joints[0].shear_stiffness = kStiffness;
  std::vector<ScenePart> parts;
  for (const Polygon& p : path.blocks) parts.push_back({p, BlockKind::kRigid});
  return block_scene(std::move(model), parts);
}

// Impulse of one row at a point that stands still.
double yielding(const Row& row, double by_partner, Bounds bounds) {
  if (row.compliance <= 0) return 0;
  return std::clamp(-(row.bias + by_partner) / row.compliance, bounds.lower, bounds.upper);
}

// Row k of a point, and of its partner where it has one.
void solve_couple(int k, size_t first, RowSet& rows) {
  const PointRows& p = rows.points[first];
  double& here = rows.impulse[first][k];
  here = 0;
  if (p.partner < 0) {
    here = yielding(p.row[k], 0, bounds_of(p, k, rows.impulse[first][0]));
    return;
  }
  const int second = p.partner;
  const PointRows& q = rows.points[second];
  double& there = rows.impulse[second][k];
  there = 0;
  constexpr int kSweeps = 30;  // each leaves a quarter of the error
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    here = yielding(p.row[k], p.cross(k) * there, bounds_of(p, k, rows.impulse[first][0]));
    there = yielding(q.row[k], q.cross(k) * here, bounds_of(q, k, rows.impulse[second][0]));
  }
}

class PatchForces : public ContactForces {
 public:
  explicit PatchForces(const ContactPath& path)
      : path_(&path), scene_(std::make_shared<const Scene>(path_scene(path))), state_(start_state(*scene_)) {
    state_.step = 1;  // no stress of the ground
  }

  std::unique_ptr<ContactForces> copy() const override { return std::make_unique<PatchForces>(*this); }

  PathForces at(double s, double ds) override {
    if (!begun_) {  // the overlaps of the start were not born there
      find(s, ds);
      begun_ = true;
    }
    return find(s, ds);
  }

 private:
  PathForces find(double s, double ds) {
    if (rows_.size() > 0) go_on_to(s);
    put_blocks(s, ds);
    const LookAhead ahead{kClock, state_.rate};
    const Scene& scene = *scene_;
    renew_pairs(scene.blocks, scene.bonds, scene.layout, scene.laws, ahead, Workers(), state_);
    const std::vector<BlockRate> still(path_->blocks.size());
    rows_.restart();
    const PatchWorld world{scene.blocks, scene.outlines, scene.bonds, scene.layout, scene.model, scene.laws};
    PatchSearch().update(world, ahead, Workers(), state_);
    add_patch_rows(world, scene.give, state_, still, kClock, Workers(), rows_, gaps_);
    rows_.finish();
    for (size_t i = 0; i < rows_.size(); ++i) {
      const int partner = rows_.points[i].partner;
      if (partner >= 0 && static_cast<size_t>(partner) < i) continue;
      solve_couple(0, i, rows_), solve_couple(1, i, rows_);
    }
    const PathForces forces = summed();
    last_ = s;
    return forces;
  }

  void put_blocks(double s, double ds) {
    const std::vector<PathPose> now = path_->pose(s), before = path_->pose(s - ds),
                                after = path_->pose(s + ds);
    for (size_t i = 0; i < now.size(); ++i) {
      state_.displacement[i] = now[i].displacement;
      state_.angle[i] = now[i].turn;
      state_.strain_part[i] = rotation_minus_identity(now[i].turn);
      const double per = 1 / (2 * kClock.dt);
      state_.rate[i] = {per * (after[i].displacement - before[i].displacement),
                        spin_matrix(per * (after[i].turn - before[i].turn))};
    }
  }

  // What patches remember goes along with the blocks, turns and all, from the last place to this one.
  void go_on_to(double s) {
    const std::vector<PathPose> from = path_->pose(last_), to = path_->pose(s);
    const double per = 1 / kClock.dt;
    for (size_t i = 0; i < to.size(); ++i)
      state_.rate[i] = {per * (to[i].displacement - from[i].displacement),
                        per * rotation_minus_identity(to[i].turn - from[i].turn)};
    const std::vector<BlockRate> still(path_->blocks.size());
    for (size_t r = rows_.range(Family::kContact).begin; r < rows_.range(Family::kContact).end; ++r)
      remember_patch(scene_->blocks, scene_->laws, rows_, r, relative_velocity(rows_.points[r], state_.rate),
                     still, kClock, state_);
  }

  PathForces summed() const {
    PathForces out(path_->blocks.size());
    const double per = 1 / (kClock.dt_kick * kStiffness * scene_->blocks.thickness);
    for (size_t i = 0; i < rows_.size(); ++i) {
      const PointRows& p = rows_.points[i];
      const double size = rows_.impulse[i][0] * per;
      const Vec2 normal = size * p.normal;
      const Vec2 whole = normal + rows_.impulse[i][1] * per * turn_right(p.normal);
      for (const bool on_b : {false, true}) {
        const int block = on_b ? p.block_b : p.block_a;
        const Vec2 arm = on_b ? p.arm_b : p.arm_a;
        const double sign = on_b ? -1 : 1;
        add(sign * normal, arm, out.normal[block]), add(sign * whole, arm, out.whole[block]);
        out.load[block] += size;
      }
      out.pairs.push_back({std::min(p.block_a, p.block_b), std::max(p.block_a, p.block_b), size});
    }
    return out;
  }

  void add(Vec2 force, Vec2 arm, Resultant& sum) const {
    sum.force += force, sum.moment += cross(arm, force) / path_->size;
  }

  const ContactPath* path_;
  std::shared_ptr<const Scene> scene_;
  State state_;
  RowSet rows_;
  std::vector<double> gaps_;
  double last_ = 0;  // where it was asked last
  bool begun_ = false;
};

}  // namespace

std::unique_ptr<ContactForces> patch_forces(const ContactPath& path) {
  return std::make_unique<PatchForces>(path);
}

}  // namespace talus::test
