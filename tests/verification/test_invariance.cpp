// What must not matter does not matter: seven models, each run beside its transforms (support/invariance.h).
// A sample every day; all of it in the suite "long: invariance".

#include <chrono>

#include "support/invariance.h"
#include "support/limit_models.h"
#include "support/tolerance.h"
#include "talus/base/index.h"

namespace test_invariance {

using namespace talus;
using namespace talus::test;
using namespace talus::test::limit;

namespace {

// All coordinates are multiples of 2^-20 m, so that moving the model by 2^20 m rounds nothing: where joints
// cross, the grid of the cut is that coarse, and the two sets run along (2, 1) and (-1, 2).
const char kDyadicGrid[] = "cut.grid=9.5367431640625e-07";

std::string head(const std::string& joint) {
  return "talus = 1\n[model]\ngravity = [0, -9.81]\n[material.m]\ndensity = 2500\nyoung = 10e9\npoisson = "
         "0.25\n[joint.face]\n" +
         joint + "[contact]\njoint = \"face\"\n";
}

std::string stage(double duration, double step, double damping) {
  return fmt::format(
      "[[stage]]\nname = \"run\"\nkind = \"dynamic\"\nduration = {}\ntime_step = {}\nelasticity = "
      "\"implicit\"\ndamping_mass = {}\n",
      duration, step, damping);
}

std::string push(double acceleration) {
  return fmt::format(
      "[history.push]\ntime = [0, 0.02, 9]\nvalue = [0, {0}, {0}]\n[[load]]\nname = \"push\"\n"
      "acceleration_x = \"push\"\n",
      acceleration);
}

std::string two_sets() {
  return fmt::format(
      "[[joint_set]]\nname = \"flat\"\nangle = \"{:.17g} rad\"\nspacing = {:.17g}\norigin = [0.25, 0.125]\n"
      "[[joint_set]]\nname = \"steep\"\nangle = \"{:.17g} rad\"\nspacing = {:.17g}\norigin = [0.25, 0.125]\n",
      std::atan2(1.0, 2.0), std::sqrt(5.0) / 4, std::atan2(2.0, -1.0), std::sqrt(5.0) / 4);
}

// Hard joints, running bond, pushed sideways below its strength: forces are not unique.
std::string wall() {
  return head("friction_angle = \"35 deg\"\n") +
         "[[region]]\nname = \"wall\"\npolygon = [[0, 0], [1.25, 0], [1.25, 0.75], [0, 0.75]]\nmaterial = "
         "\"m\"\n"
         "[[masonry]]\nname = \"bond\"\nregion = \"wall\"\nlength = 0.25\nheight = 0.125\n" +
         block_text("floor", {{-0.5, -0.25}, {1.75, -0.25}, {1.75, 0}, {-0.5, 0}}, "fixed") + push(1.5) +
         stage(0.04, 2e-4, 50);
}

// Hard joints, eleven voussoirs.
std::string arch() {
  return head("friction_angle = \"35 deg\"\n") +
         "[[arch]]\nname = \"ring\"\ncenter = [0, 0]\nradius = 2\nthickness = 0.5\nvoussoirs = 11\nmaterial "
         "= \"m\"\n" +
         block_text("left", {{-2.75, -0.5}, {-1.75, -0.5}, {-1.75, 0}, {-2.75, 0}}, "fixed") +
         block_text("right", {{1.75, -0.5}, {2.75, -0.5}, {2.75, 0}, {1.75, 0}}, "fixed") + push(1) +
         stage(0.04, 2e-4, 50);
}

const char kElastic[] = "normal_stiffness = 10e9\nshear_stiffness = 5e9\n";

// A bench whose flat set dips out of its face more steeply than its friction.
std::string slope() {
  return head(std::string("friction_angle = \"20 deg\"\n") + kElastic) +
         "[[region]]\nname = \"rock\"\npolygon = [[0, 0], [2.5, 0], [2.5, 2], [0, 2]]\nmaterial = \"m\"\n" +
         two_sets() + block_text("floor", {{-1, -1}, {3.5, -1}, {3.5, 0}, {-1, 0}}, "fixed") +
         block_text("back", {{2.5, 0}, {3.5, 0}, {3.5, 2}, {2.5, 2}}, "fixed") + stage(0.08, 4e-4, 200);
}

// Rock under the stress of the ground in a frame that stands still, and a square dug out of it.
std::string tunnel() {
  return head(std::string("friction_angle = \"30 deg\"\n") + kElastic) +
         "[in_situ]\nstress_xx = -2e6\nstress_yy = -4e6\n"
         "[[region]]\nname = \"rock\"\npolygon = [[0, 0], [3, 0], [3, 3], [0, 3]]\nmaterial = \"m\"\n"
         "[[opening]]\nname = \"tunnel\"\nshape = \"polygon\"\npolygon = [[1, 1], [2, 1], [2, 2], [1, "
         "2]]\nrock = \"kept\"\n" +
         two_sets() + block_text("floor", {{-1, -1}, {4, -1}, {4, 0}, {-1, 0}}, "fixed") +
         block_text("roof", {{-1, 3}, {4, 3}, {4, 4}, {-1, 4}}, "fixed") +
         block_text("left", {{-1, 0}, {0, 0}, {0, 3}, {-1, 3}}, "fixed") +
         block_text("right", {{3, 0}, {4, 0}, {4, 3}, {3, 3}}, "fixed") +
         "[[stage]]\nname = \"rest\"\nkind = \"dynamic\"\nduration = 0.004\ntime_step = 2e-4\nelasticity = "
         "\"implicit\"\n"
         "[[stage]]\nname = \"dug\"\nkind = \"dynamic\"\nduration = 0.036\ntime_step = 2e-4\nelasticity = "
         "\"implicit\"\ndamping_mass = 100\nexcavate = [\"tunnel\"]\n";
}

// One body of glued triangles and a fault through it, pushed beyond its friction.
std::string mesh() {
  return head("friction_angle = \"30 deg\"\n") +
         "[joint.fault]\nfriction_angle = \"30 deg\"\nnormal_stiffness = 20e9\nshear_stiffness = 20e9\n"
         "[joint.glue]\nkind = \"bonded\"\n"
         "[[region]]\nname = \"body\"\npolygon = [[0, 0], [2, 0], [2, 2], [0, 2]]\nsides = [\"base\", "
         "\"right\", \"top\", \"left\"]\nmaterial = \"m\"\njoint = \"glue\"\n"
         "[[fault]]\nname = \"slide\"\npoints = [[-1, 1], [3, 1]]\njoint = \"fault\"\n"
         "[[joint_set]]\nname = \"upright\"\nangle = \"90 deg\"\nspacing = 0.5\norigin = [0.5, 0]\njoint = "
         "\"glue\"\n" +
         fmt::format(
             "[[joint_set]]\nname = \"oblique\"\nangle = \"45 deg\"\nspacing = {:.17g}\norigin = [0, "
             "0]\njoint = \"glue\"\n",
             std::sqrt(0.5)) +
         "[[support]]\nname = \"base\"\nalong = \"base\"\n"
         "[history.press]\ntime = [0, 1]\nvalue = [4e5, 4e5]\n[history.shear]\ntime = [0, 0.01, 1]\nvalue = "
         "[0, 3.2e5, 3.2e5]\n"
         "[[load]]\nname = \"press\"\nalong = \"top\"\npressure = \"press\"\n"
         "[[load]]\nname = \"shear\"\nalong = \"top\"\ntraction_x = \"shear\"\n" +
         stage(0.02, 1e-4, 50);
}

// Stones of crooked grid cells, thrown at each other and falling into a box.
std::string pile() {
  constexpr int kRows = 5, kColumns = 5;
  std::string text = head("friction_angle = \"30 deg\"\n");
  text += block_text("floor", {{-1, -1}, {kColumns + 1, -1}, {kColumns + 1, 0}, {-1, 0}}, "fixed");
  text += block_text("left", {{-1, 0}, {0, 0}, {0, kRows + 4}, {-1, kRows + 4}}, "fixed");
  text += block_text(
      "right", {{kColumns, 0}, {kColumns + 1, 0}, {kColumns + 1, kRows + 4}, {kColumns, kRows + 4}}, "fixed");
  Random random(7);
  const auto between = [&random](double low, double high) { return low + (high - low) * random.uniform(); };
  const auto dyadic = [](Vec2 v) {
    return std::ldexp(1, -20) * Vec2{std::rint(std::ldexp(v.x, 20)), std::rint(std::ldexp(v.y, 20))};
  };
  std::vector<Vec2> node;
  for (int y = 0; y <= kRows; ++y)
    for (int x = 0; x <= kColumns; ++x) {
      const double dx = between(-0.15, 0.15), dy = between(-0.15, 0.15);
      node.push_back({x + (x > 0 && x < kColumns ? dx : 0), y + 0.3 + dy});
    }
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const auto at = [&](int i, int j) { return node[j * (kColumns + 1) + i]; };
      Polygon stone{at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)};
      const Vec2 middle = 0.25 * (stone[0] + stone[1] + stone[2] + stone[3]);
      for (Vec2& v : stone) v = dyadic(middle + 0.9 * (v - middle));
      const double vx = between(-1, 1), vy = between(-1, 1);
      text += block_text(fmt::format("s{}", y * kColumns + x), stone, "rigid") +
              fmt::format("velocity = [{}, {}]\n", vx, vy);
    }
  return text + stage(2, 5e-4, 0);
}

