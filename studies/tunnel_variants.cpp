// Runs of examples/xianglushan side by side: what the four points of the tunnel do, how the tunnel closes,
// which joints slip, what bolts carry, and whether the ground moves as a column does. Prints tables
// (Markdown). examples/xianglushan/README.md has them.
//
// Usage: tunnel_variants MOTION.csv NAME=FOLDER ...
//   MOTION.csv  the outcrop velocity that all runs were shaken with (talus record)
//   FOLDER      results of talus run

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "talus/base/text_file.h"
#include "talus/output/csv.h"
#include "talus/talus.h"

namespace {

namespace fs = std::filesystem;
using Series = std::vector<double>;

const std::array<std::string, 4> kPoints{"crown", "right", "invert", "left"};

// The ground of the example.
constexpr double kTop = 300, kAxis = 200;  // above the base [m]
constexpr double kQuiet = 25;              // nothing comes in any more; what is left must not grow [s]

struct Extent {
  double least = 0, most = 0;
  void take(double v) { least = std::min(least, v), most = std::max(most, v); }
  double largest() const { return std::max(-least, most); }
};

// A run from the beginning of its shaking.
struct Run {
  std::string name;
  fs::path folder;
  nlohmann::json summary;
  talus::CsvTable table;
  size_t first = 0;  // row at which the shaking begins
  double begin = 0;  // [s]

  double time(size_t i) const { return table.values[0][first + i] - begin; }
  Series series(const std::string& column) const {
    const Series& all = table.column(column);
    return {all.begin() + static_cast<std::ptrdiff_t>(first), all.end()};
  }
  bool has(const std::string& key) const {
    for (const auto& given : summary["overrides"])
      if (given.get<std::string>() == key) return true;
    return false;
  }
  const nlohmann::json& shaking() const { return summary["stages"].back(); }
};

Run read_run(const std::string& argument) {
  const size_t equals = argument.find('=');
  if (equals == std::string::npos) throw std::runtime_error("\"" + argument + "\" is no NAME=FOLDER");
  Run run{argument.substr(0, equals), argument.substr(equals + 1), {}, {}};
  run.summary = nlohmann::json::parse(talus::read_text_file((run.folder / "summary.json").string()));
  run.table = talus::read_csv(run.folder / "histories.csv");
  run.begin = run.shaking()["begin [s]"].get<double>();
  const Series& t = run.table.values[0];
  // the row at the very beginning still counts displacements from before the reset
  while (run.first < t.size() && t[run.first] <= run.begin) ++run.first;
  if (run.first == t.size()) throw std::runtime_error(argument + ": the shaking has no rows");
  return run;
}

Extent extent(const Series& s) {
  Extent e;
  for (const double v : s) e.take(v);
  return e;
}

// Least-squares line of what comes after kQuiet: its slope [per s] and its value at the end.
struct Line {
  double slope = 0, end = 0;
};
Line quiet_line(const Run& run, const Series& s) {
  double n = 0, t = 0, v = 0, tt = 0, tv = 0, last = 0;
  for (size_t i = 0; i < s.size(); ++i) {
    const double x = run.time(i) - kQuiet;
    if (x < 0) continue;
    n += 1, t += x, v += s[i], tt += x * x, tv += x * s[i], last = x;
  }
  if (n < 3) return {std::nan(""), s.back()};
  const double slope = (n * tv - t * v) / (n * tt - t * t);
  return {slope, (v - slope * t) / n + slope * last};
}

// Motion of level ground, softer than its rock by its joints (ks every 3 m, two sets), on rock without joints
// (the dashpots of the base): half the outcrop's motion goes up, comes down again from the free top, and is
// thrown back in part by the stiffer rock. Displacement at a height above the base [m].
struct Ground {
  talus::History outcrop;          // velocity
  double speed = 0, softness = 0;  // of the jointed ground; its share of that of the rock

