#pragma once
// The contact equations of one step as a file, and their replay with any solver: for a step that failed,
// or one that somebody doubts.

#include <filesystem>
#include <string>

#include "talus/run/instant.h"

namespace talus {

/// Everything a solver needs for the step at `instant`, as JSON: masses, free velocities, rows, first guess.
std::string problem_text(const Instant& instant);

struct Replay {
  int points = 0, blocks = 0;
  Solved solved;
  RowSet rows;  // with the solution
};

/// Solves a problem written by problem_text(). Throws FileError naming file and cause.
/// @param options    method (kAuto: what a run with these options would choose), second solver, Jacobian,
///                   most iterations and sweeps
/// @param tolerance  largest contact error [m]
Replay replay_problem(const std::filesystem::path& file, const SolverInput& options, double tolerance);

}  // namespace talus
