#pragma once
// What a solver says of its work, whichever it was.

#include <optional>

#include "talus/solve/contact_error.h"

namespace talus {

struct SolveReport {
  int iterations = 0;    // Newton: most over all islands; Gauss-Seidel: sweeps
  int second_phase = 0;  // of them, accelerated ones
  int colours = 0;       // of Gauss-Seidel's couples
  int islands = 0;
  int largest_island = 0;              // points
  bool gave_up = false;                // sweeps: more were to be expected than they are worth
  bool converged = true;               // by the solver's own residual; the judge is contact_error()
  std::optional<ContactError> judged;  // what the judge said when it was last asked, if of just what stands
};

}  // namespace talus
