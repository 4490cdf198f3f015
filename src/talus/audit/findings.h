#pragma once
// What the audit found: one entry for each kind of defect, with its worst case and its first.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "talus/base/index.h"
#include "talus/base/vec2.h"
#include "talus/output/archive.h"

namespace talus::audit {

/// Kinds of defects, in the order in which they are told.
enum class Defect {
  kPrescribedOverlap,
  kUnexplainedOverlap,
  kDeepClosure,
  kForceVanished,
  kCrossed,
  kCoveredSide,
  kForceAcrossGap,
  kNoJoint,
  kNormalLaw,
  kEnergyLaw,
  kShearLaw,
  kClosingWork,
  kJointWork,
  kFailedSteps,
  kLooseSteps,
  kCount
};
inline constexpr size_t kDefects = place_of(Defect::kCount);
constexpr Defect last_of(Defect) { return Defect::kCount; }  // of an entry without finding

/// "force_vanished": as in summary.json.
const char* key_of(Defect defect);

struct Finding {
  Defect defect = Defect::kCount;
  bool invalid = false;  // else a warning
  int block_a = -1, block_b = -1;
  double time = 0;   // [s]
  Vec2 place;        // [m]
  double share = 0;  // how bad, by the measure of the defect: its limit is where a run is no longer valid
  std::string text;  // what there is, and what may be
};

/// All findings of a run, added up in the order of time.
class Report {
 public:
  struct Entry {
    int64_t count = 0;
    bool invalid = false;
    Finding worst, first;  // first: of those that make a run not valid, where there are any
  };

  void add(const Finding& finding);
  void add(const std::vector<Finding>& findings) {
    for (const Finding& f : findings) add(f);
  }
  const Entry& of(Defect defect) const { return entries_[place_of(defect)]; }
  bool valid() const;
  int invalid_kinds() const;
  int warning_kinds() const;

  /// One line for each kind, those that make the run not valid first: kind, pair, time, place, how often.
  std::vector<std::string> lines(const std::vector<std::string>& names) const;

  int64_t frames = 0, steps = 0;  // looked at
  int64_t patches_by_energy = 0;  // whose force was compared with the energy of the overlap
  double unexplained_share = 0;   // largest unexplained overlap, of the smaller block's area
  double unexplained_area = 0;    // the same [m2]
  double slack = 0;          // [J] what all forces may do within slop and tolerance: less work is round-off
  double closure_share = 0;  // largest closure, of the smaller mean thickness

  /// Under names that begin with `name`.
  void save(Saver& to, const std::string& name) const;
  void load(Loader& from, const std::string& name);
  /// Whether its findings are of this program, and of no block beyond so many.
  bool fits(int blocks) const;

 private:
  template <class X, class Self>
  static void exchange(X& x, Self& self, const std::string& name);

  std::array<Entry, kDefects> entries_;
};

/// "a and b"; "a" alone where there is no second.
std::string pair_text(const std::vector<std::string>& names, int block_a, int block_b);

}  // namespace talus::audit