// One block on a wide floor, on which nothing can be in doubt: says that the transforms themselves are right.
std::string block() {
  return head(std::string("friction_angle = \"20 deg\"\n") + kElastic) +
         "[[region]]\nname = \"one\"\npolygon = [[0, 0], [1, 0], [1, 0.5], [0, 0.5]]\nmaterial = \"m\"\n" +
         block_text("floor", {{-2, -1}, {3, -1}, {3, 0}, {-2, 0}}, "fixed") + push(5) +
         stage(0.08, 4e-4, 200);
}

struct Case {
  const char* name;
  std::string (*text)();
  bool redundant = false;  // forces of single faces are not unique: supports and motion alone are compared
  bool cut_anew = true;    // can be cut in another place
  bool bounces = false;
};

const Case kCases[] = {{"block", block},
                       {"wall", wall, true, false},
                       {"arch", arch, true, true},
                       {"slope", slope, false, true},
                       {"tunnel", tunnel, false, true},
                       {"mesh with fault", mesh},
                       {"pile", pile, false, false, true}};

const Case& case_called(const std::string& name) {
  for (const Case& c : kCases)
    if (c.name == name) return c;
  FAIL("no case called ", name);
  return kCases[0];
}

// Rows that do not hold today: the deviation measured, of which ten times is let pass, as what grows from
// round-off is not the same on every machine. A row that holds its tolerance says nothing of its being here.
// To be emptied row by row as the causes are mended; an empty table is the aim.
struct Known {
  const char *model, *transform;
  double measured;
};
const std::vector<Known> kKnown = {
    {"block", "turned and moved by 1e6 m", 1.2e-04},
    {"block", "half and quarter step, ratio of changes", 1.4e+00},
    {"wall", "a pebble far away", 2.3e-02},
    {"wall", "blocks backwards", 8.9e-02},
    {"wall", "blocks shuffled", 1.3e-01},
    {"wall", "mirrored", 2.7e-02},
    {"wall", "turned by 37 deg", 2.3e-02},
    {"wall", "turned by 90 deg", 3.6e-02},
    {"wall", "units x 1000", 2.5e-02},
    {"wall", "turned and moved by 1e6 m", 4.6e-02},
    {"wall", "half and quarter step, ratio of changes", 1.2e+00},
    {"slope", "moved by 2^20 m", 1.8e-09},
    {"tunnel", "units x 1000", 1.6e-08},
    {"arch", "a pebble far away", 8.6e-09},
    {"arch", "blocks backwards", 1.8e-05},
    {"arch", "blocks shuffled", 1.1e-05},
    {"arch", "turned and moved by 1e6 m", 8.9e-06},
    {"arch", "glued triangles", 6.4e-02},
    {"arch", "half and quarter step, ratio of changes", 1.1e+00},
    {"slope", "a pebble far away", 4.3e-11},
    {"slope", "turned and moved by 1e6 m", 1.1e-03},
    {"slope", "turned by 37 deg and cut again", 1.3e-03},
    {"slope", "2 x 2 glued parts", 1.3e-02},
    {"slope", "glued triangles", 1.3e-02},
    {"slope", "a set of unlimited strength", 2.0e-01},
    {"tunnel", "turned and moved by 1e6 m", 2.6e-06},
    {"tunnel", "turned by 37 deg and cut again", 2.8e-03},
    {"tunnel", "a pebble far away", 1.6e-12},
    {"tunnel", "blocks backwards", 5.3e-02},
    {"tunnel", "blocks shuffled", 5.0e-02},
    {"tunnel", "2 x 2 glued parts", 3.4e-02},
    {"tunnel", "glued triangles", 3.3e-02},
    {"tunnel", "a set of unlimited strength", 5.5e-01},
    {"mesh with fault", "blocks backwards", 8.0e-07},
    {"mesh with fault", "blocks shuffled", 8.8e-07},
    {"mesh with fault", "mirrored", 2.3e-09},
    {"mesh with fault", "turned by 37 deg", 2.8e-02},
    {"mesh with fault", "turned by 90 deg", 2.4e-09},
    {"mesh with fault", "moved by 2^20 m", 2.5e-09},
    {"mesh with fault", "units x 1000", 2.3e-09},
    {"mesh with fault", "turned and moved by 1e6 m", 2.8e-02},
    {"mesh with fault", "turned by 37 deg and cut again", 2.8e-02},
    {"mesh with fault", "2 x 2 glued parts", 1.6e-01},
    {"mesh with fault", "glued triangles", 2.2e-01},
    {"mesh with fault", "a set of unlimited strength", 2.2e-01},
    {"pile", "a pebble far away", 3.3e-09},
};

