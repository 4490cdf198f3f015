// A5: a soft layer on a half-space, shaken from below: tied sides, free-field sides and the column itself
// against the ray series.

#include <complex>
#include <numbers>

#include "support/run_case.h"
#include "support/tolerance.h"
#include "talus/run/base_report.h"

namespace test_site_response {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kDensity = 2000, kShear = 300, kRockDensity = 2500, kRockShear = 1200;  // [kg/m3], [m/s]
constexpr double kHeight = 30, kPeak = 0.8, kRicker = 2.5;                               // [m], [s], [Hz]
const double kRatio = std::sqrt(3.0);  // cp / cs at poisson = 0.25

// Velocity of the outcrop: small, so that turns of blocks are of no account.
double outcrop(double t) {
  const double a = std::pow(std::numbers::pi * kRicker * (t - kPeak), 2);
  return 1e-3 * (1 - 2 * a) * std::exp(-a);
}

// Surface velocity: every wave that came up and down n times before, each with its coefficient.
double ray_series(double t, double speed_ratio) {
  const double z1 = kDensity * kShear, z2 = kRockDensity * kRockShear;
  const double up = 2 * z2 / (z1 + z2), back = (z1 - z2) / (z1 + z2),
               transit = kHeight / (kShear * speed_ratio);
  double sum = 0, share = up;
  for (int n = 0; n < 80; ++n, share *= back) sum += share * outcrop(t - (2 * n + 1) * transit);
  return sum;  // 2 at the free surface times half of the outcrop
}

const char* kMaterials = R"toml(
talus = 1
[material.soil]
density = 2000
young = "450 MPa"
poisson = 0.25
[material.rock]
density = 2500
young = "9 GPa"
poisson = 0.25
[joint.glue]
kind = "bonded"
[history.ricker]
expression = "1e-3*(1-2*(_pi*2.5*(t-0.8))^2)*exp(-(_pi*2.5*(t-0.8))^2)"
duration = "4 s"
[[stage]]
name = "shake"
kind = "dynamic"
duration = "4 s"
)toml";

std::string grid_of(int columns, int rows, const std::string& more = "") {
  return fmt::format(
      "[[grid]]\nname = \"layer\"\nmin = [0, 0]\nmax = [24, 30]\ncells = [{}, {}]\nmaterial = "
      "\"soil\"\njoint = \"glue\"\n{}",
      columns, rows, more);
}

std::string base_of(const std::string& motion) {
  return "[[boundary]]\nname = \"base\"\nkind = \"viscous\"\nedge = [[0, 0], [24, 0]]\nmaterial = "
         "\"rock\"\n" +
         motion;
}

const std::string kOutcropX = "velocity_x = \"ricker\"\nmotion = \"outcrop\"\n";

std::string sides_of(const std::string& kind) {
  return fmt::format(
      "[[boundary]]\nname = \"left\"\nkind = \"{0}\"\nedge = [[0, 0], [0, 30]]\n"
      "[[boundary]]\nname = \"right\"\nkind = \"{0}\"\nedge = [[24, 0], [24, 30]]\n",
      kind);
}

const std::string kTied =
    "[[boundary]]\nname = \"sides\"\nkind = \"tied\"\nedge = [[0, 0], [0, 30]]\nto_edge = [[24, 0], [24, "
    "30]]\n";

const std::string kMonitors =
    "[[monitor]]\nname = \"middle\"\npoint = [12, 30]\n[[monitor]]\nname = \"corner\"\npoint = [0, 30]\n";

// Largest difference of two curves over the largest value of the second.
double misfit(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0, largest = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(a[i] - b[i]));
    largest = std::max(largest, std::abs(b[i]));
  }
  return most / largest;
}

std::vector<double> exact_curve(const std::vector<double>& t, double speed_ratio = 1) {
  std::vector<double> v;
  for (const double x : t) v.push_back(ray_series(x, speed_ratio));
  return v;
}

std::complex<double> fourier(const std::vector<double>& t, const std::vector<double>& v, double f) {
  std::complex<double> sum;
  for (size_t i = 0; i < t.size(); ++i) sum += v[i] * std::polar(1.0, -2 * std::numbers::pi * f * t[i]);
  return sum;
}

// The velocity of a node of the first free-field column at each instant.
struct ColumnTop {
  std::vector<double> x, y;
  void operator()(const Instant& i) {
    const FreeField& f = i.scene.boundaries.free_field;
    const int top = f.columns[0].first_node + f.columns[0].elements;
    x.push_back(i.state.column_displacement[top].x);
    y.push_back(i.state.column_displacement[top].y);
  }
};

}  // namespace