  explicit Ground(const fs::path& motion) {
    const talus::CsvTable table = talus::read_csv(motion);
    outcrop.time = table.values[0], outcrop.value = table.column("velocity");
    const Series &t = outcrop.time, &v = outcrop.value;
    outcrop.integral.assign(t.size(), 0);
    for (size_t i = 1; i < t.size(); ++i)
      outcrop.integral[i] = outcrop.integral[i - 1] + 0.5 * (v[i] + v[i - 1]) * (t[i] - t[i - 1]);
    const double shear = 5e9 / (2 * 1.29);
    softness = 1 / std::sqrt(1 + 2 * shear / (20e9 * 3));
    speed = softness * std::sqrt(shear / 2850);
  }
  double moved(double t) const { return t > 0 ? outcrop.integral_at(t) : 0; }
  /// @param top  of a wave that comes up, the share that the top throws back: 1 free
  double at(double height, double t, double top) const {
    const double in = 1 / (1 + softness), back = (softness - 1) / (softness + 1);
    double sum = 0, share = in;
    for (int n = 0; n < 4; ++n, share *= back * top)
      sum += share * (moved(t - (2 * n * kTop + height) / speed) +
                      top * moved(t - (2 * (n + 1) * kTop - height) / speed));
    return sum;
  }
};

// The cells of a line of a table that holds texts too.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cell(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cell.emplace_back();
    else
      cell.back() += c;
  }
  return cell;
}

// Largest bolt force at the ends of the stages before the shaking and of the shaking [N].
struct BoltForces {
  double before = 0, after = 0;
  int ruptured = 0;
};
BoltForces bolt_forces(const Run& run) {
  BoltForces out;
  std::ifstream file(run.folder / "bolts.csv");
  std::string line;
  std::getline(file, line);  // titles
  while (std::getline(file, line)) {
    const std::vector<std::string> cell = cells_of(line);
    double& largest = cell.at(0) == run.shaking()["name"].get<std::string>() ? out.after : out.before;
    largest = std::max(largest, std::stod(cell.at(7)));
    out.ruptured += cell.back() == "ruptured" && &largest == &out.after;
  }
  return out;
}

// The largest residual slip at the end of a stage, and where [m]; joints that have slipped by more than
// kVisible.
constexpr double kVisible = 1e-4;  // [m]
struct Slip {
  double size = 0, x = 0, y = 0;
  std::string set;
  int visible = 0;
};
Slip largest_slip(const Run& run, const std::string& stage) {
  std::ifstream file(run.folder / "slips.csv");
  std::string line;
  Slip slip;
  while (std::getline(file, line)) {  // by falling slip
    const std::vector<std::string> cell = cells_of(line);
    if (cell.at(0) != stage) continue;
    const double size = std::stod(cell.at(8));
    if (slip.size == 0) slip = {size, std::stod(cell.at(6)), std::stod(cell.at(7)), cell.at(4), 0};
    slip.visible += size > kVisible;
  }
  return slip;
}

std::string millimetres(double metres) { return fmt::format("{:.1f}", 1e3 * metres); }

void print_motion(const std::vector<Run>& runs) {
  fmt::print(
      "| run | largest relative to the base: crown, right, invert, left [m] | least, most of all [m] | left "
      "at the end: crown, right, invert, left [mm] | largest relative to their mean [mm] | left at the end "
      "[mm] |\n"
      "|---|---|---|---|---|---|\n");
  for (const Run& run : runs) {
    std::string peaks, left, own, own_left;
    Extent all;
    for (const std::string& p : kPoints) {
      const Series base = run.series(p + "_to_base.displacement_x"),
                   mean_x = run.series(p + "_to_mean.displacement_x"),
                   mean_y = run.series(p + "_to_mean.displacement_y");
      const Extent e = extent(base);
      all.take(e.least), all.take(e.most);
      double most = 0;
      for (size_t i = 0; i < mean_x.size(); ++i) most = std::max(most, std::hypot(mean_x[i], mean_y[i]));
      const char* comma = p == kPoints.front() ? "" : ", ";
      peaks += fmt::format("{}{:.4f}", comma, e.largest());
      left += comma + millimetres(quiet_line(run, base).end);
      own += comma + millimetres(most);
      own_left += comma + millimetres(std::hypot(quiet_line(run, mean_x).end, quiet_line(run, mean_y).end));
    }
    fmt::print("| {} | {} | {:.4f}, {:.4f} | {} | {} | {} |\n", run.name, peaks, all.least, all.most, left,
               own, own_left);
  }
}

