#pragma once
// What is measured on every engine alike, from nothing but polygons, impulses and velocities: overlap, how
// far the contact law is missed, drift; beside them time and memory, and the CSV line in which all of it is
// kept. run_scene() drives any engine through settling and shaking and prints one line per phase.

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "scenes.h"

namespace talus::bench {

inline constexpr double kGravity = 9.81;  // [m/s^2]

/// Pairs of blocks whose boxes are nearer than `distance` [m] along both axes, each pair once: first those of
/// two moving blocks, then those of a fixed block (first of its pair) and a moving one. Two fixed blocks
/// never pair.
/// @note  linear in the number of moving blocks, times the number of fixed ones
std::vector<std::pair<int, int>> near_pairs(const std::vector<BenchBlock>& blocks, double distance);

// --- accuracy ---------------------------------------------------------------------------------------------

struct Overlap {
  double max = 0, mean = 0;  // [m] depth; the mean is over the overlapping pairs
  double relative_max = 0;   // depth / sqrt(area of the smaller block)
  int touching = 0;          // pairs nearer than the touching distance
  int overlapping = 0;       // pairs deeper than a nanometre
};

/// Depth to which blocks reach into each other, by separating axes: the shortest way that would part a pair.
/// @param blocks   current polygons, convex and counter-clockwise
/// @param touching [m] pairs nearer than this count as touching
Overlap measure_overlap(const std::vector<BenchBlock>& blocks, double touching = 1e-3);

/// One contact point of an engine after a step. The impulses act on block b, the opposite ones on a.
struct BenchContact {
  int a = 0, b = 0;            // indices into BenchScene::blocks
  Vec2 point, normal;          // [m] world; unit vector from a to b
  double normal_impulse = 0;   // [N s] per metre, >= 0 pushes
  double tangent_impulse = 0;  // [N s] per metre, along turn_left(normal)
  Vec2 relative_velocity;      // [m/s] of b against a at the point
};

/// How far the impulses and velocities of one step miss the contact law. Velocities are divided by g times a
/// millisecond, whatever the step, and judged at points that carry more than a thousandth of the mean impulse;
/// those below are about to open.
struct LawError {
  double slip_mean = 0, slip_max = 0;        // |u_t| where |r_t| < 0.999 mu r_n: should stick
  double un_mean = 0, un_max = 0;            // |u_n|: a loaded point should stay closed
  double balance_mean = 0, balance_max = 0;  // |contact impulses + m g h| / (m g h) of a block: 0 at rest
  double coulomb_max = 0;                    // (|r_t| - mu r_n) / mean r_n: friction above its bound
  double worst() const;                      // largest of slip, un and coulomb
};

/// @param scene    friction, density and the blocks as built (their masses)
/// @param contacts all contact points of the engine, loaded or not
/// @param h        [s] time that the impulses stand for: the step, or the substep of an engine that has them
/// @param gravity  [m/s^2] body force per mass during that time, shaking included
LawError measure_law(const BenchScene& scene, const std::vector<BenchContact>& contacts, double h,
                     Vec2 gravity);

/// The law error all along a phase: of its means over the points at so many instants, the middle one and the
/// worst.
struct LawAlong {
  int samples = 0;
  double slip_median = 0, slip_worst = 0, un_median = 0, un_worst = 0;
  double overlap_worst = 0;  // [m]
};

struct Displacement {
  double drift_max = 0;  // [m] largest sideways displacement of a moving block's centroid
  double sink_max = 0;   // [m] largest downward one
};

Displacement measure_displacement(const std::vector<BenchBlock>& before,
                                  const std::vector<BenchBlock>& after);

// --- time, memory, machine --------------------------------------------------------------------------------

struct Spread {
  double median = 0, min = 0, max = 0;
};

/// All zero when `values` is empty; the mean of the middle two when their number is even.
Spread spread(std::vector<double> values);

double wall_seconds();         // since some fixed moment
double cpu_seconds();          // of all threads of this process
double resident_bytes();       // memory held now
double resident_peak_bytes();  // most memory ever held
double load_average();         // over the last minute
std::string cpu_model();       // as the system names it, "unknown" where it does not

// --- results ----------------------------------------------------------------------------------------------

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// One line of results, in the order of the columns. What an engine cannot tell stays empty in the file.
struct BenchRow {
  std::string engine, scene, phase;  // phase: "settle", "shake", "hold" or "one_step"
  int blocks = 0, threads = 1;       // moving blocks
  double dt = 0;                     // [s]
  int sweeps = 0;                    // over all contact points in a step
  Spread ms_step;                    // [ms] wall time of a step
  int steps = 0;                     // timed
  double contact_points = 0;         // mean number
  Overlap overlap{kNotMeasured, kNotMeasured, kNotMeasured, 0, 0};
  LawError law{kNotMeasured, kNotMeasured, kNotMeasured, kNotMeasured,
               kNotMeasured, kNotMeasured, kNotMeasured};
  LawAlong along{0, kNotMeasured, kNotMeasured, kNotMeasured, kNotMeasured, kNotMeasured};
  Displacement displacement{kNotMeasured, kNotMeasured};
  double error_worst = kNotMeasured;  // LawError::worst() at the end; natural-map error of a one-step problem
  double rss_bytes = kNotMeasured;
  double bytes_per_block = kNotMeasured;
  double cpu_per_simulated = kNotMeasured;  // [s/s] of all threads
};

/// The names of the columns, the same for all engines; no newline.
std::string csv_header();
std::string csv_line(const BenchRow& row);

// --- running a scene --------------------------------------------------------------------------------------

/// What the command lines of all engines share: SCENE and pairs of an option and its value.
struct BenchOptions {
  std::string scene;
  double dt = 1e-3;              // [s] --dt
  double settle = 1, shake = 2;  // [s] --settle, --shake (the hold of scenes that are not shaken)
  double shake_g = 0.3;          // [g] --shake_g; amplitude of the shaking of walls
  int sweeps = 0;                // --sweeps; 0 leaves the engine's own number
  int threads = 1;               // --threads
  double slop = kNotMeasured;    // [m] --slop; overlap an engine tolerates, its own if not given
  double tolerance = 1e-4;       // --tolerance of a one-step problem
};

/// @throws std::invalid_argument naming the option, when one is unknown or its value is not a number
BenchOptions read_options(int argc, char** argv);

/// A program that moves the blocks of a scene; each engine compared implements this.
class BenchEngine {
 public:
  virtual ~BenchEngine() = default;
  virtual std::string name() const = 0;
  virtual int sweeps() const = 0;
  virtual void set_gravity(Vec2 gravity) = 0;  // [m/s^2] for the steps that follow
  virtual void step(double dt) = 0;
  /// Time that its impulses stand for after a step [s]: an engine with substeps gives those of the last one.
  virtual double impulse_time(double dt) const { return dt; }
  virtual int contact_points() const = 0;
  virtual std::vector<BenchBlock> blocks() const = 0;      // current polygons, in the order of the scene
  virtual std::vector<BenchContact> contacts() const = 0;  // of the last step
};

/// Lets the scene settle, then shakes it (walls: at 2 Hz, as a body force) or holds it under gravity, and
/// prints the header and one line per phase: time, and accuracy at the end and at 32 instants along the
/// phase. The first half of settling is neither timed nor judged: contacts begin there.
/// @param resident_before [bytes] memory held before the engine was built
void run_scene(BenchEngine& engine, const BenchScene& scene, const BenchOptions& options,
               double resident_before);

}  // namespace talus::bench
