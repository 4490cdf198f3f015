#pragma once
// What the user asked for: plain data in SI units, names resolved to indices. Nothing here moves.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "talus/base/vec2.h"
#include "talus/geometry/polygon.h"
#include "talus/model/bolt_input.h"
#include "talus/model/boundary_kind.h"
#include "talus/model/cut_input.h"
#include "talus/model/mesh_input.h"
#include "talus/model/placement.h"
#include "talus/model/solver_kind.h"
#include "talus/model/strength_scatter.h"
#include "talus/schema/findings.h"

namespace talus {

enum class Plane { kStrain, kStress };
enum class Inertia { kConsistent, kLumped };

struct Material {
  std::string name;
  double density = 1;                                         // [kg/m3]
  double young = std::numeric_limits<double>::quiet_NaN();    // [Pa], NaN when not given
  double poisson = std::numeric_limits<double>::quiet_NaN();  // [-]
  Where where = {};
};

/// As the file gives them; what they mean is in joint_law.h.
struct JointProperty {
  std::string name;
  bool bonded = false;          // never opens or slides
  double friction_angle = 0;    // [rad]
  double cohesion = 0;          // [Pa]
  double tensile_strength = 0;  // [Pa]
  double normal_stiffness = 0;  // kn [Pa/m], 0 = hard
  double shear_stiffness = 0;   // ks [Pa/m], 0 = hard
  double damping_time = 0;      // [s] of dashpots beside kn and ks (eq. 4.1b)
  double restitution = -1;      // ratio of normal velocities, -1 = as the scheme gives (theory 7.1)
  double dilation_angle = 0;    // [rad] rise per slip
  double dilation_slip = std::numeric_limits<double>::infinity();             // [m] slip up to which it rises
  double residual_friction_angle = std::numeric_limits<double>::quiet_NaN();  // [rad], NaN = friction_angle
  double residual_cohesion = 0, residual_tensile_strength = 0;                // [Pa]
  // from face to face; residual strengths scatter with those
  StrengthScatter friction_scatter = {}, cohesion_scatter = {}, tension_scatter = {};
  int kind = 0;                  // of joint_kinds()
  std::vector<double> own = {};  // of the keys that its kind alone has [SI], NaN: not given
  Where where = {};
};

enum class ContactLaw { kExact, kSmoothed };

struct ContactInput {
  ContactLaw law = ContactLaw::kExact;
  double alpha = 0.2;          // damping of compliant rows: 0 none, 1 backward Euler
  bool give = true;            // hard contacts give a little (theory 4.22)
  double slop = 1e-7;          // overlap of hard contacts left uncorrected, share of the smaller block's size
  double smoothing_force = 1;  // epsilon_1 of the smoothed law [N]
  double smoothing_slip = 6e-8;  // epsilon_2 [m]
};

/// A quantity over time: linear between points, held outside.
struct History {
  std::string name;
  std::vector<double> time;      // [s] strictly rising
  std::vector<double> value;     // SI
  std::vector<double> integral;  // of value, from time[0] to time[i]
  std::string quantity = {};  // "acceleration", "velocity" or "displacement" where a file says so by a unit
  Where where;

  double value_at(double t) const;
  /// Exact integral of the curve from 0 to t.
  double integral_at(double t) const;
};

/// A constant, or a history times a factor.
struct Signal {
  int history = -1;  // -1: constant
  double factor = 0;

  bool is_given() const { return history >= 0 || factor != 0; }
  double value_at(double t, const std::vector<History>& histories) const {
    return history < 0 ? factor : factor * histories[history].value_at(t);
  }
};

/// Motion along one axis (or of rotation): free, held, or following a history.
struct Motion {
  enum Kind { kFree, kFixed, kVelocity, kDisplacement };
  Kind kind = kFixed;
  int history = -1;

