#pragma once
// Rock bolts: installed along a line through the blocks as they lie, then springs between the blocks as
// rows, and forces inside the blocks. Theory: docs/theory.md 4.21.

#include "talus/blocks/state.h"
#include "talus/rows/rows.h"
#include "talus/rows/step_clock.h"

namespace talus {

/// One bolt of the model, without force except for its pretension; a superposed one as a piece for each
/// block.
/// @param trouble  gets why it cannot be, "" when it can
std::vector<Bolt> make_bolt(const Model& model, const BlockSet& blocks, const State& state, int input,
                            std::string& trouble);

/// Bolts that cannot be in the blocks as they lie at the start, without those excavated by then, are told to
/// `findings`; so are anchored and grouted ones tied to a block that is excavated later.
void check_bolts(const Model& model, const Layout& layout, const BlockSet& blocks, Findings& findings);

/// Installs the bolts that begin with this stage. Throws NumericalError when the blocks have moved away from
/// where one was to be.
void install_bolts(const Model& model, const BlockSet& blocks, int stage, State& state);

/// Balance of all bolts for the blocks as they lie: forces, what slips, yields and ruptures.
void balance_bolts(State& state);

/// Adds the forces of the bars inside each block.
void add_bolt_forces(const BlockSet& blocks, const State& state, std::vector<BlockForce>& force);

/// Two rows for each crossing, along and across the bar, in the order of the bolts.
/// @param before  rates half a step ago
void add_bolt_rows(const BlockSet& blocks, const State& state, const std::vector<BlockRate>& before,
                   const StepClock& clock, RowSet& rows);

/// Takes over the impulses of the rows.
void remember_bolts(const RowSet& rows, const StepClock& clock, State& state);

/// A piece of a bolt as users see it, of one bolt.
struct BoltPart {
  int input = -1;  // bolt of the model
  int piece = 0;   // along the bolt
  bool crossing = false;
  Vec2 from, to;          // as they lie [m]
  double axial = 0;       // > 0: tension [N]
  double shear = 0;       // [N]
  double elongation = 0;  // since installation [m]
  enum Condition { kElastic, kYielded, kRuptured } condition = kElastic;
};

/// All pieces of all bolts, bolt by bolt.
std::vector<BoltPart> bolt_parts(const BlockSet& blocks, const State& state);

}  // namespace talus
