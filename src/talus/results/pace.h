#pragma once
// How long what goes on will still take, by how fast it has gone.

#include <string>
#include <vector>

namespace talus {

/// Steps against wall time. Steps get dearer or cheaper as blocks come together and apart: the pace of all that is over and that
/// of the latter half of its time are told for what is to come; no bound of it.
class Pace {
 public:
  struct Range {
    double low = 0, high = 0;  // [s]
  };

  /// @param wall   [s]
  /// @param steps  that are over then
  void begin(double wall, double steps) { marks_ = {{wall, steps}}; }
  /// @pre  begin(); neither is less than the last time
  void add(double wall, double steps) { marks_.push_back({wall, steps}); }
  /// Wall time of so many more steps; empty, 0 to 0, before any are over.
  Range of(double steps) const;

 private:
  struct Mark {
    double wall, steps;
  };
  std::vector<Mark> marks_;
};

/// "2 min 5 s", or "1 min to 3 min" where the two are apart by more than a tenth.
std::string readable_range(const Pace::Range& range);

}  // namespace talus