  /// Displacement prescribed at time t [m] or [rad]; 0 when held. @pre kind is not kFree
  double displacement_at(double t, const std::vector<History>& histories) const;
};

struct BlockInput {
  std::string name;
  Polygon polygon;
  int material = -1;
  BlockKind kind = BlockKind::kDeformable;
  Vec2 velocity;
  double spin = 0;
  Motion motion_x, motion_y, motion_rotation;
  Where where;
};

enum class GridPattern { kRectangles, kCrossedTriangles };

struct GridInput {
  std::string name;
  Vec2 min, max = {1, 1};  // before it is placed
  Placement place;         // about its middle
  int columns = 1, rows = 1;
  GridPattern pattern = GridPattern::kRectangles;
  int material = -1;
  int joint = -1;
  BlockKind kind = BlockKind::kDeformable;
  Vec2 velocity;
  Where where;
};

struct ContactPairInput {
  std::string name_a, name_b;  // blocks or grids
  int joint = -1;
  Where where;
};

/// Where something acts: block edges on a segment or along a line by its name, or a point; "" = no condition.
struct Selection {
  bool is_edge = false;
  Vec2 from, to;      // the segment; the point when is_edge is false
  std::string along;  // an outline side, opening, fault or joint set: all block edges along it; "": none
  std::string block;  // "": any
  Where where_block;
};

/// In which stages something acts.
struct Staged {
  std::vector<int> stages;  // of the model; empty: all

  bool acts_in(int stage) const {
    return stages.empty() || std::find(stages.begin(), stages.end(), stage) != stages.end();
  }
  /// Whether there is a stage in which both act.
  bool meets(const Staged& o) const {
    return stages.empty() || o.stages.empty() ||
           std::any_of(stages.begin(), stages.end(), [&o](int s) { return o.acts_in(s); });
  }
};

struct SupportInput : Selection, Staged {
  std::string name;
  Motion x, y;
  Where where;
};

/// How a viscous or free-field edge stands in static stages.
enum class StaticHold { kFixed, kRoller, kFree };

/// An edge that lets waves out, and in: dashpots, a column of free field, or ties to the opposite side.
struct BoundaryInput : Selection, Staged {
  std::string name;
  BoundaryKind kind = BoundaryKind::kViscous;
  int material = -1;                   // of the medium behind the edge, -1: that of each block
  int history_x = -1, history_y = -1;  // velocity that comes in [m/s], -1: none
  bool outcrop = false;                // the histories are twice the upgoing wave
  StaticHold hold = StaticHold::kFixed;
  Selection opposite;  // tied: the other side
  Where where, where_material, where_opposite;
};

enum class LoadKind { kAcceleration, kSurface, kForce };

/// What pushes blocks: an acceleration added to gravity (shaking in the frame of the base), a pressure or
/// traction on block edges, a force at a point.
struct LoadInput : Selection, Staged {
  std::string name;
  LoadKind kind = LoadKind::kAcceleration;
  bool has_place = false;  // point, edge or along is given
  Signal x, y;             // [m/s2], [Pa] or [N]
  Signal pressure;         // of a kSurface [Pa]
  double factor = 1;       // on all of it: what `talus safety` raises
  Where where;
};

enum class JacobianKind { kAnalytic, kDifference };

struct SolverInput {
  SolverKind method = SolverKind::kAuto;
  JacobianKind jacobian = JacobianKind::kAnalytic;
  double tolerance = 1e-8;  // share of the smallest block's size: what the solvers aim at
  double limit = 1e-5;      // the same: what a step may keep, at least the tolerance
  int max_iterations = 60;
  int max_sweeps = 20000;
  bool second_solver = true;  // a step that misses the tolerance is tried by the other method
  bool stop_on_failure = true;
};

enum class StageKind { kStatic, kDynamic };
constexpr StageKind last_of(StageKind) { return StageKind::kDynamic; }

/// Local damping of static stages that give none [-].
inline constexpr double kStaticDamping = 0.8;

struct StageInput {
  std::string name;
  StageKind kind = StageKind::kDynamic;
  double duration = 1;                                          // [s]
  double time_step = std::numeric_limits<double>::quiet_NaN();  // [s], NaN = automatic
  double safety = 0.8;
  bool moment_clamp = false;
  bool from_rest = false;        // static: backward Euler, every step from rest (theory 14.1)
  bool from_rest_auto = false;   // that unless it says how blocks shall move (set by build_scene)
  bool strict_rest = false;      // crumbs that fall or slide are waited for
  bool may_follow = false;       // what does not come to rest in steps from rest is followed by damped motion
  bool follow_implicit = false;  // `implicit` of that
  double follow_step = std::numeric_limits<double>::quiet_NaN();  // its time step [s], NaN = automatic
  bool implicit = false;                                          // block-implicit elasticity
  bool elasticity_auto = false;  // implicit where theory 4.9 asks for it (set by build_scene)
  double damping_mass = 0;       // [1/s]
  double damping_stiffness = 0;  // [s]
  bool damping_auto = false;     // left to the model (choose_elasticity)
  double damping_local = 0;      // [-]
  double unbalanced = 1e-5;
  std::vector<std::string> excavate;  // names of groups and blocks taken out at the start
  // time since the start [s] and share of the tractions of excavated rock that is gone by then; not falling
  std::vector<Vec2> relaxation;
  bool reset_displacements = false;
  double path = 0;     // static: by how much its histories go on, from balance to balance [s]; 0: they stand
  int increments = 0;  // of the path
  Where where, where_step, where_clamp, where_excavate, where_relaxation, where_path;

