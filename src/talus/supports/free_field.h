#pragma once
// Level ground beside a free-field side, as a column of linear finite elements that shakes on its own: its
// velocity and its dynamic stress are what the side is held against. Theory: docs/theory.md 4.12,
// after eq. 34 of the paper.

#include <limits>
#include <optional>

#include "talus/blocks/state.h"
#include "talus/cut/selection.h"
#include "talus/rows/step_clock.h"
#include "talus/supports/ground.h"

namespace talus {

/// Ground between two heights.
struct ColumnElement {
  double height = 0;   // [m]
  double density = 0;  // [kg/m3]
  Stiffness stiffness{};
  int block = -1;  // at the side: its body forces act on the element
};

/// What the column stands on: dashpots with what comes in through them, or a prescribed motion.
struct ColumnBase {
  bool viscous = false;
  double impedance[2] = {0, 0};  // rho cs, rho cp: along x and y [Pa s/m]
  int history[2] = {-1, -1};     // along x and y
  double incoming = 0;           // velocity of the bare half-space per value of the history: 2 or 1
  Motion motion[2];              // when not viscous; kFree: no force either
};

struct GroundColumn {
  int boundary = -1;  // of the model
  int first_node = 0, first_element = 0, elements = 0;
  ColumnBase base;
  double top_impedance[2] = {0, 0};  // of dashpots on its top, along x and y [Pa s/m]; 0: free
};

struct FreeField {
  std::vector<GroundColumn> columns;
  std::vector<ColumnElement> elements;  // upwards, column by column
  std::vector<double> height;           // [n_nodes] upwards, column by column [m]
};

/// One side as a column: nodes at the heights of the corners of its edges.
/// What cannot be a column (gaps, rock that changes at one height) is told to `findings`.
/// @param edges  of the side
void add_column(const Model& model, const Layout& layout, int boundary,
                const std::vector<SelectedEdge>& edges, FreeField& field, Findings& findings);

/// Longest stable step of the columns while their elasticity is explicit [s], and the boundary of the model
/// whose column sets it; infinite and -1 without any.
struct ColumnStep {
  double dt = std::numeric_limits<double>::infinity();
  int boundary = -1;
};
ColumnStep stable_step(const FreeField& field, bool lumped);

/// What the columns do in a step.
struct ColumnMotion {
  std::vector<Vec2> velocity;      // [n_column_nodes] at this instant [m/s]
  std::vector<Vec2> displacement;  // whose stress acts in the kick: of this instant, or with implicit
                                   // elasticity that and what the rates make of it [m]
};

/// The kick of all columns: new rates in `state`, the motion of the step in `motion`.
/// @pre  the histories run
/// @param damping_mass  [1/s]
/// @param elastic       where elasticity of the ground is in the mass of the step, as that of blocks: how it is weighted
///                      (theory 4.9); else nothing
/// @param acceleration  body force per mass on each block [m/s2]
void kick_columns(const FreeField& field, const std::vector<History>& histories, const StepClock& clock,
                  double damping_mass, bool lumped, const std::optional<StepClock::ElasticWeights>& elastic,
                  const std::vector<Vec2>& acceleration, State& state, ColumnMotion& motion);

/// Stress xx, yy, xy in an element [Pa]. @param column  that it belongs to
std::array<double, 3> column_stress(const FreeField& field, const GroundColumn& column, int element,
                                    const std::vector<Vec2>& displacement);

/// Value at a height, linear between nodes.
Vec2 at_height(const FreeField& field, const GroundColumn& column, double height,
               const std::vector<Vec2>& node);

/// Elements that a segment passes, with the length of it that is there times the weight of its first end (1
/// at `from`, 0 at `to`) [m].
std::vector<std::pair<int, double>> shares_of_segment(const FreeField& field, const GroundColumn& column,
                                                      Vec2 from, Vec2 to);

}  // namespace talus
