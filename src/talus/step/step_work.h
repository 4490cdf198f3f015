#pragma once
// What a step is told, works with and says of itself.

#include <array>
#include <string>
#include <vector>

#include "talus/contact/patch_rows.h"
#include "talus/rows/profile.h"
#include "talus/solve/solvers.h"
#include "talus/step/energy.h"
#include "talus/step/scene.h"

namespace talus {

struct StepSettings {
  double damping_mass = 0;       // [1/s]
  double damping_stiffness = 0;  // [s]
  double damping_local = 0;      // [-]
  double tolerance = 0;          // contact error that the solvers aim at [m]
  double limit = 0;              // largest that a step may keep, where that is more [m]
  double sharper = 1;            // share of it to which steps are solved where that takes few sweeps more
  bool dynamic = true;           // in true time; false: static
  double history_dt = 0;         // static: by how much the histories go on in the step [s]
  bool implicit = false;         // block-implicit elasticity (theory 4.9)
  bool from_rest = false;        // backward Euler, and blocks stand after it (theory 14.1)
  bool near_expected = false;    // such a step is likely to end near the rates that the state comes with
  bool by_all = false;           // every solver may try, though a shorter step from rest could be taken
  bool may_shorten = false;      // a step that is not solved is not taken
  bool keep_guess = false;       // StepWork::guess is wanted, for a problem file
};

/// Work that one kick does, half at the velocity before and half at the velocity after it: the second half
/// belongs to the interval that follows.
struct KickWork {
  WorkDone before, after;
};

struct StepReport {
  int contacts = 0;                       // contact points found
  int closed = 0;                         // of them, with a force
  int searched = 0;                       // pairs of blocks whose contact points were sought anew
  SolverKind method = SolverKind::kAuto;  // whose result stands
  SolveReport solve;
  ContactError error;
  std::string worst;    // name of the row with the worst error
  bool failed = false;  // error above the limit
  bool loose = false;   // above the tolerance, within the limit
  bool taken = true;    // false: it has failed and may be shortened, and the state moves as before
  Attempts attempts;
  double closed_share = 0;  // largest overlap of a contact, as share of the thinner block there
  int closed_row = -1;      // its row
  double drift = 0;         // deepest overlap of hard contacts before the step [m]
  double unbalanced = 0;    // largest unbalanced force of a block / mean force on blocks
  int worst_block = -1;     // whose unbalanced force is the largest
  bool rings = false;       // blocks that deform knocked on each other, and nothing but alpha damps that
  double jolt = 0;          // largest acceleration of a block's centroid [m/s2]
  int jolted = -1;          // which
  double worst_force = 0;   // that force [N]
  double nudge = 0;         // kinetic energy that the forces on blocks would give them in half a step [J]
  double speed_left = 0;    // static stages: share of the velocity that is left (set by run/)
  Energy energy;
  int broken_faces = 0;  // in the drift that follows
};

/// A step in which hard contacts close that were apart (theory 4.7), and the blows of joints with a restitution.
struct Meeting {
  struct Blow {
    size_t row = 0;       // of contacts, and of supports that hold the bodies
    Impulse impulse{};    // [N s]
    double approach = 0;  // the fastest at which its sides came together [m/s]
  };
  std::vector<Blow> blows;  // by rows
  std::vector<BlockRate>
      rate;  // [count] what the forces from then on begin with, as work.rate_free those until then; empty: none
             // closes
  bool failed = false;  // blows that are not solved to the last digits

  bool is_one() const { return !rate.empty(); }
};

/// Memory reused from step to step, and what the step found at this instant.
struct StepWork {
  Workers workers;
  Profile profile;
  SolverSet solvers;
  PatchSearch patches;
  StepClock clock;                 // of this step
  std::vector<Mobility> mobility;  // of this step
  double mobility_share = 0;       // for which `mobility` was made, 0: for an implicit step or none
  std::vector<double> gaps;        // of the rows of contacts, > 0 apart [m]
  RowSet rows;                     // of all families
  std::vector<BlockRate> rate_before;
  std::vector<BlockRate> rate_expected;  // of a step from rest: those of the one before
  ColumnMotion columns;                  // of the free field
  std::vector<Vec2> column_rate_before;  // State::column_rate before the kick
  KickWork work;
  Meeting meeting;
  std::vector<BlockRate> rate_free;     // rates as they would be without rows
  std::vector<Impulse> guess;           // of all rows; empty unless it is wanted
  std::vector<BlockForce> load;         // by loads and kept rock, on each block
  std::vector<BlockForce> forces;       // weight, loads, elasticity and bars inside, on each block
  std::vector<BlockForce> bolt_forces;  // of them, the bars; empty without bolts
  std::vector<BlockForce> local_damping;
  std::vector<ElasticState> elastic;

  /// The rates without the rows that these were solved with.
  const std::vector<BlockRate>& rate_given() const { return meeting.is_one() ? meeting.rate : rate_free; }
};

/// Velocities of block i at this instant: the mean of those before and after the kick; at the start the
/// initial ones. @pre  between kick() and drift()
BlockRate rate_now(const StepWork& work, const State& state, size_t i);

/// What the rows of the step are like, for whoever solves them. @pre  the rows are gathered
RowKinds row_kinds(const Scene& scene, const StepWork& work);

/// "striker corner 1 on bar[0,0] edge 3", for messages.
std::string row_name(const Scene& scene, const State& state, const StepWork& work, size_t row);

}  // namespace talus