void judge(const Case& c, const std::string& transform, double found, double must, const Outcome& original) {
  double allowed = must;
  for (const Known& k : kKnown)
    if (k.model == std::string(c.name) && k.transform == transform)
      allowed = std::max(allowed, 10 * k.measured);
  fmt::print("residual | {:<58} | {:>15.9g} | {:>15.9g} | {:>9.2e} | {:>7.3g} | {:>7.3g} |{}\n",
             fmt::format("invariance: {}, {}", c.name, transform), found, 0.0, found, must, must,
             found <= must      ? ""
             : found <= allowed ? " known defect"
                                : " FAILS");
  std::fflush(stdout);
  INFO(std::string(c.name), ", ", transform, ": ", found, ", must be at most ", must, ", solver reached ",
       original.solver_error, " of the smallest block, ", original.failed_steps,
       " steps above its tolerance");
  CHECK(found <= allowed * tolerance_factor());
}

// A model and what was found for it as it is written, kept for the transforms to come.
class Subject {
 public:
  /// @param share  of the duration of the stages that is run
  explicit Subject(const Case& c, double share = 1) : case_(c), share_(share), problem_(made({kDyadicGrid})) {
    if (c.bounces) options_.snapshots = 400;
    original_ = outcome_of(problem_, options_);
    fmt::print(
        "invariance: {}: {} blocks, contact error at most {:.1e} of the smallest, {} steps above {:g}\n",
        c.name, problem_.bodies, original_.solver_error, original_.failed_steps, kTightest);
  }