  /// Makes it one of steps from rest, with what these ask for: a first step, no damping, tractions of excavated rock
  /// that go in shares.
  void go_from_rest();

  /// Makes it one of steps from rest that damped motion follows: a time step that is given is one of motion.
  void go_from_rest_first();

  /// Makes it one of damped motion, with the damping of a stage that says nothing of it.
  /// @pre  may_follow
  void go_by_motion();

  /// Share of the tractions of excavated rock that is gone `t` after the start; `before` without a
  /// relaxation.
  double relaxed_at(double t, double before) const;
};

/// What changes at the start of a stage: values of a joint or material, or material and kind of blocks.
/// NaN: stays as it was.
struct ChangeInput {
  int stage = -1, joint = -1, material = -1;
  std::string block;  // group or block; "": a joint or material changes
  enum Kind { kSame, kFixed, kFree } kind = kSame;
  double friction_angle = std::numeric_limits<double>::quiet_NaN();    // [rad]
  double cohesion = std::numeric_limits<double>::quiet_NaN();          // [Pa]
  double tensile_strength = std::numeric_limits<double>::quiet_NaN();  // [Pa]
  double density = std::numeric_limits<double>::quiet_NaN();           // [kg/m3]
  double young = std::numeric_limits<double>::quiet_NaN();             // [Pa]
  double poisson = std::numeric_limits<double>::quiet_NaN();           // [-]
  Where where;
};

/// Stress of the ground at the start; pressures > 0 push.
struct InSituInput {
  bool given = false;
  bool with_depth = false;                               // else the same everywhere
  double level = 0;                                      // [m] y at which depth begins
  double pressure = 0;                                   // vertical, there [Pa]
  double density = 0;                                    // of the ground between there and a point [kg/m3]
  double k0 = std::numeric_limits<double>::quiet_NaN();  // horizontal / vertical; NaN: the two below
  double horizontal_pressure = 0;                        // at the level [Pa]
  double horizontal_gradient = 0;                        // with depth [Pa/m]
  Mat2 stress;                                           // everywhere [Pa], tension > 0
  Where where, where_level;
};

enum class MonitorKind { kPoint, kBlock, kSupport, kContact, kBolt, kConvergence, kCentroid, kCrack };

struct MonitorInput {
  std::string name;
  MonitorKind kind = MonitorKind::kPoint;
  Vec2 point;
  std::string target_a, target_b;  // names of block or group, support, bolt, or the two contact partners
  double window = 0;               // [s]
  Vec2 other;                      // convergence, crack: the second point
  bool spectrum = false;           // of the acceleration of a point or centroid
  std::string relative_to;         // support, free-field boundary, block or group; "": none
  std::vector<Vec2> relative_to_points;  // the mean of these; empty: none
  Where where, where_relative;
};

struct OutputInput {
  double history_interval = 0, steps_interval = 0,
         field_interval = 0;  // [s] 0 = every step; fields: stage ends
  double save_interval = 60;  // [s] of wall time; 0: only at the ends of stages
  bool audit = true, pictures = true;
  double audit_interval = 0;  // [s] 0: at every frame
  Where where_history, where_field;
};

/// Search for the factor of safety by strength reduction (`talus safety`).
/// What `talus safety` changes until the model fails.
enum class SafetyBy { kStrength, kLoad, kTilt, kAcceleration };

struct SafetyInput {
  SafetyBy by = SafetyBy::kStrength;
  int load = -1;                     // that is raised
  double lowest = 0.5, highest = 4;  // factors between which it is sought
  double tolerance = 0.01;           // of the factor
  bool from_start = false;           // strength: each trial runs the stages, none goes on from rest
  int at = -1;  // static stage in whose end it is sought, -1: the last of the leading ones
  double displacement =
      std::numeric_limits<double>::quiet_NaN();  // [m] at which a trial has failed, NaN = automatic
  std::vector<int> joints;                       // reduced; empty: all
  bool accept_merged = false;                    // a model with slivers merged or deleted, too
  Where where;
};

/// How blocks, contacts and time become equations.
enum class Formulation { kContactForces, kPenalty, kAsPrinted };

/// Of formulation = "penalty" alone.
struct PenaltyInput {
  double normal_stiffness =
      std::numeric_limits<double>::quiet_NaN();  // per thickness [Pa], NaN: by Young's modulus
  double shear_share = 0.4;                      // shear stiffness over normal stiffness
  double support_stiffness =
      std::numeric_limits<double>::quiet_NaN();  // per thickness [Pa], NaN: the normal one
  bool exact_rotation = false;
  bool mean_acceleration = false;
  double dynamic_factor = 1;  // of dynamic stages
  int most_iterations = 25;
  double largest_displacement = 0.02;  // of a step, share of half the height of the model
};

/// A file that a model reads.
struct InputFile {
  std::string path, digest;  // text_hash() of its content
};

struct Model {
  // made and taken apart in one file: here every file of the program would hold that code
  Model();
  Model(const Model&);
  Model(Model&&) noexcept;
  Model& operator=(const Model&);
  Model& operator=(Model&&) noexcept;
  ~Model();

