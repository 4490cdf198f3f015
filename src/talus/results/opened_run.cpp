#include "talus/results/opened_run.h"

namespace talus {

StateBytes StateBytes::read(const std::filesystem::path& path) {
  return {path.string(), read_archive_bytes(path)};
}

std::unique_ptr<Recorder> OpenedRun::record(const Scene& scene, RunNotes notes) {
  const std::string name = folder->path().string();
  notes.branch = origin;
  try {
    if (origin) return Recorder::branch_off(scene, std::move(*folder), saved->archive, notes);
    if (saved) return std::make_unique<Recorder>(scene, std::move(*folder), saved->archive, notes);
    return std::make_unique<Recorder>(scene, std::move(*folder), notes);
  } catch (const std::exception& e) {
    Recorder::abandon_begun(name, e.what());
    throw;
  }
}

OpenedRun open_run(PreparedRun& prepared, const std::string& folder, const std::function<StateBytes()>& from,
                   bool goes_on) {
  OpenedRun run;
  if (!from) return run;
  if (goes_on) run.folder.emplace(ResultFolder::go_on(folder));
  const StateBytes state = from();
  if (goes_on) {
    run.saved.emplace(saved_run_of(state.name, parse_archive(state.name, state.bytes), prepared));
    Recorder::check(*run.folder, prepared.scene, run.saved->archive);
  } else {
    run.saved.emplace(branch_of(state.name, state.bytes, prepared, run.origin.emplace()));
  }
  return run;
}

}  // namespace talus
