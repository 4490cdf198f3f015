// Does a joint slide at its strength, and stick below it, however the two bodies beside it are divided? Two
// bodies, one on the other, pressed together and sheared along their one joint:
//
//      p p p p p p p p            the upper one, 2 m x 0.25 m or a little wider, shifted by `offset` against
//      the lower one
//     +---+---+---+---+           every block of it is pushed sideways by the same acceleration
//     +---+---+---+---+
//  +--+-+-----+-----+-+--+        the joint: shear/pressure = 0.95 or 1.05 of tan(friction), weight off
//  +----+-----+-----+----+        held at its foot
//
// Each body is whole, cut into columns x rows, into triangles, or by a steep set; its parts are glued, or
// loose (hard joints, or of the stiffness of the joint, of 80 deg friction so that they hold). By statics
// alone, at 1.05 the impulses along and across the joint of the last quarter are as tan(friction), to 1 %,
// and at 0.95 the upper body moves at less than 1e-6 m/s at the end. A joint without friction is pushed by
// 0.1 of the pressure and bears less than 1e-4 of it.
//
// Usage: sliding_joints [--sample] [--part N/M] [--jobs N] [--case NUMBER] [--text NUMBER]
// Default: all cases, in two processes. One line per case that fails, then tables; exit code 1 if any does.

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "talus/results/histories.h"
#include "talus/talus.h"

namespace {

constexpr double kWidth = 2, kHeight = 0.25, kDensity = 2600;  // of the upper body [m], [kg/m3]
constexpr double kDuration = 0.045;                            // [s]

// Over a loose lower body the upper one ends beyond the joint at 2 m: the unloaded block behind a joint that
// ends there would stand proud by what its neighbour is pressed together, a step that stops the upper body by
// right. The last part is wide enough not to topple under its push [m].
constexpr double kWider = 2.24, kWiderSet = 2.45;

// Loose hard blocks carry redundant friction, and sweeps may stay above the default tolerance [-]; such a
// case is run again with the next one.
constexpr double kTolerances[] = {1e-8, 1e-7, 1e-6};

struct Body {
  const char* name;
  int columns, rows;  // 0: no such joints
  enum { kPlain, kTriangles, kSet } kind = kPlain;
};
const Body kBodies[] = {{"1x1", 0, 0},
                        {"2x2", 2, 2},
                        {"3x2", 3, 2},
                        {"8x8", 8, 8},
                        {"triangles", 4, 1, Body::kTriangles},
                        {"set", 0, 0, Body::kSet}};
enum { k1x1, k2x2, k3x2, k8x8, kTriangular, kCutBySet };

struct Case {
  int above = 0, below = 0;
  bool above_glued = true, below_glued = true;
  double stiffness = 0;   // kn = ks [Pa/m], 0: hard
  double friction = 30;   // [deg]
  double pressure = 4e5;  // [Pa]
  double offset = 0;      // [m]
  double load = 1.05;     // of the strength; without friction: 0.1 of the pressure