  std::string file, title, hash;
  std::string shapes_hash;       // of the content of mesh files alone, "" without any
  std::string folder;            // that relative paths of the file count from
  std::vector<InputFile> files;  // that it reads: histories, meshes, blocks
  std::string text;              // the file as read, byte for byte, with the overrides as closing comments
  // every block and grid has its polygon: the layout can be checked in spite of errors
  bool shapes_readable = true;
  double thickness = 1;
  Plane plane = Plane::kStrain;
  Inertia inertia = Inertia::kConsistent;
  Formulation formulation = Formulation::kContactForces;
  PenaltyInput penalty;
  Vec2 gravity;
  Where where_gravity;  // of [model] when it is not given

  std::vector<Material> materials;
  std::vector<JointProperty> joints;
  std::vector<History> histories;
  std::vector<BlockInput> blocks;
  std::vector<GridInput> grids;
  std::vector<MeshInput> meshes;
  CutInput cut;
  std::vector<RegionInput> regions;
  std::vector<ArchInput> arches;
  std::vector<OpeningInput> openings;
  std::vector<FaultInput> faults;
  std::vector<TracesInput> traces;
  std::vector<MasonryInput> masonry;
  std::vector<TessellationInput> tessellations;
  std::vector<JointSetInput> joint_sets;
  int bonded_joint = -1;   // index of the joint that glues artificial edges (openings kept, sub-division)
  int default_joint = -1;  // -1: hard and frictionless
  std::vector<ContactPairInput> contact_pairs;
  std::vector<SupportInput> supports;
  std::vector<BoundaryInput> boundaries;
  std::vector<LoadInput> loads;
  std::vector<BoltType> bolt_types;
  std::vector<BoltInput> bolts;  // patterns as their bolts
  ContactInput contact;
  SolverInput solver;
  std::vector<StageInput> stages;
  std::vector<ChangeInput> changes;
  InSituInput in_situ;
  std::vector<MonitorInput> monitors;
  OutputInput output;
  SafetyInput safety;

  /// Where the clock of the histories stands when a stage begins: what dynamic stages last and paths are long before it [s].
  double history_time_at(int stage) const;
};

}  // namespace talus
