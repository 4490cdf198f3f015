#pragma once
// Columns of histories.csv: monitors of points, stresses, reactions and contact forces, row by row.

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "talus/output/archive.h"
#include "talus/output/columns.h"
#include "talus/results/answers.h"
#include "talus/results/reference.h"

namespace talus {

class Histories {
 public:
  using Sink = std::function<void(const std::vector<double>&)>;

  /// @param sink  gets every finished row; rows with window means come half a window late
  Histories(const Scene& scene, Sink sink);
  ~Histories();

  /// "t [s]", "dynamic_time [s]" (the clock of the histories), then the monitors in the order of the model.
  const std::vector<ColumnTitle>& columns() const { return columns_; }

  /// To be called at every instant: impulses add up whether a row is kept or not.
  /// @param keep  whether this instant becomes a row
  void at(const Instant& instant, bool keep);

  /// Rows at even times.
  struct Even {
    double begin = 0, rows = 0;  // of the present stage [s], so far
  };
  /// The same with a row at the beginning of each stage and every `interval` after it, linear between the two instants
  /// about it, and one at the last instant; of a stage along a path one at
  /// each of its balances, and no others.
  void at_even(const Instant& instant, double interval, Even& even);

  struct Peak {
    std::string name;     // of the monitor
    double velocity = 0;  // largest in dynamic stages, relative where the monitor is [m/s]
  };
  std::vector<Peak> peaks() const;

  /// When the two partners of a contact monitor pressed each other first and last.
  struct Touch {
    std::string name;              // of the monitor
    double first = -1, last = -1;  // [s]; -1: never
  };
  std::vector<Touch> touches() const;

  /// Of every column but window means.
  const Answers& answers() const { return *answers_; }

  /// Response spectra (damping 5 %) of the monitors that ask for them, of their acceleration in dynamic stages:
  /// "period [s]", then columns. Empty without such a monitor or before a dynamic stage.
  struct Spectra {
    std::vector<std::string> columns;
    std::vector<std::vector<double>> values;  // [column][period]

    std::string csv() const;
  };
  Spectra spectra() const;

  /// Sums, impulses and rows that wait. Throws FileError when they are not those of these monitors.
  void save(Saver& to) const;
  void load(Loader& from);

  /// Writes the rows still waiting; their windows end with the run.
  void finish();

 private:
  // Impulse of a contact monitor over time: x, y on the first partner, and the sum of normal impulses.
  struct Impulses {
    std::vector<char> in_a, in_b;  // [n_blocks] whether the block belongs to a partner
    double window = 0;
    double first_touch = -1, last_touch = -1;  // [s]
    double sum[3] = {0, 0, 0};
    struct Knot {
      double time;
      double value[3];
    };
    std::deque<Knot> knots;  // at half steps, the impulse so far; kept while a waiting row may need them
    size_t first_mean = 0;   // column
  };
  struct Waiting {
    std::vector<double> row;
    double ready_at;
  };

  // names and units
  using Quantities = std::vector<std::pair<const char*, const char*>>;
  void add_columns(const std::string& monitor, const Quantities& quantities);
  std::vector<double> sample(const Instant& instant);
  void keep_row(std::vector<double> row);
  void set_up_contact(const MonitorInput& m);
  static Vec2 acceleration_of(const Instant& instant, int block, Vec2 arm);
  double rotation_of(const State& state, int block) const;
  void sample_centroid(const Instant& instant, size_t index, std::vector<double>& row);
  void sample_point(const Instant& instant, size_t index, std::vector<double>& row);
  void sample_contact(const Instant& instant, Impulses& impulses, std::vector<double>& row) const;
  void sample_bolt(const Instant& instant, const std::string& name, std::vector<double>& row) const;
  void release(double known_until, bool all);

  const Scene& scene_;
  Sink sink_;
  std::vector<ColumnTitle> columns_;
  // accelerations of a monitor in dynamic stages, step by step
  struct Spectrum {
    std::string name;
    std::vector<double> time, x, y;  // of the histories [s], [m/s2]

    void add(double history_time, Vec2 acceleration);
  };
  struct Point {
    int block;
    Vec2 arm;
    Reference reference;
    double peak = 0;  // largest velocity in dynamic stages [m/s]
    Spectrum* spectrum = nullptr;
  };
  // a group of blocks, weighted by their mass
  struct Centroid {
    std::vector<int> blocks;
    std::vector<double> weight;
    Reference reference;
    double peak = 0;
    Spectrum* spectrum = nullptr;
  };
  // two points on either side of a crack
  struct Crack {
    int block_a, block_b;
    Vec2 arm_a, arm_b;
    Vec2 along;  // from the first to the second at the start, unit
  };
  // change of the distance of two points, written so that small changes keep their digits
  struct Pair {
    int block_a, block_b;
    Vec2 arm_a, arm_b;
    Vec2 apart;  // at the start, from a to b [m]
  };
  static double nearer(const Pair& pair, const State& state);
  template <class X, class Self>
  static void exchange(X& x, Self& self);

  std::deque<Spectrum> spectra_;  // in the order of their monitors
  std::unique_ptr<Answers> answers_;
  std::vector<Centroid> centroids_;  // one per centroid monitor
  std::vector<Crack> cracks_;        // one per crack monitor
  std::vector<Point> points_;        // one per point monitor
  std::vector<Pair> pairs_;          // one per convergence monitor
  std::vector<int> blocks_;          // one per block monitor
  std::vector<int> supports_;        // one per support monitor
  std::vector<Impulses> contacts_;   // one per contact monitor
  std::vector<double> before_;       // all columns at the instant before, where rows are even
  double widest_ = 0;                // largest window [s]
  double known_until_ = 0;
  std::deque<Waiting> waiting_;
};

}  // namespace talus
