#pragma once
// A step of conventional DDA (Shi 1988): displacements of all blocks at once, by an implicit scheme, with springs of a
// given stiffness at contacts and open-close iteration. Theory: docs/theory.md section 13.

#include <limits>

#include "talus/penalty/springs.h"
#include "talus/solve/block_factor.h"
#include "talus/step/step_work.h"

namespace talus {

/// Newmark's beta and gamma. Shi's scheme of constant acceleration over the step is {1/2, 1}.
struct Newmark {
  double beta = 0.5, gamma = 1;
};

struct PenaltySettings {
  std::array<double, 2> stiffness{};  // of contact springs, normal and shear [N/m]
  double support_stiffness = 0;       // of supports [N/m]
  Newmark scheme;
  bool exact_rotation = false;  // false: blocks grow as they turn, and stress keeps its axes
  double dynamic_factor = 1;    // share of the velocity that goes on to the next step: 0 static, 1 dynamic
  int most_iterations = 25;     // open-close iterations of a step, before it is cut to a third
  int most_cuts = 12;           // of one step in a row
  double largest_displacement =
      std::numeric_limits<double>::infinity();  // of a step, above which it is cut [m]
};

/// What a step took.
struct PenaltyReport {
  int iterations = 0;               // open-close, over all parts of the step
  int parts = 1;                    // into which it was cut
  int changes = 0;                  // states that changed, over all iterations
  double largest_displacement = 0;  // of a centroid in a part [m]
  double penetration = 0;           // deepest, of a contact [m]
  double condition = 1;             // largest pivot of the matrix over its smallest, worst part
};

/// Gives a state what such steps carry on: the stress that blocks begin with, and accelerations where the scheme goes
/// by them.
void begin_penalty(const Scene& scene, const Newmark& scheme, State& state);

class PenaltySteps {
 public:
  PenaltySteps(const Scene& scene, StepWork& work) : scene_(scene), work_(work) {}

  /// Takes the blocks from state.time to `end`, in parts where iterations do not come to an end or blocks go too
  /// far. Work, forces, contacts, stress and rows are those at `end` then.
  /// Throws NumericalError, with time, block and contact, where a part cannot be cut any more, the matrix is not
  /// positive definite, or a block is turned inside out.
  PenaltyReport step(const PenaltySettings& settings, double end, bool dynamic, State& state);

  /// Rows and places as they stand at the begin of a stage, or where a run goes on, with the forces that contacts
  /// remember.
  void stand(const PenaltySettings& settings, double dt, State& state);

  /// Ledger and contacts as they stand at state.time.
  StepReport report(const State& state) const;

 private:
  bool try_part(const PenaltySettings& settings, double dt, bool dynamic, State& state,
                PenaltyReport& report);
  void gather(const PenaltySettings& settings, double dt, State& state);
  void seek_contacts(State& state);
  void find_pattern();
  void push(int block, const Six& row, double force);
  void assemble(const BlockSet& blocks);
  bool solve_with_friction();
  void finish(const PenaltySettings& settings, double dt, State& state, PenaltyReport& report);
  void show(const PenaltySettings& settings, double dt, State& state);
  void write_rows(double dt, State& state);

  const Scene& scene_;
  StepWork& work_;
  std::vector<Spring> springs_;
  std::vector<SpringRows> rows_;
  std::vector<int> pair_of_;               // [springs] index in pairs_, -1: one of the two does not move
  std::vector<std::array<int, 2>> pairs_;  // of blocks with springs between them
  std::vector<Tile> own_, diagonal_, beside_;
  std::vector<Six> pushed_;   // force on each block but that of its springs
  std::vector<Six> outside_;  // of it, weight and loads
  std::vector<double> solution_;
  std::vector<Six> displacement_;
  std::vector<double> pressure_;  // [springs] that friction makes [N]
  BlockFactor factor_;
  struct Held {
    int point = 0;
    Six row[2];
    double off[2] = {0, 0}, stiffness[2] = {0, 0};
  };
  std::vector<Held> held_;
};

}  // namespace talus
