#pragma once
// The audit of every step: forces that vanish while the two blocks still overlap, and blocks that go through
// each other within one step. As cheap as a look over the contacts; polygons are made only where something
// may be wrong. Theory: docs/theory.md section 12.

#include <functional>

#include "talus/audit/findings.h"
#include "talus/audit/frame.h"

namespace talus::audit {

/// A contact point of a step.
struct StepPoint {
  int block_a = -1, corner = -1, block_b = -1, edge = -1;
  double normal_force = 0, gap = 0;  // [N], [m] of positions
  bool hard = false;                 // no force by its overlap: it may keep one as the two part
  Vec2 place = {}, normal = {};      // of an end of a patch, whose edge is less than -1
  double damping_time = 0;           // of its dashpots, which take from its force as the two part [s]

  bool same_place(const StepPoint& o) const {
    return block_a == o.block_a && corner == o.corner && block_b == o.block_b && edge == o.edge;
  }
};

/// What does not change during a stage.
struct StepBlock {
  double size = 0;    // root of the area [m]
  double radius = 0;  // of a circle around the centroid that holds it [m]
  double thin = 0;    // at most its least mean thickness: area over diameter [m]
  Hold hold = Hold::kFree;
};

struct Step {
  double time = 0, step = 0;             // [s], length of the time step [s]
  const std::vector<StepPoint>& points;  // pair by pair of blocks, in the same order in every step
  const std::vector<Vec2>& centroid;     // [blocks]
  const std::vector<StepBlock>& blocks;
  std::function<Block(int)> shape;  // of one block now
};

class Watch {
 public:
  explicit Watch(const Rules& rules) : rules_(rules) {}

  /// Compares with the step before; the first step, and the first after forget(), is only remembered.
  void look(const Step& step, Report& report);
  /// At the start of a stage: blocks may have gone.
  void forget() { known_ = false; }

  /// Under names that begin with `name`.
  void save(Saver& to, const std::string& name) const;
  void load(Loader& from, const std::string& name);
  /// Whether what it remembers is of blocks with these numbers of corners.
  bool fits(const std::vector<int>& corners) const;

 private:
  template <class X, class Self>
  static void exchange(X& x, Self& self, const std::string& name);
  void forces_gone(const Step& step, Report& report) const;
  void judge(const Step& step, const StepPoint& before, const StepPoint* now, double mean,
             Report& report) const;
  void judge_patch(const Step& step, const StepPoint& before, const StepPoint* now, double mean,
                   const Block& a, const Block& b, Report& report) const;
  void blocks_through(const Step& step, Report& report) const;
  bool went_through(const Step& step, int i, int j, Vec2& at) const;

  const Rules& rules_;
  bool known_ = false;
  std::vector<StepPoint> before_;  // those that carried a force
  std::vector<Vec2> centroid_before_;
};

}  // namespace talus::audit