  void check(const std::string& transform) {
    bool known = false;
    for (const auto& [name, does] : transforms()) {
      known = known || name == transform;
      if (name == transform) does();
    }
    REQUIRE(known);
  }
  void check_all() {
    for (const auto& [name, does] : transforms()) does();
  }

 private:
  Problem made(const std::vector<std::string>& overrides) const {
    Problem p = problem_of(case_.text(), overrides);
    for (StageInput& s : p.model.stages) s.duration *= share_;
    return p;
  }

  // What a transform should not change beyond round-off. Positions round to 1e-16 of the model's size, forces
  // follow with size/closure (1e5 to 1e6 times as much) or, of hard joints, with what the solver leaves; what
  // redundant hard friction decides is taken from where the step before left it, and strays further.
  double exact() const { return case_.bounces || case_.redundant ? 1e-6 : 1e-9; }

  void judge_same(const std::string& name, const Outcome& a, const Outcome& b, double must) {
    if (!case_.bounces) {
      judge(case_, name, deviation(a, b).largest(!case_.redundant), must, a);
      return;
    }
    // each collision multiplies a difference: compared until the tenth, and where all has come to rest
    size_t before = 0;
    while (before < a.at.size() && a.at[before].touched <= 10) ++before;
    REQUIRE(before > 0);
    judge(case_, name, deviation(a, b, before).largest(true), must, a);
    judge_at_rest(name, a, b);
  }
  // 5 %: single stones come to lie elsewhere; the heap as a whole is what a user of piles looks at
  void judge_at_rest(const std::string& name, const Outcome& a, const Outcome& b) {
    const Snapshot &x = a.at.back(), &y = b.at.back();
    judge(case_, name + ", at rest",
          std::max(std::abs(y.height / x.height - 1), std::abs(y.dissipated / x.dissipated - 1)), 5e-2, a);
  }
  void as_original(const std::string& name, const Problem& other, double must) {
    judge_same(name, original_, outcome_of(other, options_), must);
  }

