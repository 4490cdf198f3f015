#pragma once
// Where the wall time of a run goes, part by part. Every moment belongs to one part, so that the parts sum to the
// whole; nothing that is computed depends on it.

#include <array>
#include <cstdint>

#include "talus/base/clock.h"

namespace talus {

struct Profile {
  enum Part {
    kMargins,  // are the pairs good still, how far has each moved
    kSearch,   // contact points sought anew
    kRows,     // rows of joints and contacts
    kHeld,     // supports, boundaries, ties, free field
    kBolts,
    kLayout,   // couples, colours, places of rows in records
    kRecords,  // rows to records and back
    kSweeps,
    kAsks,  // of sweeps: the error so far
    kNewton,
    kJudge,      // error and work of the rows as they are solved
    kRemember,   // what rows carry to the next step
    kLedger,     // work and unbalanced forces of blocks
    kBlocks,     // forces, mobilities, motion of blocks
    kObservers,  // results, audit, saved states
    kRest,
    kParts
  };
  static constexpr std::array<const char*, kParts> kName{
      "margins", "search", "rows",  "boundaries", "bolts",  "layout", "records",   "sweeps",
      "asks",    "newton", "judge", "remember",   "ledger", "blocks", "observers", "rest"};

  std::array<double, kParts> seconds{};
  double shared = 0;  // of them, in which all threads had work (Workers::shared_seconds)
  double wall = 0;    // of the whole, measured apart
  // how often
  int64_t steps = 0, asks = 0, layouts = 0, sought = 0, sweeps = 0, points = 0;

  double total() const {
    double sum = 0;
    for (const double s : seconds) sum += s;
    return sum;
  }
  /// From now on time is that of `part`; returns whose it was, kParts when the clock stood still.
  Part go_on_with(Part part) {
    const double now = wall_now();
    if (running_ != kParts) seconds[running_] += now - since_;
    since_ = now;
    const Part before = running_;
    running_ = part;
    return before;
  }
  /// Time that was counted to one part and belongs to another [s].
  void move(Part from, Part to, double time) { seconds[from] -= time, seconds[to] += time; }

 private:
  Part running_ = kParts;
  double since_ = 0;
};

/// The time of its life is that of a part, but for lives within it.
class InPart {
 public:
  InPart(Profile& profile, Profile::Part part) : profile_(profile), before_(profile.go_on_with(part)) {}
  ~InPart() { profile_.go_on_with(before_); }
  InPart(const InPart&) = delete;
  InPart& operator=(const InPart&) = delete;

 private:
  Profile& profile_;
  Profile::Part before_;
};

}  // namespace talus