  // of the upper body [m]
  double width() const {
    const bool at_joint = !below_glued && below != kCutBySet && offset == 0 && load > 1;
    return !at_joint ? kWidth : above == kCutBySet || above == kTriangular ? kWiderSet : kWider;
  }
  double mu() const { return std::tan(friction * std::numbers::pi / 180); }
  std::string meshes() const {
    const auto body = [](int mesh, bool glued) {
      return fmt::format("{}{}", kBodies[mesh].name, glued ? "" : " loose");
    };
    return body(above, above_glued) + " on " + body(below, below_glued);
  }
  double shear() const { return pressure * (friction > 0 ? load * mu() : 0.1); }  // [Pa]
  std::string name() const {
    return fmt::format("{}, {}, friction {:g}, {:g} MPa, offset {:g} mm, {}", meshes(),

                       stiffness > 0 ? fmt::format("{:g} GPa/m", stiffness * 1e-9) : "hard", friction,
                       pressure * 1e-6, offset * 1e3,
                       friction > 0 ? fmt::format("load {:g}", load) : "load 0.1 of the pressure");
  }
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  const auto add_loads = [&cases](Case c) {
    for (const double load : {1.05, 0.95}) {
      c.load = load;
      cases.push_back(c);
      if (c.friction == 0) break;
    }
  };
  const auto add_meshes = [&](int above, bool above_glued, int below, bool below_glued) {
    for (const double stiffness : {0.0, 20e9})
      for (const double offset : {0.0, 1e-5, 1e-3, 0.3}) {
        Case c;
        c.above = above, c.below = below, c.above_glued = above_glued, c.below_glued = below_glued;
        c.stiffness = stiffness, c.offset = offset;
        add_loads(c);
      }
  };
  for (int above = k1x1; above <= kCutBySet; ++above)
    for (int below = k1x1; below <= kCutBySet; ++below)
      for (const bool above_glued : {true, false})
        for (const bool below_glued : {true, false})
          // one block has nothing to be glued
          if ((above != k1x1 || above_glued) && (below != k1x1 || below_glued))
            add_meshes(above, above_glued, below, below_glued);
  for (const auto& [above, below] : {std::pair{k2x2, k2x2}, {k8x8, k3x2}, {kTriangular, kCutBySet}})
    for (const bool glued : {true, false})
      for (const double friction : {0.0, 10.0, 20.0, 30.0, 40.0})
        for (const double pressure : {1e4, 1e5, 1e6, 1e7})
          for (const double stiffness : {100e9, 1000e9}) {
            Case c;
            c.above = above, c.below = below, c.above_glued = c.below_glued = glued;
            // upper joints off the lower ones: behind those a loose block stands proud by its smaller share
            // of the pressure
            c.offset = glued ? 0 : 0.01;
            c.friction = friction, c.pressure = pressure, c.stiffness = stiffness;
            add_loads(c);
          }
  return cases;
}

// Joints of a body whose corner is at (x, y).
std::string cuts(const std::string& region, const Body& body, double x, double y) {
  std::string text;
  const auto set = [&](const char* name, double angle, double spacing) {
    text += fmt::format(
        "[[joint_set]]\nname = \"{}-{}\"\nregion = \"{}\"\nangle = \"{:.17g} deg\"\nspacing = "
        "{:.17g}\norigin = [{:.17g}, {:.17g}]\njoint = \"in-{}\"\n",
        region, name, region, angle, spacing, x, y, region);
  };
  if (body.columns > 0) set("upright", 90, kWidth / body.columns);
  if (body.rows > 1) set("level", 0, kHeight / body.rows);
  if (body.kind == Body::kTriangles) {
    const double w = kWidth / body.columns, h = kHeight / body.rows;
    set("oblique", std::atan2(h, w) * 180 / std::numbers::pi, w * h / std::hypot(w, h));
  }
  if (body.kind == Body::kSet) set("steep", 75, 0.4);
  return text;
}

std::string text_of(const Case& c, double tolerance) {
  const double push = c.shear() / (kDensity * kHeight);
  const std::string stiff =
      c.stiffness > 0 ? fmt::format("normal_stiffness = {0:g}\nshear_stiffness = {0:g}\n", c.stiffness) : "";
  const auto region = [](const char* name, double left, double right, double foot, const char* sides) {
    return fmt::format(
        "[[region]]\nname = \"{0}\"\npolygon = [[{1:.17g}, {3:.17g}], [{2:.17g}, {3:.17g}], [{2:.17g}, "
        "{4:.17g}], [{1:.17g}, {4:.17g}]]\nsides = {5}\nmaterial = \"rock\"\njoint = \"in-{0}\"\n",
        name, left, right, foot, foot + kHeight, sides);
  };
  const auto inside = [&stiff](const char* name, bool glued) {
    return fmt::format("[joint.in-{}]\n{}", name,
                       glued ? "kind = \"bonded\"\n" : "friction_angle = \"80 deg\"\n" + stiff);
  };
  return fmt::format(
             "talus = 1\ntitle = \"{}\"\n[material.rock]\ndensity = {}\nyoung = 20e9\npoisson = 0.2\n"
             "[joint.slide]\nfriction_angle = \"{} deg\"\n{}{}{}",
             c.name(), kDensity, c.friction, stiff, inside("upper", c.above_glued),
             inside("lower", c.below_glued)) +
         region("lower", -0.5, c.width() > kWidth ? kWidth + 1 : kWidth + 0.5, -kHeight,
                "[\"foot\", \"l1\", \"l2\", \"l3\"]") +
         region("upper", c.offset, c.offset + c.width(), 0, "[\"u1\", \"u2\", \"top\", \"u3\"]") +
         cuts("lower", kBodies[c.below], 0, -kHeight) + cuts("upper", kBodies[c.above], c.offset, 0) +
         fmt::format(
             "[[contact_pair]]\nbetween = [\"upper\", \"lower\"]\njoint = \"slide\"\n"
             "[[support]]\nname = \"foot\"\nalong = \"foot\"\n"
             "[history.press]\ntime = [0, 0.004]\nvalue = [0, {0:.17g}]\n"
             "[history.push]\ntime = [0, 0.008, 0.014]\nvalue = [0, 0, {1:.17g}]\n"
             "[[load]]\nname = \"press\"\nalong = \"top\"\npressure = \"press\"\n"
             "[[load]]\nname = \"push\"\nacceleration_x = \"push\"\nblock = \"upper\"\n"
             "[[stage]]\nname = \"run\"\nkind = \"dynamic\"\nduration = {2}\ntime_step = 5e-5\nelasticity = "
             "\"implicit\"\ndamping_mass = 2000\n"
             "[[monitor]]\nname = \"joint\"\ncontact = [\"upper\", \"lower\"]\n"
             // loose parts of many hard joints take more than is worth waiting for
             "[solver]\nmax_sweeps = 3000\ntolerance = {3:g}\n",
             c.pressure, push, kDuration, tolerance);
}

struct Answer {
  double found = 0;
  bool good = false;
  std::string trouble;  // of a run that ended early
  int wider = 0;        // steps to a wider tolerance
};

// The impulses of the joint, and the mean velocity of the upper body.
class Watch : public talus::Observer {
 public:
  explicit Watch(const talus::Scene& scene)
      : histories_(scene, [this](const std::vector<double>& row) { rows_.push_back(row); }),
        upper_(scene.layout.blocks_called("upper")) {
    const std::vector<std::string> titles = talus::texts_of(histories_.columns());
    const auto column = [&titles](const char* title) {
      const auto it = std::find(titles.begin(), titles.end(), title);
      if (it == titles.end()) throw std::runtime_error("no column of that title");
      return static_cast<size_t>(it - titles.begin());
    };
    x_ = column("joint.impulse_x [N s]"), y_ = column("joint.impulse_y [N s]");
  }
  void at(const talus::Instant& now) override {
    const bool quarter_left = now.state.time >= 0.75 * kDuration && rows_.empty();
    histories_.at(now, quarter_left || now.last);
    if (!now.last) return;
    histories_.finish();
    double mass = 0;
    for (const int i : upper_) {
      const auto k = static_cast<size_t>(i);
      mass += now.scene.blocks.mass[k];
      speed += now.scene.blocks.mass[k] * rate_now(now.work, now.state, k).a.x;
    }
    speed /= mass;
  }
  double ratio() const {
    return std::abs((rows_.back()[x_] - rows_.front()[x_]) / (rows_.back()[y_] - rows_.front()[y_]));
  }
  double speed = 0;  // [m/s]