TEST_CASE("A5 layer with tied sides: amplification against the transfer function") {
  const CaseResult r = run_case(kMaterials + grid_of(2, 15) + base_of(kOutcropX) + kTied + kMonitors);
  const auto &t = r.column("t [s]"), &v = r.column("middle.velocity_x");
  std::vector<double> in;
  for (const double x : t) in.push_back(outcrop(x));
  for (const double f : {1.0, 2.0, 2.5, 4.0, 5.0, 6.0}) {
    const double kh = 2 * std::numbers::pi * f * kHeight / kShear;
    const double exact = 1 / std::abs(std::complex<double>(std::cos(kh), 0.2 * std::sin(kh)));
    // 15 rows are 25 to a wavelength at 6 Hz: waves run 0.3 % too fast there
    check_close(fmt::format("A5 amplification at {} Hz", f), std::abs(fourier(t, v, f) / fourier(t, in, f)),
                exact, 2e-2, 5e-3);
  }
  check_below("A5 tied sides: surface against the ray series", misfit(v, exact_curve(t)), 2e-2, 5e-3);
  check_below("A5 tied sides: corner against middle", misfit(r.column("corner.velocity_x"), v), 1e-2, 1e-9);
  check_below("A5 tied sides: energy left over / largest term", r.run.closure(), 1e-2, 1e-9);
}

TEST_CASE("A5 free-field sides: the block model moves like its columns, S and P" *
          doctest::test_suite("optimised")) {
  for (const bool up : {false, true}) {
    const std::string motion = up ? "velocity_y = \"ricker\"\nmotion = \"outcrop\"\n" : kOutcropX;
    ColumnTop top;
    const CaseResult r =
        run_case(kMaterials + grid_of(8, 10) + base_of(motion) + sides_of("free_field") + kMonitors, {},
                 std::ref(top));
    const std::string axis = up ? "y" : "x";
    const auto &t = r.column("t [s]"), &v = r.column("middle.velocity_" + axis);
    // 10 rows: 13 to a wavelength at 7.5 Hz
    check_below("A5 free field, " + axis + ": surface against the ray series",
                misfit(v, exact_curve(t, up ? kRatio : 1)), 2e-2, 1e-2);
    // the same equations, but for turns of 1e-5 of the blocks
    check_below("A5 free field, " + axis + ": corner against middle",
                misfit(r.column("corner.velocity_" + axis), v), 1e-2, 1e-5);
    check_below("A5 free field, " + axis + ": block model against column",
                misfit(r.column("middle.displacement_" + axis), up ? top.y : top.x), 1e-2, 1e-5);
    check_below("A5 free field, " + axis + ": energy left over / largest term", r.run.closure(), 1e-2, 1e-9);
  }
}

TEST_CASE("A5 free-field sides with implicit elasticity: one equation for blocks and columns at any step" *
          doctest::test_suite("optimised")) {
  // the limit of explicit columns is 6.7 ms (S) and 3.8 ms (P, which they feel as well)
  for (const bool up : {false, true}) {
    const std::string motion = up ? "velocity_y = \"ricker\"\nmotion = \"outcrop\"\n" : kOutcropX;
    const std::string axis = up ? "y" : "x";
    // damping of 0.5 ms is that of blocks and columns alike; the ray series knows none
    for (const auto& [dt, damping] : {std::pair{2e-3, 0.0}, {10e-3, 0.0}, {2e-3, 5e-4}}) {
      ColumnTop top;
      const CaseResult r =
          run_case(kMaterials + grid_of(8, 10) + base_of(motion) + sides_of("free_field") + kMonitors,
                   {"stage.shake.elasticity=implicit", fmt::format("stage.shake.time_step={} s", dt),
                    "contact.alpha=0", fmt::format("new:stage.shake.damping_stiffness={} s", damping)},
                   std::ref(top));
      const auto &t = r.column("t [s]"), &v = r.column("middle.velocity_" + axis);
      const std::string name = fmt::format("A5 implicit free field, {}, {:g} ms{}: ", axis, 1e3 * dt,
                                           damping > 0 ? ", damped" : "");
      // alpha = 0 is of second order: w dt = 0.47 at 7.5 Hz and 10 ms, periods longer by (w dt)^2 / 12
      if (damping == 0)
        check_below(name + "surface against the ray series", misfit(v, exact_curve(t, up ? kRatio : 1)),
                    dt > 5e-3 ? 4e-2 : 2e-2, 1e-2);
      check_below(name + "corner against middle", misfit(r.column("corner.velocity_" + axis), v), 1e-5, 1e-6);
      check_below(name + "block model against column",
                  misfit(r.column("middle.displacement_" + axis), up ? top.y : top.x), 1e-5, 1e-6);
      check_below(name + "energy left over / largest term", r.run.closure(), 1e-9, 1e-12);
    }
  }
}

