#include "measures.h"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include "talus/base/index.h"
#include "talus/geometry/polygon.h"

namespace talus::bench {
namespace {

// Largest distance, over the edges of a, by which all of b lies outside that edge; negative when none does.
double separation_along_edges(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  double best = -std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < a.size(); ++i) {
    const Vec2 from = a[i], along = a[(i + 1) % a.size()] - from;
    const Vec2 outward = turn_right(along) / norm(along);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec2 p : b) nearest = std::min(nearest, dot(outward, p - from));
    best = std::max(best, nearest);
  }
  return best;
}

bool near(const Box& a, const Box& b, double distance) {
  return a.min.x <= b.max.x + distance && b.min.x <= a.max.x + distance &&  //
         a.min.y <= b.max.y + distance && b.min.y <= a.max.y + distance;
}

}  // namespace

std::vector<std::pair<int, int>> near_pairs(const std::vector<BenchBlock>& blocks, double distance) {
  std::vector<Box> boxes;
  std::vector<int> moving, fixed;
  for (int i = 0; i < count_of(blocks); ++i) {
    (blocks[i].fixed ? fixed : moving).push_back(i);
    if (!blocks[i].fixed) boxes.push_back(bounding_box(blocks[i].corners));
  }
  std::vector<std::pair<int, int>> pairs = close_pairs(boxes, distance);
  for (auto& [i, j] : pairs) i = moving[i], j = moving[j];
  // fixed blocks are few and large: they would spoil the grid that finds the other pairs
  for (const int i : fixed) {
    const Box box = bounding_box(blocks[i].corners);
    for (size_t k = 0; k < moving.size(); ++k)
      if (near(box, boxes[k], distance)) pairs.push_back({i, moving[k]});
  }
  return pairs;
}

Overlap measure_overlap(const std::vector<BenchBlock>& blocks, double touching) {
  constexpr double kOverlapping = 1e-9;  // [m] below this a depth is round-off of the poses
  Overlap result;
  double sum = 0;
  const auto compare = [&](size_t i, size_t j) {
    const std::vector<Vec2>&a = blocks[i].corners, &b = blocks[j].corners;
    const double apart = std::max(separation_along_edges(a, b), separation_along_edges(b, a));
    if (apart > touching) return;
    ++result.touching;
    const double depth = std::max(0.0, -apart);
    result.max = std::max(result.max, depth);
    result.relative_max =
        std::max(result.relative_max, depth / std::sqrt(std::min(signed_area(a), signed_area(b))));
    if (depth <= kOverlapping) return;
    ++result.overlapping;
    sum += depth;
  };
  for (const auto& [i, j] : near_pairs(blocks, touching)) compare(i, j);
  if (result.overlapping > 0) result.mean = sum / result.overlapping;
  return result;
}

double LawError::worst() const { return std::max({slip_max, un_max, coulomb_max}); }

LawError measure_law(const BenchScene& scene, const std::vector<BenchContact>& contacts, double h,
                     Vec2 gravity) {
  constexpr double kSticking = 0.999;  // friction above this share of its bound may slip
  constexpr double kLoaded = 1e-3;     // of the mean impulse
  constexpr double kJudged =
      1e-3;  // time over which gravity makes the velocity that others are measured by [s]
  LawError error;
  const double speed = kGravity * kJudged, mu = scene.friction;
  double mean_impulse = 0;
  for (const BenchContact& c : contacts)
    mean_impulse += c.normal_impulse / static_cast<double>(contacts.size());

  std::vector<Vec2> impulse(scene.blocks.size());
  int loaded = 0, sticking = 0;
  for (const BenchContact& c : contacts) {
    const Vec2 tangent = turn_left(c.normal);
    const Vec2 on_b = c.normal_impulse * c.normal + c.tangent_impulse * tangent;
    impulse[c.b] += on_b;
    impulse[c.a] -= on_b;
    const double bound = mu * c.normal_impulse, friction = std::abs(c.tangent_impulse);
    if (mean_impulse > 0) error.coulomb_max = std::max(error.coulomb_max, (friction - bound) / mean_impulse);
    if (!(c.normal_impulse > kLoaded * mean_impulse)) continue;
    const double un = std::abs(dot(c.relative_velocity, c.normal)) / speed;
    ++loaded;
    error.un_mean += un;
    error.un_max = std::max(error.un_max, un);
    if (!(friction < kSticking * bound)) continue;
    const double slip = std::abs(dot(c.relative_velocity, tangent)) / speed;
    ++sticking;
    error.slip_mean += slip;
    error.slip_max = std::max(error.slip_max, slip);
  }
  if (loaded > 0) error.un_mean /= loaded;
  if (sticking > 0) error.slip_mean /= sticking;

  int moving = 0;
  for (size_t i = 0; i < scene.blocks.size(); ++i) {
    if (scene.blocks[i].fixed) continue;
    const double mass = scene.density * signed_area(scene.blocks[i].corners);
    const double missing = norm(impulse[i] + mass * h * gravity) / (mass * kGravity * h);
    ++moving;
    error.balance_mean += missing;
    error.balance_max = std::max(error.balance_max, missing);
  }
  if (moving > 0) error.balance_mean /= moving;
  return error;
}

