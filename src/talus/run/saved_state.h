#pragma once
// A run that can go on: its state, where it stands and what its observers keep, in one file. A run continued
// from it has the same bits as one that was never stopped.

#include <filesystem>

#include "talus/output/archive.h"
#include "talus/run/run.h"

namespace talus {

/// All of a State.
void save_state(Saver& to, const State& state);
void load_state(Loader& from, State& state);

/// What run_stages() needs to go on.
void save_standing(Saver& to, const Standing& standing);
void load_standing(Loader& from, Standing& standing);

/// Archive of a run: who wrote it, of which model, the state and where the run stands.
Archive run_archive(const Scene& scene, const Standing& standing, const State& state);

/// The result folder in which a saved state lies. Throws FileError when it is no result folder.
std::string folder_of_saved(const std::filesystem::path& saved);

/// Whether a saved state, or what is called so, lies in this result folder.
bool lies_in(const std::filesystem::path& saved, const std::filesystem::path& folder);

struct SavedRun {
  Archive archive;
  Standing standing;
  State state;
};

/// What of its model a state came to be by and does not hold: the give of hard contacts (theory 4.22), and the values
/// at which histories begin and stand in static stages.
inline constexpr const char *kSavedGive = "model.give", *kSavedStart = "model.history_start.";

/// Reads a saved run of this model. Throws FileError when the file cannot be used, InputError when it is of
/// another model (with the keys that differ) or of another format.
SavedRun read_saved_run(const std::filesystem::path& path, const PreparedRun& prepared);

/// The same of an archive that was read; `name` is for messages.
SavedRun saved_run_of(const std::string& name, Archive archive, const PreparedRun& prepared);

/// The same without asking whether the model is the one that it was saved of.
SavedRun take_state(const std::string& name, Archive archive, const PreparedRun& prepared);

}  // namespace talus