TEST_CASE("free field under a viscous top: the wave passes once") {
  ColumnTop top;
  std::string base = base_of(kOutcropX);
  base.replace(base.find("\"rock\""), 6, "\"soil\"");
  const CaseResult r =
      run_case(kMaterials + grid_of(4, 15) + base + sides_of("free_field") + kMonitors +
                   "[[boundary]]\nname = \"top\"\nkind = \"viscous\"\nedge = [[0, 30], [24, 30]]\n",
               {}, std::ref(top));
  std::vector<double> exact;
  for (const double t : r.column("t [s]")) exact.push_back(0.5 * outcrop(t - kHeight / kShear));
  // half of the outcrop motion goes up and nothing comes back; 15 rows: 20 to a wavelength at 7.5 Hz
  check_below("viscous top: motion there against the upgoing wave",
              misfit(r.column("middle.velocity_x"), exact), 2e-2, 5e-3);
  check_below("viscous top: corner against middle",
              misfit(r.column("corner.velocity_x"), r.column("middle.velocity_x")), 1e-2, 1e-5);
  check_below("viscous top: block model against column", misfit(r.column("middle.displacement_x"), top.x),
              1e-2, 1e-5);
}

TEST_CASE("A5 upgoing and outcrop motion differ by two, viscous sides visibly fail") {
  const CaseResult out = run_case(kMaterials + grid_of(4, 10) + base_of(kOutcropX) + kTied + kMonitors);
  const CaseResult up =
      run_case(kMaterials + grid_of(4, 10) + base_of("velocity_x = \"ricker\"\nmotion = \"upgoing\"\n") +
               kTied + kMonitors);
  const auto largest = [](const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()); };
  // linear but for turns of 1e-5, and an iterative solver's tolerance
  check_close("upgoing / outcrop",
              largest(up.column("middle.velocity_x")) / largest(out.column("middle.velocity_x")), 2, 1e-6,
              1e-7);
  const CaseResult viscous =
      run_case(kMaterials + grid_of(4, 10) + base_of(kOutcropX) + sides_of("viscous") + kMonitors);
  const auto& t = viscous.column("t [s]");
  check_above("viscous sides: misfit to level ground",
              misfit(viscous.column("middle.velocity_x"), exact_curve(t)), 0.1, 0.5);
}

TEST_CASE("A5 free-field sides that lean: traction by their true normals") {
  // a parallelogram of ground, cut along its bedding and along its sides
  const std::string cut = R"toml(
[cut]
sliver_area = 0
[[region]]
name = "ground"
polygon = [[0, 0], [24, 0], [32, 30], [8, 30]]
sides = ["base", "right", "top", "left"]
material = "soil"
joint = "glue"
[[joint_set]]
name = "bedding"
angle = 0
spacing = 3
joint = "glue"
[[joint_set]]
name = "steep"
angle = "75.06858282 deg"
spacing = 4.831
joint = "glue"
)toml";
  for (const bool up : {false, true}) {
    const std::string axis = up ? "y" : "x";
    const std::string text = kMaterials + cut +
                             fmt::format(
                                 "[[boundary]]\nname = \"base\"\nkind = \"viscous\"\nalong = "
                                 "\"base\"\nmaterial = \"rock\"\nvelocity_{} = "
                                 "\"ricker\"\nmotion = \"outcrop\"\n",
                                 axis) +
                             "[[boundary]]\nname = \"left\"\nkind = \"free_field\"\nalong = \"left\"\n"
                             "[[boundary]]\nname = \"right\"\nkind = \"free_field\"\nalong = \"right\"\n"
                             "[[monitor]]\nname = \"middle\"\npoint = [20, 29.99]\n[[monitor]]\nname = "
                             "\"corner\"\npoint = [8.1, 29.99]\n";
    const CaseResult r = run_case(text);
    const auto &t = r.column("t [s]"), &v = r.column("middle.velocity_" + axis);
    check_below("A5 leaning sides, " + axis + ": corner against middle",
                misfit(r.column("corner.velocity_" + axis), v), 1e-2, 1e-3);
    check_below("A5 leaning sides, " + axis + ": surface against the ray series",
                misfit(v, exact_curve(t, up ? kRatio : 1)), 2e-2, 1e-2);
  }
}