Displacement measure_displacement(const std::vector<BenchBlock>& before,
                                  const std::vector<BenchBlock>& after) {
  Displacement result;
  for (size_t i = 0; i < before.size(); ++i) {
    if (before[i].fixed) continue;
    const Vec2 moved =
        polygon_moments(after[i].corners).centroid - polygon_moments(before[i].corners).centroid;
    result.drift_max = std::max(result.drift_max, std::abs(moved.x));
    result.sink_max = std::max(result.sink_max, -moved.y);
  }
  return result;
}

Spread spread(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return {0.5 * (values[(n - 1) / 2] + values[n / 2]), values.front(), values.back()};
}

namespace {

double clock_seconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

double wall_seconds() { return clock_seconds(CLOCK_MONOTONIC); }
double cpu_seconds() { return clock_seconds(CLOCK_PROCESS_CPUTIME_ID); }

double resident_bytes() {
  std::ifstream file("/proc/self/statm");
  double total = 0, resident = 0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double resident_peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

double load_average() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const size_t value = line.find(": ");
    if (line.rfind("model name", 0) == 0 && value != std::string::npos) return line.substr(value + 2);
  }
  return "unknown";
}

std::string csv_header() {
  return "engine,scene,phase,blocks,threads,dt,sweeps,ms_step_median,ms_step_min,ms_step_max,steps,"
         "contact_points,ns_block_step,ns_point_step,overlap_max,overlap_mean,overlap_rel_max,slip_mean,slip_"
         "max,"
         "un_mean,un_max,balance_mean,balance_max,coulomb_max,drift_max,sink_max,error_worst,rss_bytes,"
         "bytes_per_block,cpu_s_per_simulated_s,samples,slip_median,slip_worst,un_median,un_worst,overlap_"
         "worst";
}

std::string csv_line(const BenchRow& row) {
  std::string line = fmt::format("{},{},{},{},{},{:.6g},{}", row.engine, row.scene, row.phase, row.blocks,
                                 row.threads, row.dt, row.sweeps);
  const auto add = [&line](double value) { line += std::isnan(value) ? "," : fmt::format(",{:.6g}", value); };
  add(row.ms_step.median), add(row.ms_step.min), add(row.ms_step.max), add(row.steps);
  add(row.contact_points);
  add(1e6 * row.ms_step.median / std::max(1, row.blocks));
  add(1e6 * row.ms_step.median / std::max(1.0, row.contact_points));
  add(row.overlap.max), add(row.overlap.mean), add(row.overlap.relative_max);
  add(row.law.slip_mean), add(row.law.slip_max), add(row.law.un_mean), add(row.law.un_max);
  add(row.law.balance_mean), add(row.law.balance_max), add(row.law.coulomb_max);
  add(row.displacement.drift_max), add(row.displacement.sink_max), add(row.error_worst);
  add(row.rss_bytes), add(row.bytes_per_block), add(row.cpu_per_simulated);
  add(row.along.samples), add(row.along.slip_median), add(row.along.slip_worst);
  add(row.along.un_median), add(row.along.un_worst), add(row.along.overlap_worst);
  return line;
}

namespace {

double number_of(const std::string& option, const char* text) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (end == text || *end != '\0')
    throw std::invalid_argument(fmt::format("{} needs a number, not '{}'", option, text));
  return value;
}

}  // namespace

BenchOptions read_options(int argc, char** argv) {
  if (argc < 2 || argc % 2 != 0)
    throw std::invalid_argument(
        "usage: SCENE [--dt s] [--settle s] [--shake s] [--shake_g a] [--sweeps n] [--threads n] [--slop m] "
        "[--tolerance e]");
  BenchOptions options;
  options.scene = argv[1];
  for (int i = 2; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    const double value = number_of(option, argv[i + 1]);
    if (option == "--dt") {
      options.dt = value;
    } else if (option == "--settle") {
      options.settle = value;
    } else if (option == "--shake") {
      options.shake = value;
    } else if (option == "--shake_g") {
      options.shake_g = value;
    } else if (option == "--sweeps") {
      options.sweeps = static_cast<int>(value);
    } else if (option == "--threads") {
      options.threads = static_cast<int>(value);
    } else if (option == "--slop") {
      options.slop = value;
    } else if (option == "--tolerance") {
      options.tolerance = value;
    } else {
      throw std::invalid_argument(fmt::format("unknown option '{}'", option));
    }
  }
  return options;
}