 private:
  talus::Histories histories_;
  std::vector<int> upper_;
  std::vector<std::vector<double>> rows_;
  size_t x_ = 0, y_ = 0;
};

Answer answer_at(const Case& c, double tolerance) {
  Answer out;
  try {
    const std::string text = text_of(c, tolerance);
    talus::Findings findings("sliding_joints", text);
    talus::PreparedRun prepared = talus::prepare_run("sliding_joints", text, {}, findings);
    talus::State state = talus::start_state(prepared.scene);
    Watch watch(prepared.scene);
    const talus::RunResult result = talus::run_stages(prepared.scene, prepared.plans, state, watch);
    if (!result.failure.empty()) {
      out.trouble = result.failure.substr(0, 90);
    } else if (c.friction == 0) {
      out.found = watch.ratio(), out.good = out.found < 1e-4;
    } else if (c.load > 1) {
      out.found = watch.ratio(), out.good = std::abs(out.found / c.mu() - 1) <= 0.01;
    } else {
      out.found = watch.speed, out.good = std::abs(out.found) < 1e-6;
    }
  } catch (const std::exception& e) {
    out.trouble = std::string(e.what()).substr(0, 200);
  }
  return out;
}

Answer answer_of(const Case& c) {
  Answer out;
  int wider = 0;
  for (const double tolerance : kTolerances) {
    out = answer_at(c, tolerance);
    out.wider = wider++;
    if (out.trouble.empty()) break;
  }
  return out;
}

std::string line_of(const Case& c, const Answer& a) {
  std::string line = fmt::format("{}: ", c.name());
  if (!a.trouble.empty()) return line + "the run failed: " + a.trouble;
  if (c.friction == 0) return line + fmt::format("shear/normal {:.3g}, must be below 1e-4", a.found);
  if (c.load > 1) return line + fmt::format("shear/normal {:.4f}, must be {:.4f}", a.found, c.mu());
  return line + fmt::format("moves at {:.3g} m/s, must stand", a.found);
}

// A child process takes every `jobs`-th case and writes "number good line".
std::vector<FILE*> start(const std::vector<Case>& cases, const std::vector<int>& chosen, int jobs) {
  std::vector<FILE*> out;
  for (int j = 0; j < jobs; ++j) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("no process");
    if (child == 0) {
      close(ends[0]);
      FILE* to = fdopen(ends[1], "w");
      for (size_t k = static_cast<size_t>(j); k < chosen.size(); k += static_cast<size_t>(jobs)) {
        const Case& c = cases[static_cast<size_t>(chosen[k])];
        const Answer a = answer_of(c);
        std::string line = line_of(c, a);
        std::replace(line.begin(), line.end(), '\n', ' ');
        fmt::print(to, "{} {} {} {} {}\n", chosen[k], a.good ? 1 : 0, a.trouble.empty() ? 0 : 1, a.wider,
                   line);
        std::fflush(to);
      }
      std::fclose(to);
      _exit(0);
    }
    close(ends[1]);
    out.push_back(fdopen(ends[0], "r"));
  }
  return out;
}

