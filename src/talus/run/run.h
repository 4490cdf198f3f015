#pragma once
// The stages of a run, one after the other, and what came of them.

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "talus/run/instant.h"
#include "talus/run/run_result.h"

namespace talus {

/// Runs all stages from `state` on, showing every instant to the observer. Numerical trouble ends the run and
/// is told in `failure`; errors of the observer (files) pass through.
/// @param plans  one per stage, from plan_stages() without errors
/// @note  the results have the same bits for any number of threads
RunResult run_stages(Scene& scene, const std::vector<StagePlan>& plans, State& state, Observer& observer,
                     const Workers& workers = Workers());

/// Goes on from where a run stood, with the state it had then; the scene is that of build_scene.
RunResult continue_stages(Scene& scene, const std::vector<StagePlan>& plans, const Standing& from,
                          State& state, Observer& observer, const Workers& workers = Workers());

/// How far a run is taken: the first that is reached counts.
struct Pause {
  int64_t steps = std::numeric_limits<int64_t>::max();
  double time = std::numeric_limits<double>::infinity();  // [s] of the run, as State::time
  bool stage_end = false;                                 // between two stages
};

/// run_stages() in pieces, with the same bits however they are cut.
class StagedRun {
 public:
  /// @param from  as continue_stages(); null: from the start
  /// @note  all but `from` have to live as long as the run
  StagedRun(Scene& scene, const std::vector<StagePlan>& plans, State& state, Observer& observer,
            const Workers& workers = Workers(), const Standing* from = nullptr);
  ~StagedRun();
  StagedRun(const StagedRun&) = delete;
  StagedRun& operator=(const StagedRun&) = delete;

  /// Goes on to a pause. Errors of the observer pass through.
  /// @return  whether there is more to come: false behind the last stage, after numerical trouble (result().failure) and
  ///          where the observer has stopped it
  bool advance(const Pause& pause);
  /// Ends a run that is not over where it stands, as one that its observer stops.
  void stop();
  bool over() const;
  /// For a saved state. @pre  a stage has begun
  Standing standing() const;
  /// So far.
  const RunResult& result() const;

 private:
  class Runner;
  std::unique_ptr<Runner> runner_;
};

/// Threads that pay for a model of so many blocks, at most as many as the machine has processors.
int threads_for(int blocks);

/// What --profile prints: the share of each part of a step in the time of the run, which they sum to.
std::string profile_text(const Profile& profile, int threads);

struct PreparedRun {
  Scene scene;
  std::vector<StagePlan> plans;
};

/// Reads, checks and plans a model. `cut`, when given, takes the cut of its regions. Throws InputError with
/// all findings; warnings are left in `findings`.
PreparedRun prepare_run(const std::string& file, const std::string& text,
                        const std::vector<std::string>& overrides, Findings& findings, Cut* cut = nullptr);

/// Number of stages up to the one of this name; 0 when there is none.
size_t stages_until(const Model& model, const std::string& name);

/// Lets a run end after its first stages, of which all is as in the whole run.
/// @pre  0 < stages <= all
void end_after(PreparedRun& prepared, size_t stages);

}  // namespace talus
