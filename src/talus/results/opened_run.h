#pragma once
// How a run begins: afresh, from a saved state in the folder of its results, or as a branch of one into another folder.

#include <functional>
#include <memory>
#include <optional>

#include "talus/results/recorder.h"
#include "talus/run/branch.h"

namespace talus {

/// A saved state: what its file is called, and holds.
struct StateBytes {
  std::string name, bytes;

  /// Throws FileError.
  static StateBytes read(const std::filesystem::path& path);
};

struct OpenedRun {
  std::optional<SavedRun> saved;       // that it goes on from
  std::optional<BranchOrigin> origin;  // of a branch
  std::optional<ResultFolder> folder;  // none yet, or none at all

  /// The run's results: what they replace goes now. @pre  `folder` is there
  std::unique_ptr<Recorder> record(const Scene& scene, RunNotes notes);
};

/// Opens the folder that a run goes on in, before its state is read: who is about to write there must not do so meanwhile.
/// Throws FileError, InputError as read_saved_run() and branch_of().
/// @param folder  of results, "" : none
/// @param from    reads the state that it goes on from; null: it begins afresh
/// @param goes_on in that folder; else it branches off from the state
/// @pre  no other thread (read_archive())
OpenedRun open_run(PreparedRun& prepared, const std::string& folder, const std::function<StateBytes()>& from,
                   bool goes_on);

}  // namespace talus