struct Count {
  int cases = 0, fail = 0;
};

void print_table(const char* title, const std::map<std::string, Count>& rows) {
  fmt::print("{}\n", title);
  for (const auto& [name, n] : rows) fmt::print("  {:<36} {:>5} cases {:>5} fail\n", name, n.cases, n.fail);
}

int run(const std::vector<Case>& cases, const std::vector<int>& chosen, int jobs) {
  const auto begin = std::chrono::steady_clock::now();
  std::fflush(stdout);
  const std::vector<FILE*> from = start(cases, chosen, jobs);
  std::map<std::string, Count> by_mesh, by_joint, by_load;
  int done = 0, failed = 0, broken = 0;
  std::array<int, std::size(kTolerances)> by_tolerance{};
  for (FILE* f : from) {
    char line[1000];
    while (std::fgets(line, sizeof line, f)) {
      int number = 0, good = 0, trouble = 0, wider = 0, used = 0;
      if (std::sscanf(line, "%d %d %d %d %n", &number, &good, &trouble, &wider, &used) < 4) continue;
      const Case& c = cases[static_cast<size_t>(number)];
      ++done, failed += !good, broken += trouble;
      by_tolerance[static_cast<size_t>(wider)] += !trouble;
      const auto count = [good](Count& n) { ++n.cases, n.fail += !good; };
      count(by_mesh[c.meshes()]);
      count(by_joint[fmt::format("{:>4g} GPa/m, {:g} MPa, friction {:g}", c.stiffness * 1e-9,
                                 c.pressure * 1e-6, c.friction)]);
      count(by_load[c.friction == 0 ? "0.1 of the pressure" : fmt::format("{:g} of the strength", c.load)]);
      if (!good) fmt::print("fails: {}: {}", number, line + used), std::fflush(stdout);
    }
    std::fclose(f);
  }
  while (wait(nullptr) > 0) {
  }
  print_table("by mesh", by_mesh);
  print_table("by joint", by_joint);
  print_table("by load", by_load);
  for (size_t k = 0; k < by_tolerance.size(); ++k)
    fmt::print("solved to a tolerance of {:g}: {} cases\n", kTolerances[k], by_tolerance[k]);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  fmt::print("{} of {} cases fail ({} of them ended early), {:.0f} s in {} processes\n", failed, done, broken,
             seconds, jobs);
  if (done != static_cast<int>(chosen.size())) {
    fmt::print("{} cases gave no answer\n", static_cast<int>(chosen.size()) - done);
    return 1;
  }
  return failed > 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<Case> cases = all_cases();
  std::vector<int> chosen;
  int jobs = 2, part = 1, parts = 1, stride = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i], value = i + 1 < argc ? argv[i + 1] : "";
    if (arg == "--sample") {
      stride = static_cast<int>(cases.size()) / 20;
      stride += 1 - stride % 2;  // both loads
    } else if (arg == "--part" && std::sscanf(value.c_str(), "%d/%d", &part, &parts) == 2 && parts > 0) {
      ++i;
    } else if (arg == "--jobs" && std::atoi(value.c_str()) > 0) {
      jobs = std::atoi(argv[++i]);
    } else if ((arg == "--case" || arg == "--text") && !value.empty() &&
               static_cast<size_t>(std::atoi(value.c_str())) < cases.size()) {
      const Case& c = cases[static_cast<size_t>(std::atoi(argv[++i]))];
      fmt::print("{}\n", arg == "--text" ? text_of(c, kTolerances[0]) : line_of(c, answer_of(c)));
      return 0;
    } else {
      fmt::print(
          stderr,
          "usage: sliding_joints [--sample] [--part N/M] [--jobs N] [--case NUMBER] [--text NUMBER]\n");
      return 2;
    }
  }
  for (int k = part - 1; static_cast<size_t>(k) * static_cast<size_t>(stride) < cases.size(); k += parts)
    chosen.push_back(k * stride);
  fmt::print("{} cases of {}\n", chosen.size(), cases.size());
  try {
    return run(cases, chosen, jobs);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
