// Turning the whole model by 37 degrees or moving it by 1 km changes nothing but the frame of the results;
// Newton and Gauss-Seidel agree; a bonded partition of any polygons reproduces affine deformation (A6b).

#include <numbers>

#include "support/box_polygon.h"
#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_frames {

using namespace talus;
using namespace talus::test;

namespace {

// A frame: points and vectors as the model file gives them.
struct Frame {
  double angle = 0;
  Vec2 shift;
  Vec2 turn(Vec2 v) const {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * v.x - s * v.y, s * v.x + c * v.y};
  }
  std::string point(Vec2 v) const {
    const Vec2 p = turn(v) + shift;
    return fmt::format("[{:.17g}, {:.17g}]", p.x, p.y);
  }
  std::string vector(Vec2 v) const { return fmt::format("[{:.17g}, {:.17g}]", turn(v).x, turn(v).y); }
  std::string polygon(const Polygon& p) const {
    std::string out;
    for (const Vec2 v : p) out += (out.empty() ? "[" : ", ") + point(v);
    return out + "]";
  }
};

// Deformable and rigid blocks that fall, tilt, slide, and press on an elastic joint: every kind of row.
// Contacts are statically determinate or compliant, so that single forces are unique.
std::string scene_text(const Frame& f, const std::string& solver) {
  std::string out = fmt::format(R"(
talus = 1
[model]
gravity = {}
[material.m]
density = 2000
young = "50 MPa"
poisson = 0.2
[joint.rough]
friction_angle = "25 deg"
normal_stiffness = "0.5 GPa/m"
shear_stiffness = "0.3 GPa/m"
[joint.smooth]
friction_angle = "5 deg"
[joint.glue]
kind = "bonded"
[contact]
joint = "rough"
[solver]
method = "{}"
tolerance = 1e-11
[[contact_pair]]
between = ["floor", "ball"]
joint = "smooth"
[[contact_pair]]
between = ["left", "right"]
joint = "glue"
)",
                                f.vector({1, -9.81}), solver);
  const auto block = [&](const std::string& name, const Polygon& p, const std::string& kind,
                         const std::string& more = "") {
    out += fmt::format("[[block]]\nname = \"{}\"\npolygon = {}\nmaterial = \"m\"\nkind = \"{}\"\n{}\n", name,
                       f.polygon(p), kind, more);
  };
  block("floor", box_polygon(-3, -1, 9, 0), "fixed");
  block("left", box_polygon(0, 0.001, 1, 1), "deformable");
  block("right", {{1, 0.001}, {2.2, 0.001}, {2, 1}, {1, 1}}, "deformable");
  block("rigid", {{0.5, 1.002}, {1.7, 1.002}, {1.6, 1.7}, {0.6, 1.6}}, "rigid", "spin = \"0.3 rad/s\"");
  block("ball", {{4, 0.05}, {4.5, 0.3}, {4.4, 0.8}, {3.8, 0.9}, {3.5, 0.5}}, "rigid",
        "velocity = " + f.vector({1, 0}));
  out +=
      "[[stage]]\nname = \"run\"\nkind = \"dynamic\"\nduration = 0.25\ntime_step = 1e-3\ndamping_mass = \"2 "
      "1/s\"\n";
  for (const char* name : {"left", "right"})
    out += fmt::format("[[monitor]]\nname = \"s_{0}\"\nblock = \"{0}\"\n", name);
  out += fmt::format("[[monitor]]\nname = \"p\"\npoint = {}\n[[monitor]]\nname = \"q\"\npoint = {}\n",
                     f.point({1.5, 0.9}), f.point({4, 0.5}));
  out +=
      "[[monitor]]\nname = \"f\"\ncontact = [\"left\", \"floor\"]\nwindow = 0.01\n[[monitor]]\nname = "
      "\"g\"\ncontact = [\"ball\", \"floor\"]\n[[monitor]]\nname = \"h\"\ncontact = [\"rigid\", \"left\"]\n";
  return out;
}

