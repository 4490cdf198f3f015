#pragma once
// The audit of a run while it goes on: fills the plain data of audit/ from scene and state, at every frame,
// at the end of each stage and, for what steps show, in every step. Theory: docs/theory.md section 12.

#include "talus/audit/watch.h"
#include "talus/base/index.h"
#include "talus/run/instant.h"

namespace talus {

class Auditor {
 public:
  explicit Auditor(const Scene& scene);
  Auditor(const Auditor&) = delete;
  Auditor& operator=(const Auditor&) = delete;

  /// @param frame  a frame is written at this instant
  void at(const Instant& instant, bool frame);

  /// All that was found up to now.
  audit::Report report() const;

  /// Where it stands.
  void save(Saver& to) const;
  void load(Loader& from);

 private:
  template <class X, class Self>
  static void exchange(X& x, Self& self);
  void look_at_stage(const Instant& instant);
  void watch(const Instant& instant);
  Vec2 place_of(const State& state, const Patch& c, int end) const;
  audit::Point patch_point(const Instant& instant, size_t patch, int end) const;
  audit::Block shape(const Instant& instant, int block) const;
  audit::Frame frame_of(const Instant& instant) const;

  const Scene& scene_;
  audit::Rules rules_;
  audit::Report report_;
  audit::Watch watch_;
  bool lifting_ = false;  // some joint dilates
  double next_ = 0;       // [s] of the next audit of polygons, where an interval is given
  int64_t failed_ = 0, loose_ = 0, steps_ = 0;
  double first_loose_ = 0, loosest_ = 0;  // [s], largest error of a loose step [m]
  double first_failed_ = 0;               // [s]
  std::string worst_failed_;
  double closing_ = 0, closing_friction_ = 0, closing_time_ = 0;  // at the largest work of closing contacts
  double joints_ = 0, joints_friction_ = 0, joints_time_ = 0;     // at the largest work of elastic joints
  double largest_energy_ = 0;                                     // [J]
  // of the stage
  std::vector<audit::StepBlock> blocks_;
  std::vector<audit::StepPoint> points_;
  std::vector<Vec2> centroid_;
  bool fresh_ = true;  // the blocks of the stage are not known yet
};

}  // namespace talus
