#pragma once
// A run that goes on from the saved state of another one, in a folder of its own, with a model that may differ in what
// only begins later.

#include "talus/model/model_keys.h"
#include "talus/run/saved_state.h"

namespace talus {

/// Where a branch comes from.
struct BranchOrigin {
  std::string state;              // path of the saved state
  std::string digest;             // text_hash() of its bytes
  std::string model_hash, stage;  // of the run that it was saved of, and the last stage that this had begun
  bool between = false;           // that stage had ended
  int64_t step = 0;
  double time = 0;                   // [s]
  std::vector<std::string> differs;  // "load.wind.pressure: 2000, was 1000"
  bool same_monitors = true, same_output = true;
};

/// Sorts the keys in which two models differ into those that say what begins later, or how it is watched and solved, and
/// those that say how the state came to be.
struct BranchKeys {
  std::vector<KeyDifference> later, earlier;
};
/// @param begun     names of the stages that the state has been through, the present one included
/// @param moved     the clock of the histories has run
/// @param bolted    bolts have been installed
BranchKeys branch_keys(const ModelKeys& now, const ModelKeys& before, const std::vector<std::string>& begun,
                       bool moved, bool bolted);

/// A saved state for a branch of it. The contacts of `prepared` get the give of the parent's.
/// @param name  of its file, for messages and for origin.state
/// Throws FileError as read_saved_run(), InputError naming every key that may not differ.
SavedRun branch_of(const std::string& name, const std::string& bytes, PreparedRun& prepared,
                   BranchOrigin& origin);

}  // namespace talus