namespace {

// Steps of one phase, timed one by one; counting contacts stays outside the time.
class PhaseClock {
 public:
  void step(BenchEngine& engine, double dt, bool timed) {
    // asking for the processor time is a system call: it stays outside the wall time
    const double cpu_0 = cpu_seconds(), wall_0 = wall_seconds();
    engine.step(dt);
    const double wall_1 = wall_seconds(), cpu_1 = cpu_seconds();
    if (!timed) return;
    milliseconds_.push_back(1e3 * (wall_1 - wall_0));
    cpu_ += cpu_1 - cpu_0;
    if (milliseconds_.size() % kStepsPerCount == 1) {
      points_ += engine.contact_points();
      ++counts_;
    }
  }

  void fill(double dt, BenchRow& row) const {
    row.ms_step = spread(milliseconds_);
    row.steps = count_of(milliseconds_);
    row.contact_points = counts_ > 0 ? points_ / counts_ : 0;
    row.cpu_per_simulated = cpu_ / (dt * std::max(1, row.steps));
  }

 private:
  static constexpr size_t kStepsPerCount = 20;
  std::vector<double> milliseconds_;
  double cpu_ = 0, points_ = 0;
  int counts_ = 0;
};

// The law error at instants evenly spaced over a phase.
class Along {
 public:
  void look(const BenchEngine& engine, const BenchScene& scene, double dt, Vec2 gravity) {
    const LawError law = measure_law(scene, engine.contacts(), engine.impulse_time(dt), gravity);
    slip_.push_back(law.slip_mean), un_.push_back(law.un_mean);
    overlap_ = std::max(overlap_, measure_overlap(engine.blocks()).max);
  }
  LawAlong result() const {
    const Spread slip = spread(slip_), un = spread(un_);
    return {count_of(slip_), slip.median, slip.max, un.median, un.max, overlap_};
  }

 private:
  std::vector<double> slip_, un_;
  double overlap_ = 0;
};

void fill_accuracy(const BenchEngine& engine, const BenchScene& scene, double dt, Vec2 gravity,
                   BenchRow& row) {
  const std::vector<BenchBlock> now = engine.blocks();
  row.overlap = measure_overlap(now);
  row.law = measure_law(scene, engine.contacts(), engine.impulse_time(dt), gravity);
  row.displacement = measure_displacement(scene.blocks, now);
  row.error_worst = row.law.worst();
}

}  // namespace

void run_scene(BenchEngine& engine, const BenchScene& scene, const BenchOptions& options,
               double resident_before) {
  constexpr double kFrequency = 2;  // [Hz]
  constexpr int kSamples = 32;
  fmt::print(stderr, "{}, {}: {} blocks on {}, load average {:.2f}\n", engine.name(), options.scene,
             scene.moving(), cpu_model(), load_average());
  fmt::print("{}\n", csv_header());
  const bool shaken = scene.name == "wall";
  const double dt = options.dt;
  const auto run_phase = [&](const std::string& phase, double duration) {
    const int steps = static_cast<int>(std::lround(duration / dt));
    if (steps == 0) return;
    PhaseClock clock;
    Along along;
    Vec2 gravity{0, -kGravity};
    const int first = phase == "settle" ? steps / 2 : 0, judged = steps - first;
    for (int i = 0; i < steps; ++i) {
      if (phase == "shake") {
        const double time = (i + 0.5) * dt;
        gravity.x = -options.shake_g * kGravity * std::sin(2 * std::numbers::pi * kFrequency * time);
      }
      engine.set_gravity(gravity);
      clock.step(engine, dt, i >= first);
      // the last step of each of so many equal parts
      const auto part = [&](int step) { return static_cast<int64_t>(step) * kSamples / judged; };
      if (i >= first && part(i - first) != part(i + 1 - first)) along.look(engine, scene, dt, gravity);
    }
    BenchRow row;
    row.engine = engine.name(), row.scene = options.scene, row.phase = phase;
    row.blocks = scene.moving(), row.threads = options.threads;
    row.dt = dt, row.sweeps = engine.sweeps();
    // memory first: the measures below need some themselves. What has been freed is no engine's memory
    malloc_trim(0);
    row.rss_bytes = resident_bytes();
    row.bytes_per_block = (row.rss_bytes - resident_before) / std::max(1, row.blocks);
    clock.fill(dt, row);
    row.along = along.result();
    fill_accuracy(engine, scene, dt, gravity, row);
    fmt::print("{}\n", csv_line(row));
    std::fflush(stdout);
  };
  run_phase("settle", options.settle);
  run_phase(shaken ? "shake" : "hold", options.shake);
  fmt::print(stderr, "{}, {}: at most {:.0f} MiB\n", engine.name(), options.scene,
             resident_peak_bytes() / 0x1p20);
}

}  // namespace talus::bench
