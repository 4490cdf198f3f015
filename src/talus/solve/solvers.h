#pragma once
// The table of solvers, which one a step gets, and which are asked when it fails. The measured table behind
// the choice is in docs/performance.md.

#include <array>
#include <memory>

#include "talus/base/index.h"
#include "talus/solve/contact_error.h"
#include "talus/solve/solver.h"

namespace talus {

struct SolverEntry {
  SolverKind kind;
  std::unique_ptr<Solver> (*make)();
  bool smoothed;       // solves the smoothed law, too
  SolverKind mended;   // by which other one its failed steps are tried
  bool far_off;        // a failure of it is no place to begin from
  bool goes_on;        // more sweeps lead on from where any solver ended
  bool last;           // asked where all else has failed
  size_t most_points;  // of a step of another solver that it is asked to mend
};

/// @pre  not kAuto
const SolverEntry& entry(SolverKind kind);

/// One of each, made when it is first asked for; they keep what they can use again from step to step.
class SolverSet {
 public:
  Solver& of(SolverKind kind);
  void drop(SolverKind kind) { made_[place_of(kind)].reset(); }
  /// Blocks are no longer the same.
  void forget() { made_ = {}; }

 private:
  std::array<std::unique_ptr<Solver>, kSolverName.size()> made_;
};

/// What the rows of a step are like.
struct RowKinds {
  size_t hard_ties = 0;    // points of faces that are tied without any give
  bool give = false;       // some joints give
  bool at_rest = false;    // a static stage: what is near rest moves by less than errors of rows that give
  bool from_rest = false;  // a step of backward Euler
  bool by_all = false;     // which cannot be shortened any more
};

/// What the model asks for; for `auto`, what is faster for so many points, `hard_ties` of which tie faces
/// without any give; steps from rest go to Newton's method in velocities.
SolverKind chosen_solver(const Model& model, size_t points, const RowKinds& kinds);

/// Who worked at a step, in their order, and how many iterations or sweeps each.
struct Attempts {
  struct One {
    SolverKind solver = SolverKind::kAuto;
    int iterations = 0;
  };
  std::array<One, kSolverName.size() + 1> list{};
  size_t count = 0;

  void add(SolverKind solver, int iterations) { list.at(count++) = {solver, iterations}; }
  bool several() const { return count > 1; }
};

struct Solved {
  SolverKind method = SolverKind::kAuto;  // whose result stands
  SolveReport report;
  ContactError error;
  bool failed = false;  // error above the tolerance
  Attempts attempts;
};

/// Solves a step: the chosen solver; where its result misses the tolerance, another; then sweeps from the
/// best so far for as many as the model allows; last, pivoting. The best stays, and is what the judge of the problem was asked last.
/// @param kinds      of the rows: they say by which share of the tolerance solvers stop earlier than the judge
/// @param tolerance  largest contact error [m]
/// @param limit      what is less may stay where it would be dear to mend [m]
/// @param sharper    share of it to which steps are solved where that takes few sweeps more
/// @param guess      gets the first guess; empty when it is not wanted and no second solver may need it
Solved solve_step(const Model& model, const RowKinds& kinds, double tolerance, double limit, double sharper,
                  bool keep_guess, const Workers& workers, SolverSet& solvers, const StepProblem& problem,
                  std::vector<Impulse>& guess);

}  // namespace talus
