#pragma once
// summary.json: what a run came to, in one file.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "talus/audit/findings.h"
#include "talus/results/bolt_summary.h"
#include "talus/results/histories.h"
#include "talus/results/joint_report.h"
#include "talus/run/branch.h"

namespace talus {

/// What summary.json says of how the model came about.
struct RunNotes {
  std::vector<std::string> overrides;
  std::vector<std::string> warnings;  // "key: text"
  std::optional<BranchOrigin> branch = {};
};

/// Notes of a run of a model that these overrides were given to, with the warnings found in it.
RunNotes notes_of(const std::vector<std::string>& overrides, const Findings& findings);

/// What a run has to say against itself, each with the word that the closing lines begin it with: {"WARNING", "..."},
/// {"ringing", "..."}. But for its audit, which has findings.
std::vector<std::pair<std::string, std::string>> warnings_of(const Scene& scene, const RunResult& result,
                                                             const JointSummary& joints, bool audited);

/// Text of summary.json.
/// @param model  model_in_numbers() of the scene as it began, as text
std::string summary_text(const Scene& scene, const RunResult& result, const RunNotes& notes, int frames,
                         const JointSummary& joints = {}, const BoltSummary& bolts = {},
                         const Histories* histories = nullptr, const std::string& model = "{}",
                         const std::optional<audit::Report>& audit = std::nullopt);

}  // namespace talus
