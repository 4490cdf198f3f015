#pragma once
// What the steps of a run come to: counts, worst values and where they were; and what of a step ends the run.

#include "talus/run/run_result.h"

namespace talus {

class StepNotes {
 public:
  StepNotes(const Scene& scene, const StepWork& work, RunResult& result);

  /// Throws NumericalError, with time, block and row, where a contact has closed too far or the step was not solved.
  /// @param state  that of the step: its contacts are those of the rows
  void note(const StepReport& report, const StepSettings& settings, const State& state);

 private:
  void note_jolt(const StepReport& report, const State& state);
  std::string closed_text(const StepReport& report, const State& state) const;

  const Scene& scene_;
  const StepWork& work_;
  RunResult& result_;
  bool shakes_ = false;  // something given moves the model, and its joints give
};

}  // namespace talus