  // Every transform with its tolerance; those that have no meaning for this model are left out.
  std::vector<std::pair<std::string, std::function<void()>>> transforms() {
    std::vector<std::pair<std::string, std::function<void()>>> all;
    const auto add = [&all](const std::string& name, std::function<void(const std::string&)> does) {
      all.emplace_back(name, [name, does = std::move(does)] { does(name); });
    };
    const auto same = [&](const std::string& name, std::function<Problem()> other, double must) {
      add(name,
          [this, other = std::move(other), must](const std::string& n) { as_original(n, other(), must); });
    };
    same(
        "a pebble far away", [this] { return with_pebble(problem_); }, 0);
    same(
        "blocks backwards", [this] { return reordered(problem_, 0); }, exact());
    same(
        "blocks shuffled", [this] { return reordered(problem_, 5); }, exact());
    same(
        "mirrored", [this] { return placed(mirrored(), problem_); }, exact());
    same(
        "turned by 37 deg", [this] { return placed(turned_by(37), problem_); }, exact());
    same(
        "turned by 90 deg", [this] { return placed(turned_by(90), problem_); }, exact());
    same(
        "moved by 2^20 m",
        [this] {
          return placed(moved_by({0x1p20, 0x1p20}), problem_);
        },
        exact());
    same(
        "units x 1000", [this] { return placed(scaled_by(1000), problem_); }, exact());
    // coordinates of 1e6 m round to 1e-10 m, 1e-6 of the closures; ten collisions one after the other make
    // more of it
    add("turned and moved by 1e6 m", [this](const std::string& name) {
      Similarity far = turned_by(37);
      far.shift = {1e6, -1e6};
      as_original(name, placed(far, problem_), case_.bounces ? 1e-5 : 1e-6);
    });
    if (case_.cut_anew && !case_.bounces)
      add("turned by 37 deg and cut again", [this](const std::string& name) { check_cut_again(name); });
    if (!case_.bounces) {
      add("2 x 2 glued parts", [this](const std::string& name) { check_parts(name, 2); });
      add("glued triangles", [this](const std::string& name) { check_parts(name, 0); });
    }
    if (case_.cut_anew && !case_.bounces && !case_.redundant)
      add("a set of unlimited strength", [this](const std::string& name) { check_unlimited_set(name); });
    add("half and quarter step", [this](const std::string& name) { check_steps(name); });
    add("restarts", [this](const std::string& name) { check_restarts(name); });
    for (const int threads : {2, 3, 4})
      add(fmt::format("{} threads", threads), [this, threads](const std::string& name) {
        RunOptions options = options_;
        options.threads = threads;
        judge_same(name, original_, outcome_of(problem_, options), 0);
      });
    return all;
  }

  // Corners move by a cell of the grid, which counts against the closure of the joints; hard joints close as
  // far as their blocks do.
  void check_cut_again(const std::string& name) {
    const Problem here = made({});
    const Problem there = cut_again(turned_by(37), here);
    const Outcome a = outcome_of(here, options_);
    double closure = 0, moved = 0;
    for (const Snapshot& s : a.at) {
      for (const Vec2 u : s.displacement) moved = std::max(moved, norm(u));
      for (const auto& [key, force] : s.face) {
        const Polygon& p = here.layout.blocks[key[0]].polygon;
        if (key[1] < 0) continue;
        const int k = key[1];
        const double stiffness = here.model.joints.back().bonded && here.model.joints.size() > 1
                                     ? here.model.joints[1].normal_stiffness
                                     : here.model.joints[0].normal_stiffness;
        if (stiffness > 0)
          closure = std::max(closure, norm(force) / norm(p[(k + 1) % p.size()] - p[k]) / stiffness);
      }
    }
    if (closure == 0) closure = moved;
    fmt::print("invariance: {}, {}: cell {:.2e} m, closure {:.2e} m\n", case_.name, name, there.cell,
               closure);
    judge_same(name, a, outcome_of(there, options_), std::max(exact(), 10 * there.cell / closure));
  }

