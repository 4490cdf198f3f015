#pragma once
// What has become of the bolts of a run.

#include <string>
#include <vector>

#include "talus/output/archive.h"
#include "talus/output/bolt_lines.h"

namespace talus {

/// Bolts count once, by the worst of their pieces.
struct BoltSummary {
  int bolts = 0, yielded = 0, ruptured = 0;  // those that are ruptured are not among the yielded ones
  double tension = 0;                        // the largest of a piece [N]
  std::string tension_in;                    // the bolt that has it

  static BoltSummary of(const std::vector<BoltLine>& lines);
  /// "4 of 10 ruptured, 6 yielded; largest tension 390 kN in face[8]"
  std::string text() const;
  /// Under names that begin with `name`.
  void save(Saver& to, const std::string& name) const;
  void load(Loader& from, const std::string& name);
};

}  // namespace talus
