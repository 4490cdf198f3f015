#pragma once
// What a model just bears: by which factor joint strength can be divided, or how far a load, the tilt of its ground or a
// horizontal acceleration can be raised. Theory: docs/theory.md section 14.8.

#include <functional>
#include <memory>
#include <optional>

#include "talus/run/saved_state.h"

namespace talus {

/// One run at reduced strength, or with a raised action.
struct SafetyTrial {
  double factor = 1;
  double from =
      0;  // factor of the trial from whose end it went on; 0: from the end of the stages, or their start
  bool stands = false;
  std::string outcome;  // "at rest", "needles move" (but nothing else), "displacement limit", "no rest"
  std::string stage;    // in which it ended
  double time = 0;      // [s] at its end
  int64_t steps = 0;
  double displacement = 0;  // since anything was raised [m] of the block that came nearest to its limit
  std::string block;        // that one
  double unbalanced = 0;    // at the end
  double closure = 0;       // of the energy ledger
};

enum class SafetyStatus { kFound, kBelow, kAbove };

struct SafetyResult {
  std::vector<SafetyTrial> trials;  // as they were run
  SafetyStatus status = SafetyStatus::kFound;
  double stands = 0, fails = 0;  // last factor that stands, first that fails; 0: none
  double coarse = 0;  // the same by a ladder of every second rung: slip goes by the path; 0: not sought
  double factor() const { return 0.5 * (stands + fails); }
};

/// Number of stages that trials run: the static ones that the model begins with, or those up to `safety.at`.
int safety_stages(const Model& model);

/// Throws InputError when the model has no leading static stage, or slivers with joints were merged or deleted
/// and `safety.accept_merged` is not set.
void check_safety(const PreparedRun& prepared);

/// How it is sought, who is told, and where its mechanism goes.
struct SafetySettings {
  int jobs = 1;  // trials side by side; more try other factors, and come to the same within the tolerance
  std::function<void(const SafetyTrial&)> told;  // shown each trial when it ends
  /// An observer of one more run of the last trial that stands and the first that fails, whose scene it is; none: not
  /// run.
  std::function<std::unique_ptr<Observer>(const Scene& scene, const SafetyTrial& trial)> keeper;
  /// Shown what that run came to, before its observer ends.
  std::function<void(Observer& keeper, const RunResult& result)> kept;
  std::vector<SafetyTrial> known;  // of a search that was broken off: what they say is taken over
  /// Keeps the state of a trial that stood, before it is told, and has it again for a search that goes on: where there is
  /// none the trial is run again. Factor 0: the stages before anything is raised. `saved` is called while no trial is at
  /// work.
  std::function<void(const SafetyTrial& trial, const Archive& state)> save;
  std::function<std::optional<Archive>(const SafetyTrial& trial)> saved;
};

/// Seeks what the model bears between model.safety.lowest and .highest. Throws NumericalError naming the factor when a
/// trial ends for another reason than failure of the model, InputError as check_safety().
/// @param prepared  the model as read and cut once: all trials have the same blocks
SafetyResult seek_safety(const PreparedRun& prepared, const Workers& workers,
                         const SafetySettings& settings = {});

/// "factor of safety", "load factor", "tilt [deg]", "acceleration [g]".
const char* name_of(SafetyBy by);

/// Table of the trials for people, and the files safety.csv and safety.json.
std::string safety_line(const SafetyTrial& trial);
std::string safety_text(const Model& model, const SafetyResult& result);
std::string safety_csv(const SafetyResult& result);
std::string safety_json(const Model& model, const SafetyResult& result);

}  // namespace talus
