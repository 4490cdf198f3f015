#pragma once
// Who votes in a trial of `talus safety`, and who has failed. Theory: docs/theory.md section 14.8.

#include <atomic>

#include "talus/run/run.h"

namespace talus {

/// Who votes in a trial, and how far each may go.
struct Electorate {
  explicit Electorate(const Scene& scene);

  std::vector<bool> votes;       // [blocks]
  std::vector<double> limit;     // [blocks] [m]
  bool may_rest_beyond = false;  // past its limit a block has failed only while it moves
};

/// Sees how far blocks move, and ends the trial when one has moved too far. May forward what it sees to a second
/// observer, which has no say.
class Watch : public Observer {
 public:
  /// @param since   displacements from which ways are counted; empty: those at the start of each stage
  /// @param second   shown all; none: nullptr
  /// @param given_up  ends it, too, when it becomes true
  Watch(const Scene& scene, const Electorate& electorate, const std::vector<Vec2>& since, Observer* second,
        const std::atomic<bool>& given_up)
      : electorate_(electorate), scene_(scene), since_(since), second_(second), given_up_(given_up) {}

  void stage_begins(const Scene& scene, int stage, const StagePlan& plan) override;
  void stage_is_followed(const Scene& scene, int stage, const StagePlan& plan,
                         const std::string& why) override;
  void at(const Instant& i) override;
  void fails(const Instant& i) override;
  bool stop() override { return failed() || given_up_; }

  bool failed() const { return failed_ || fell_; }
  /// Whether nothing that votes keeps the last stage from rest.
  bool only_needles_move(double unbalanced) const;
  /// Way [m] of the block that came nearest to its limit, and that block.
  double farthest() const { return farthest_; }
  size_t block() const { return block_; }

 private:
  void look(const Instant& i);

  const Electorate& electorate_;
  const Scene& scene_;
  const std::vector<Vec2>& since_;
  Observer* second_;
  const std::atomic<bool>& given_up_;
  bool failed_ = false, beyond_ = false, fell_ = false;
  double farthest_ = 0, begin_ = 0, peak_ = 0, speed_left_ = 0;
  int worst_ = -1;
  size_t block_ = 0;
  std::vector<Vec2> start_;
};

}  // namespace talus