// Columns of a run, vectors and stresses turned back into the frame of the first.
std::vector<std::vector<double>> turned_back(const CaseResult& r, const Frame& f) {
  auto values = r.table.values;
  const auto& columns = r.table.columns;
  const double c = std::cos(f.angle), s = std::sin(f.angle);
  for (size_t i = 0; i + 1 < columns.size(); ++i) {
    if (columns[i].find("stress_xx") != std::string::npos) {
      for (size_t n = 0; n < values[i].size(); ++n) {
        const Mat2 R{c, -s, s, c}, S{values[i][n], values[i + 2][n], values[i + 2][n], values[i + 1][n]};
        const Mat2 T = transpose(R) * S * R;
        values[i][n] = T.xx, values[i + 1][n] = T.yy, values[i + 2][n] = T.xy;
      }
    } else if (columns[i].find("_x [") != std::string::npos) {
      for (size_t n = 0; n < values[i].size(); ++n) {
        const double x = values[i][n], y = values[i + 1][n];
        values[i][n] = c * x + s * y, values[i + 1][n] = -s * x + c * y;
      }
    }
  }
  return values;
}

double largest(const std::vector<double>& v) {
  double m = 0;
  for (const double x : v) m = std::max(m, std::abs(x));
  return m;
}

}  // namespace