TEST_CASE(
    "A5 free field after a static stage: the weight stays on the kept reactions, the motion is the same") {
  std::string sides = sides_of("free_field");
  for (size_t at = 0; (at = sides.find("edge", at)) != std::string::npos; at += 30)
    sides.insert(at, "static = \"roller\"\n");
  const std::string rest = "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = \"30 s\"\n";
  std::string text = kMaterials + grid_of(4, 10) + base_of(kOutcropX) + sides + kMonitors;
  text.insert(text.find("[[stage]]"), rest + "[model]\ngravity = [0, -10]\n");
  std::vector<double> v, exact;
  double sideways = 0;
  const CaseResult r = run_case(text, {}, [&](const Instant& i) {
    if (i.stage != 1) return;
    const int top = block_of_point(i.scene.layout, {12, 30});
    v.push_back(velocity_at(rate_now(i.work, i.state, top), Vec2{12, 30} - i.scene.blocks.centroid[top]).x);
    exact.push_back(ray_series(i.state.history_time, 1));
    sideways = std::max(sideways, std::abs(rate_now(i.work, i.state, top).a.y));
  });
  check_below("A5 under gravity: surface against the ray series", misfit(v, exact), 2e-2, 1e-2);
  // what the static stage leaves unbalanced, 1e-5 of the weight; all of it would fall at rho g H / (rho_r cp)
  // = 0.1 m/s
  check_below("A5 under gravity: vertical velocity [m/s]", sideways, 1e-4, 1e-5);
  check_below("A5 under gravity: energy left over / largest term", r.run.closure(), 1e-2, 1e-9);
}

TEST_CASE("A5 rigid base and body force: free-field columns take the same input as the blocks") {
  // a base that moves with v(t); and the frame of that base, where a body force -dv/dt acts
  const std::string text = kMaterials + grid_of(4, 10) + sides_of("free_field") + kMonitors;
  const std::string base = "[[support]]\nname = \"base\"\nedge = [[0, 0], [24, 0]]\n";
  ColumnTop rigid, relative;
  const CaseResult a = run_case(text + base + "x = { velocity = \"ricker\" }\n", {}, std::ref(rigid));
  const CaseResult b = run_case(
      text + base +
          "[history.inertia]\nexpression = "
          "\"1e-3*(6*(_pi*2.5)^2*(t-0.8)-4*(_pi*2.5)^4*(t-0.8)^3)*exp(-(_pi*2.5*(t-0.8))^2)\"\n"
          "duration = \"4 s\"\nsamples = 40000\n[[load]]\nname = \"shake\"\nacceleration_x = \"inertia\"\n",
      {}, std::ref(relative));
  check_below("rigid base: corner against middle",
              misfit(a.column("corner.displacement_x"), a.column("middle.displacement_x")), 1e-2, 1e-5);
  check_below("rigid base: block model against column", misfit(a.column("middle.displacement_x"), rigid.x),
              1e-2, 1e-5);
  check_below("body force: block model against column", misfit(b.column("middle.displacement_x"), relative.x),
              1e-2, 1e-5);
  // relative motion plus that of the base is the whole: step by step the same sums, but for the force at an
  // instant against the velocity between two (4e-4)
  std::vector<double> sum, base_motion;
  for (size_t i = 0; i < a.column("t [s]").size(); ++i) {
    const double t = a.column("t [s]")[i], s = t - kPeak, w2 = std::pow(std::numbers::pi * kRicker, 2);
    base_motion.push_back(1e-3 * (s * std::exp(-w2 * s * s) + kPeak * std::exp(-w2 * kPeak * kPeak)));
    sum.push_back(b.column("middle.displacement_x")[i] + base_motion.back());
  }
  check_below("body force and rigid base: the same motion", misfit(sum, a.column("middle.displacement_x")),
              1e-2, 1e-3);
}