void print_damage(const std::vector<Run>& runs) {
  fmt::print(
      "\n| run | height lost: by digging; by shaking most, left [mm] | width | largest slip [mm] before, "
      "after the shaking, set, at | joints that slipped; by over 0.1 mm | faces broken | bolts: tension "
      "before, after the shaking [kN] (ruptured) |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const Run& run : runs) {
    const auto closure = [&](const std::string& monitor) {
      const Series s = run.series(monitor + ".convergence");
      const Extent e = extent(s);
      const double dug = run.table.column(monitor + ".convergence").at(run.first - 1);
      return fmt::format("{:.1f}; {:.2f}, {:.2f}", 1e3 * dug, 1e3 * (e.most > -e.least ? e.most : e.least),
                         1e3 * quiet_line(run, s).end);
    };
    const auto& joints = run.summary["joints"];
    const auto& stages = run.summary["stages"];
    const Slip before = largest_slip(run, stages[stages.size() - 2]["name"].get<std::string>()),
               after = largest_slip(run, run.shaking()["name"].get<std::string>());
    const BoltForces bolts = bolt_forces(run);
    fmt::print("| {} | {} | {} | {}, {}, {}, ({:.1f}, {:.1f}) | {}; {} | {} | {} |\n", run.name,
               closure("height"), closure("width"), millimetres(before.size), millimetres(after.size),
               after.set, after.x, after.y, joints["slipped_joints"].get<int>(), after.visible,
               run.summary["contacts"]["bond_faces_broken"].get<int>(),
               bolts.before == 0 ? "-"
                                 : fmt::format("{:.1f}, {:.1f} ({})", 1e-3 * bolts.before, 1e-3 * bolts.after,
                                               bolts.ruptured));
  }
}

void print_health(const std::vector<Run>& runs, const Ground& ground) {
  fmt::print(
      "\n| run | step [ms] | blocks clamped (most) | steps | sweeps a step | wall [min] | contact error [m] "
      "| energy left over | fastest change after {:g} s: absolute, to base, to mean [m/s] | free field off "
      "the column [%] |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n",
      kQuiet);
  for (const Run& run : runs) {
    const auto &s = run.shaking(), &solver = run.summary["solver"];
    double absolute = 0, base = 0, mean = 0;
    for (const std::string& p : kPoints) {
      const auto raise = [&](double& largest, const std::string& column) {
        largest = std::max(largest, std::abs(quiet_line(run, run.series(column)).slope));
      };
      raise(absolute, p + ".displacement_x");
      raise(base, p + "_to_base.displacement_x");
      raise(mean, p + "_to_mean.displacement_x"), raise(mean, p + "_to_mean.displacement_y");
    }
    // the free field at the height of the axis
    const Series point = run.series("right.displacement_x"),
                 relative = run.series("right_to_field.displacement_x");
    // dashpots of the solid rock on top; all of the motion goes up where it is called that
    const double top = run.has("boundary.top.use=true") ? (ground.softness - 1) / (ground.softness + 1) : 1,
                 factor = run.has("boundary.base.motion=upgoing") ? 2 : 1;
    double off = 0, largest = 0;
    for (size_t i = 0; i < point.size(); ++i) {
      const double exact = factor * ground.at(kAxis, run.time(i), top);
      off = std::max(off, std::abs(point[i] - relative[i] - exact)),
      largest = std::max(largest, std::abs(exact));
    }
    int64_t steps = 0;
    for (const auto& stage : run.summary["stages"]) steps += stage["steps"].get<int64_t>();
    fmt::print(
        "| {} | {:.3f} | {} ({:.1f}) | {} | {:.1f} | {:.1f} | {:.1e} | {:.1e} | {:.1e}, {:.1e}, {:.1e} | "
        "{:.2f} |\n",
        run.name, 1e3 * s["dt [s]"].get<double>(), s["blocks_clamped"].get<int>(),
        s["largest_clamp"].get<double>(), steps, solver["iterations_mean"].get<double>(),
        run.summary["wall_time [s]"].get<double>() / 60, solver["contact_error_worst [m]"].get<double>(),
        run.summary["energy_closure"].get<double>(), absolute, base, mean, 100 * off / largest);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: tunnel_variants MOTION.csv NAME=FOLDER ...\n");
    return 2;
  }
  try {
    const Ground ground(argv[1]);
    std::vector<Run> runs;
    for (int i = 2; i < argc; ++i) runs.push_back(read_run(argv[i]));
    print_motion(runs);
    print_damage(runs);
    print_health(runs, ground);
  } catch (const std::exception& e) {
    fmt::print(stderr, "tunnel_variants: {}\n", e.what());
    return 1;
  }
  return 0;
}
