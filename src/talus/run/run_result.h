#pragma once
// What came of a run and of its stages, and where it stands.

#include <array>
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

}  // namespace talus