TEST_CASE("frames: a model turned by 37 degrees or moved by 1 km gives the same results") {
  const CaseResult base = run_case(scene_text({}, "newton"));
  const auto reference = turned_back(base, {});
  const double turn = 37 * std::numbers::pi / 180;
  for (const auto& [name, frame] :
       {std::pair("turned by 37 deg", Frame{turn, {}}), std::pair("moved by 1 km", Frame{0, {1000, -700}}),
        std::pair("turned and moved", Frame{turn, {1000, 1000}})}) {
    const CaseResult r = run_case(scene_text(frame, "newton"));
    const auto values = turned_back(r, frame);
    double worst = 0;
    std::string where;
    for (size_t c = 0; c < values.size(); ++c) {
      // a vector's component may be zero in one frame: measured by the larger of the two components
      const bool x = base.table.columns[c].find("_x [") != std::string::npos,
                 y = base.table.columns[c].find("_y [") != std::string::npos;
      double scale = largest(reference[c]);
      if (x) scale = std::max(scale, largest(reference[c + 1]));
      if (y) scale = std::max(scale, largest(reference[c - 1]));
      if (scale == 0) continue;
      for (size_t n = 0; n < values[c].size(); ++n) {
        const double difference = std::abs(values[c][n] - reference[c][n]) / scale;
        if (difference > worst) worst = difference, where = base.table.columns[c];
      }
    }
    INFO("worst column: ", where);
    check_below(fmt::format("frames: {}, largest difference of any column", name), worst, 1e-6, 1e-9);
    // the physical numbers of summary.json; solver errors and what the ledger leaves over are round-off in
    // each frame
    const Energy &e = r.run.energy, &f = base.run.energy;
    const std::pair<double, double> numbers[] = {
        {e.kinetic, f.kinetic},
        {e.strain, f.strain},
        {e.gravity, f.gravity},
        {e.work[Cause::kJoints], f.work[Cause::kJoints]},
        {e.work[Cause::kFriction], f.work[Cause::kFriction]},
        {e.work[Cause::kDamping], f.work[Cause::kDamping]},
        {e.work[Cause::kContactClosing], f.work[Cause::kContactClosing]},
        {r.run.largest_energy, base.run.largest_energy},
        {r.run.deepest_drift, base.run.deepest_drift}};
    double worst_number = 0;
    for (const auto& [here, there] : numbers)
      if (there != 0) worst_number = std::max(worst_number, std::abs(here / there - 1));
    check_below(fmt::format("frames: {}, largest difference of a number of summary.json", name), worst_number,
                1e-6, 1e-9);
    CHECK(r.run.steps == base.run.steps);
    CHECK(r.run.broken_faces == base.run.broken_faces);
    CHECK(r.run.most_contacts == base.run.most_contacts);
  }
  check_below("frames: energy left over / largest term", base.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("newton and gauss_seidel agree") {
  const CaseResult a = run_case(scene_text({}, "newton")), b = run_case(scene_text({}, "gauss_seidel"));
  CHECK(a.run.second_solver_steps == 0);
  CHECK(b.run.second_solver_steps == 0);
  double worst = 0;
  for (size_t c = 1; c < a.table.values.size(); ++c) {
    const double scale = largest(a.table.values[c]);
    for (size_t n = 0; n < a.table.values[c].size() && scale > 1e-9; ++n)
      worst = std::max(worst, std::abs(a.table.values[c][n] - b.table.values[c][n]) / scale);
  }
  // the tolerance of 1e-11 of the block size a step, in forces p/dt: 1e-11 m x m/dt^2 = 0.02 N of 1e4 N, 250
  // steps
  check_below("newton against gauss_seidel, largest difference of any column", worst, 1e-3, 1e-6);
}

TEST_CASE("A6b patch test: a bonded partition of any polygons deforms as one affine body") {
  // five cells of the unit square, one of them not convex, with an inner corner at (0.4, 0.55)
  const std::vector<Polygon> cells = {{{0, 0}, {0.6, 0}, {0.4, 0.55}, {0, 0.3}},
                                      {{0.6, 0}, {1, 0}, {1, 0.7}, {0.4, 0.55}},
                                      {{1, 0.7}, {1, 1}, {0.7, 1}, {0.4, 0.55}},
                                      {{0.7, 1}, {0, 1}, {0, 0.8}, {0.3, 0.75}, {0.4, 0.55}},
                                      {{0, 0.3}, {0.4, 0.55}, {0.3, 0.75}, {0, 0.8}}};
  const Mat2 A{1e-4, 3e-5, -2e-5, -5e-5};  // displacement gradient; a turn of -2.5e-5 rad and strain
  std::string text =
      "talus = 1\n[material.m]\ndensity = 2000\nyoung = \"1 GPa\"\npoisson = 0.3\n[joint.glue]\nkind = "
      "\"bonded\"\n[contact]\njoint = \"glue\"\n";
  for (size_t i = 0; i < cells.size(); ++i) {
    text += fmt::format("[[block]]\nname = \"c{}\"\nmaterial = \"m\"\npolygon = [", i);
    for (const Vec2 v : cells[i]) text += fmt::format("[{},{}],", v.x, v.y);
    text += fmt::format("]\n[[monitor]]\nname = \"c{0}\"\nblock = \"c{0}\"\n", i);
  }
  int n = 0;
  for (const Vec2 v : {Vec2{0, 0}, Vec2{0.6, 0}, Vec2{1, 0}, Vec2{1, 0.7}, Vec2{1, 1}, Vec2{0.7, 1},
                       Vec2{0, 1}, Vec2{0, 0.8}, Vec2{0, 0.3}}) {
    const Vec2 u = A * v;
    text += fmt::format(
        "[history.x{0}]\ntime = [0, 0.02]\nvalue = [0, {1:.17g}]\n[history.y{0}]\ntime = [0, 0.02]\nvalue = "
        "[0, {2:.17g}]\n",
        n, u.x, u.y);
    text += fmt::format(
        "[[support]]\nname = \"s{0}\"\npoint = [{1}, {2}]\nx = {{ displacement = \"x{0}\" }}\ny = {{ "
        "displacement = \"y{0}\" }}\n",
        n++, v.x, v.y);
  }
  text += "[[stage]]\nname = \"run\"\nkind = \"dynamic\"\nduration = 0.06\n";
  // penalty springs damp by the share of the velocity that goes on
  text += other_formulation() == "penalty" ? "[penalty]\ndynamic_factor = 0.5\n"
                                           : "damping_mass = \"4000 1/s\"\n";
  for (const std::string solver : {"newton", "gauss_seidel"}) {
    const CaseResult r = run_case(text, {"solver.method=\"" + solver + "\"", "solver.tolerance=1e-12"});
    // strain of the finite deformation: U - I of F = I + A; stress by the law; all cells alike
    const PlaneModuli c = plane_moduli(1e9, 0.3, Plane::kStrain);
    const Mat2 F = kIdentity + A, P = piola_stress(c, A);
    const Mat2 sigma = (1 / det(F)) * (P * transpose(F));
    const double scale = std::sqrt(contract(sigma, sigma));
    double worst = 0;
    for (size_t i = 0; i < cells.size(); ++i) {
      worst = std::max(worst, std::abs(r.column(fmt::format("c{}.stress_xx", i)).back() - sigma.xx) / scale);
      worst = std::max(worst, std::abs(r.column(fmt::format("c{}.stress_yy", i)).back() - sigma.yy) / scale);
      worst = std::max(worst, std::abs(r.column(fmt::format("c{}.stress_xy", i)).back() - sigma.xy) / scale);
    }
    // Gauss-Seidel leaves 1e-12 of the block size, 1e-8 of a strain of 1e-4
    check_below("A6b " + solver + ": stress of every cell against the affine one", worst,
                solver == "newton" ? 1e-8 : 1e-6, 1e-12);
    check_below("A6b energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
  }
}

}  // namespace test_frames