TEST_CASE("free field of jointed ground: compliances of joints spread over the column") {
  // every face opens and slips elastically, none breaks; shear then runs at 0.79 of its speed in whole soil
  const std::string soft =
      "[joint.soft]\nnormal_stiffness = \"2 GPa/m\"\nshear_stiffness = \"200 MPa/m\"\ncohesion = \"1 "
      "GPa\"\ntensile_strength = \"1 GPa\"\n";
  for (const bool up : {false, true}) {
    std::string grid = grid_of(8, 10);
    grid.replace(grid.find("\"glue\""), 6, "\"soft\"");
    const std::string axis = up ? "y" : "x";
    ColumnTop top;
    const CaseResult r = run_case(kMaterials + soft + grid +
                                      base_of("velocity_" + axis + " = \"ricker\"\nmotion = \"outcrop\"\n") +
                                      sides_of("free_field") + kMonitors,
                                  {"contact.alpha=0"}, std::ref(top));
    const auto& u = r.column("middle.displacement_" + axis);
    // ten joints seen as one medium: the wave of 40 m is 13 joints long
    check_below("A5 jointed free field, " + axis + ": corner against middle",
                misfit(r.column("corner.displacement_" + axis), u), 5e-2, 1e-2);
    check_below("A5 jointed free field, " + axis + ": block model against column",
                misfit(u, up ? top.y : top.x), 5e-2, 1e-2);
  }
}

TEST_CASE("level_response is the transfer function of a layer, and of two halves of it") {
  const double modulus = kDensity * kShear * kShear, z = kRockDensity * kRockShear;
  for (const double f : {1.0, 2.0, 2.5, 4.0, 6.0, 8.0}) {
    const double kh = 2 * std::numbers::pi * f * kHeight / kShear;
    const double exact = 1 / std::abs(std::complex<double>(std::cos(kh), 0.2 * std::sin(kh)));
    const LayerResponse one = level_response({{kHeight, kDensity, modulus}}, z, f);
    const LayerResponse two = level_response({{12, kDensity, modulus}, {18, kDensity, modulus}}, z, f);
    CHECK(std::abs(one.surface - exact) < 1e-12);
    CHECK(std::abs(one.base - exact * std::abs(std::cos(kh))) < 1e-12);
    CHECK(std::abs(two.surface - exact) < 1e-12);
  }
  CHECK(std::abs(level_response({{kHeight, kDensity, modulus}}, z, 2.5).surface - 5) <
        1e-9);  // 1 / impedance ratio
}

TEST_CASE(
    "A5 monitor relative to a free field: of level ground nothing, of a built-up one what the building "
    "adds") {
  const std::string at = "point = [12, 30]\n";
  const std::string relative =
      "[[monitor]]\nname = \"moved\"\n" + at + "[[monitor]]\nname = \"apart\"\n" + at +
      "relative_to = \"left\"\n[[monitor]]\nname = \"deep\"\npoint = [12, 12.7]\nrelative_to = \"left\"\n";
  const std::string ground = kMaterials + grid_of(2, 15) + base_of(kOutcropX);
  const CaseResult level = run_case(ground + sides_of("free_field") + relative, {"stage.shake.duration=2"});
  const auto largest = [](const std::vector<double>& v) {
    double most = 0;
    for (const double x : v) most = std::max(most, std::abs(x));
    return most;
  };
  // level ground and its column obey the same equations, at a node (the surface) and between two (12.7 m)
  for (const char* column : {"velocity_x", "displacement_x"}) {
    const double scale = largest(level.column(fmt::format("moved.{}", column)));
    for (const char* name : {"apart", "deep"})
      check_below(fmt::format("A5 level ground, {}.{} / largest", name, column),
                  largest(level.column(fmt::format("{}.{}", name, column))) / scale, 1e-5, 1e-6);
  }

  // A tower on the ground shakes it; the free field at the side knows nothing of it. What the monitor takes
  // off must be the motion of level ground, from a run of its own.
  const std::string tower =
      "[[block]]\nname = \"tower\"\npolygon = [[6, 30], [18, 30], [18, 40], [6, 40]]\nmaterial = \"soil\"\n"
      "[contact]\njoint = \"glue\"\n";
  const double dt = level.column("t [s]")[1] - level.column("t [s]")[0];
  const CaseResult built =
      run_case(ground + tower + sides_of("free_field") + relative,
               {"stage.shake.duration=2", fmt::format("stage.shake.time_step={:.17g}", dt)});
  const auto &all = built.column("moved.velocity_x"), &apart = built.column("apart.velocity_x");
  REQUIRE(all.size() == level.column("moved.velocity_x").size());
  std::vector<double> taken_off;
  for (size_t i = 0; i < all.size(); ++i) taken_off.push_back(all[i] - apart[i]);
  check_below("A5 what the monitor takes off, against level ground",
              misfit(taken_off, level.column("moved.velocity_x")), 1e-5, 1e-6);
  check_above("A5 the tower's share, largest relative / largest velocity", largest(apart) / largest(all), 0.1,
              0.1);
}

}  // namespace test_site_response