  Problem stiff() const {
    Problem p = problem_;
    for (Material& m : p.model.materials) m.young *= 100;
    // enough for 1 %; what one solver leaves above that is kept, so that steps are not taken in parts here and whole there
    p.model.solver.tolerance = 1e-9, p.model.solver.limit = 1e-5, p.model.solver.second_solver = false;
    return p;
  }
  // Both a hundred times stiffer, so that the softness of a whole block does not tell: motion within 1 % of
  // what the model as written moves, forces (means of a quarter of the run: the parts ring) within 1 %.
  void judge_bodies(const std::string& name, const Outcome& a, const Outcome& b) {
    const Deviation d = deviation(a, b);
    const auto farthest = [](const Outcome& o) {
      double far = 0;
      for (const Snapshot& s : o.at)
        for (const Vec2 u : s.displacement) far = std::max(far, norm(u));
      return far;
    };
    const double motion = d.displacement * farthest(a) / std::max(farthest(a), farthest(original_));
    judge(case_, name, std::max({motion, d.held_mean, case_.redundant ? 0 : d.pair_mean}), 1e-2, a);
  }
  void check_parts(const std::string& name, int k) {
    judge_bodies(name, outcome_of(divided(stiff(), 1), options_), outcome_of(divided(stiff(), k), options_));
  }
  void check_unlimited_set(const std::string& name) {
    const Problem whole = stiff();
    const Problem parts = cut_again({}, whole, [](Model& model) {
      JointProperty strong;
      strong.name = "unlimited", strong.friction_angle = 0.5;
      strong.cohesion = strong.tensile_strength = 1e12;
      JointSetInput set;
      set.name = "across", set.angle.mean = std::numbers::pi / 2, set.spacing.mean = 0.375;
      set.origin = {0.1875, 0};
      set.joint = count_of(model.joints);
      model.joints.push_back(strong), model.joint_sets.push_back(set);
    });
    judge_bodies(name, outcome_of(divided(whole, 1), options_), outcome_of(parts, options_));
  }

  // The last halving changes no more than the one before.
  void check_steps(const std::string& name) {
    const auto with_step = [this](double share) {
      Problem p = problem_;
      for (StageInput& s : p.model.stages) s.time_step *= share;
      return outcome_of(p, options_);
    };
    const Outcome half = with_step(0.5);
    if (case_.bounces) return judge_at_rest(name, original_, half);
    const Outcome quarter = with_step(0.25);
    // of places: velocities ring
    const auto d = [](const Outcome& a, const Outcome& b) { return deviation(a, b).displacement; };
    const double first = d(original_, half), second = d(half, quarter);
    fmt::print("invariance: {}, {}: {:.2e}, then {:.2e}\n", case_.name, name, first, second);
    judge(case_, name + ", ratio of changes", second < 1e-9 ? 0 : second / first, 1, original_);
  }

  // Early, right after the stages change (the tunnel is dug after step 20), and late.
  void check_restarts(const std::string& name) {
    RunOptions options = options_;
    options.restarts = {3, 20, 21, 22, 90, 150};
    judge_same(name, original_, outcome_of(problem_, options), 0);
  }

  const Case& case_;
  double share_;
  Problem problem_;
  RunOptions options_;
  Outcome original_;
};

}  // namespace

TEST_CASE("invariance: a sample of models and transforms") {
  Subject block(case_called("block"));
  for (const char* transform : {"turned by 37 deg and cut again", "2 x 2 glued parts", "a pebble far away",
                                "blocks backwards", "mirrored"})
    block.check(transform);
  Subject slope(case_called("slope"), 0.25);
  for (const char* transform :
       {"blocks backwards", "turned by 90 deg", "moved by 2^20 m", "3 threads", "restarts"})
    slope.check(transform);
  Subject(case_called("arch"), 0.25).check("mirrored");
  Subject(case_called("tunnel"), 0.25).check("units x 1000");
  Subject(case_called("mesh with fault"), 0.05).check("turned by 37 deg");
}

TEST_SUITE("long: invariance") {
  TEST_CASE("invariance: block") { Subject(case_called("block")).check_all(); }
  TEST_CASE("invariance: wall") { Subject(case_called("wall")).check_all(); }
  TEST_CASE("invariance: arch") { Subject(case_called("arch")).check_all(); }
  TEST_CASE("invariance: slope") { Subject(case_called("slope")).check_all(); }
  TEST_CASE("invariance: tunnel") { Subject(case_called("tunnel")).check_all(); }
  TEST_CASE("invariance: mesh with fault") { Subject(case_called("mesh with fault")).check_all(); }
  TEST_CASE("invariance: pile") { Subject(case_called("pile")).check_all(); }
}

}  // namespace test_invariance
