#pragma once
// Edges that let waves out and in, as rows: dashpots of the medium behind, with the stress and velocity of a
// free field, with what a compliant base brings in, and with the reactions kept from a static stage.
// Theory: docs/theory.md 4.11, after Zhao et al. 2016, eqs 32-34.

#include <array>
#include <vector>

#include "talus/rows/rows.h"
#include "talus/supports/free_field.h"
#include "talus/supports/ties.h"

namespace talus {

/// One end of an edge of a viscous or free-field boundary, with its half of the edge.
struct BoundaryPoint {
  int boundary = -1;  // of the model
  int block = -1;
  Vec2 arm;                                    // reference arm [m]
  Vec2 normal;                                 // outward, of the reference shape
  double dashpot[2] = {0, 0};                  // rho c times area, along the normal and the tangent [N s/m]
  int column = -1;                             // of the free field beside it, -1: none
  double height = 0;                           // of the point [m]
  std::vector<std::pair<int, double>> beside;  // elements of the column and the area they push [m2]
  bool active = true;                          // in this stage; rows are made of active points only
};

struct BoundarySet {
  std::vector<BoundaryPoint> points;  // in the order of the model
  std::vector<TiePoint> ties;
  FreeField free_field;
};

/// All boundaries of the model. What cannot be (no elastic constants, two boundaries on one edge, ground that
/// is not level) is told to `findings`.
BoundarySet build_boundaries(const Model& model, const Layout& layout, const BlockSet& blocks,
                             Findings& findings);

/// Turns the boundaries from one kind of stage to the other: a static stage holds the points where they are
/// now and puts the free field to rest; a dynamic stage after it keeps the reactions as constant forces.
void enter_stage(const BoundarySet& set, bool was_static, bool is_static, State& state);

/// Rows of all points, in their order: static ones while the histories stand still. Residual along the normal
/// and the tangent, with z = rho c area:
///   dynamic: u + u_before - 2 target - 2 F/z + 2 p/(z dt_kick), F the kept reaction and the free-field
///   stress; static: u + (displacement - place held)/dt.
/// @param before           rates half a step ago
/// @param columns          of the free field in this step
void add_boundary_rows(const BlockSet& blocks, const Model& model, const BoundarySet& set, const State& state,
                       const std::vector<BlockRate>& before, const StepClock& clock,
                       const ColumnMotion& columns, RowSet& rows);

}  // namespace talus
