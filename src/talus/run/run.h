#pragma once
// The stages of a run, one after the other, and what came of them.

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "talus/run/instant.h"

namespace talus {

struct StageResult {
  std::string name;
  StageKind kind = StageKind::kDynamic;
  StagePlan plan;
  int64_t steps = 0;
  double begin = 0, end = 0;  // [s]
  double unbalanced = 0;      // at the end
  bool at_rest = false;       // static stages
  // of a stage that did not come to rest in steps from rest: how many it took, when damped motion began [s], and why
  int64_t steps_from_rest = 0;
  double followed_from = 0;
  std::string followed_because;  // "": it is not followed

  int balances = 0;  // found, of those of its path

  std::string left_out;       // blocks that were not waited for: who, which way, on what; "": none
  double left_out_share = 0;  // of the area of all that can move

  bool followed() const { return !followed_because.empty(); }
};

struct RunResult {
  // made and taken apart in one file: here every file of the program would hold that code
  RunResult();
  RunResult(const RunResult&);
  RunResult(RunResult&&) noexcept;
  RunResult& operator=(const RunResult&);
  RunResult& operator=(RunResult&&) noexcept;
  ~RunResult();

  std::vector<StageResult> stages;
  int64_t steps = 0, failed_steps = 0, second_solver_steps = 0, iterations = 0;
  int64_t loose_steps = 0;                             // above solver.tolerance, within solver.limit
  std::array<int64_t, kSolverName.size()> steps_by{};  // by the solver whose result stands
  int most_contacts = 0, most_iterations = 0, candidate_rebuilds = 0;
  double worst_error = 0, worst_error_time = 0;  // [m], [s]
  std::string worst_error_row;
  double deepest_drift = 0;                  // [m] overlap of hard contacts
  double closed_share = 0, closed_time = 0;  // largest overlap, as share of the thinner block; when [s]
  std::string closed_row;
  // largest acceleration in dynamic stages of a block that a joint with stiffness pushes the most [m/s2], when [s], which and what
  double jolt = 0, jolt_time = 0;
  std::string jolt_row;
  int64_t ringing_steps = 0;                         // in which blocks knocked on each other that ring
  Energy energy;                                     // at the end
  double largest_left_over = 0, largest_energy = 0;  // [J] over the run
  int broken_faces = 0;
  bool interrupted = false;
  bool no_rest = false;              // a static stage ended without it
  bool mechanism = false;            // as something slides
  int64_t cut_steps = 0, parts = 0;  // steps cut into parts, parts in all
  // of conventional DDA: stiffness of its normal springs [N/m], deepest penetration [m], largest pivot of its matrix over the
  // smallest
  double penalty = 0;
  double penetration = 0, condition = 1;
  std::string failure;  // text of the NumericalError that ended the run, "" otherwise
  double wall_seconds = 0, cpu_seconds = 0;
  int threads = 1;
  Profile profile;

  /// largest_left_over / largest_energy, 0 when nothing moved.
  double closure() const { return largest_energy > 0 ? largest_left_over / largest_energy : 0; }
};

/// Where a run stands between two steps, or between two stages.
struct Standing {
  RunResult result;      // so far; its last stage is the present one
  bool between = false;  // that stage has ended
};

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
