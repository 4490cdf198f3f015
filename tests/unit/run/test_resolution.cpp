// Blocks per wavelength: the highest frequency of a history, the slowest wave, the line and the warning.

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "support/run_case.h"
#include "talus/base/index.h"
#include "talus/record/measures.h"
#include "talus/record/read_record.h"
#include "talus/run/resolution.h"

namespace test_resolution {

using namespace talus;

namespace {

constexpr double kPi = std::numbers::pi, kMain = 2.5, kPeak = 0.8;  // Ricker wavelet [Hz], [s]

History history(double duration, int samples, const std::function<double(double)>& value) {
  History h;
  for (int i = 0; i <= samples; ++i) {
    h.time.push_back(duration * i / samples);
    h.value.push_back(value(h.time.back()));
  }
  return h;
}

// Frequency below which 99.9 % of |V|^2 of a Ricker wavelet lies: V = (f/f0)^2 exp(-(f/f0)^2), summed.
double ricker_highest() {
  const double df = 1e-4;
  const auto density = [](double f) {
    return std::pow(f / kMain, 4) * std::exp(-2 * std::pow(f / kMain, 2));
  };
  double whole = 0, sum = 0, f = 0;
  for (double x = 0; x < 40; x += df) whole += density(x);
  for (; sum < 0.999 * whole; f += df) sum += density(f);
  return f;
}

// A row of soil blocks, 2 m each, on a base that moves with "wave".
std::string row_of(int cells, const std::string& joint = "kind = \"bonded\"",
                   const std::string& kind = "dynamic") {
  return fmt::format(R"toml(talus = 1
[material.soil]
density = 2000
young = "450 MPa"
poisson = 0.25
[joint.glue]
{}
[history.wave]
expression = "1e-3*(1-2*(_pi*2.5*(t-0.8))^2)*exp(-(_pi*2.5*(t-0.8))^2)"
duration = "4 s"
[[grid]]
name = "layer"
min = [0, 0]
max = [6, 24]
cells = [{}, {}]
material = "soil"
joint = "glue"
[[support]]
name = "base"
edge = [[0, 0], [6, 0]]
x = {{ velocity = "wave" }}
[[stage]]
name = "shake"
kind = "{}"
duration = "1 s"
)toml",
                     joint, cells, 4 * cells, kind);
}

struct Checked {
  std::vector<Resolution> list;
  std::string report, warnings;
};

Checked check_of(const std::string& text) {
  Findings findings("m.toml", text);
  const PreparedRun run = prepare_run("m.toml", text, {}, findings);
  return {resolutions(run.scene), resolution_report(run.scene), findings.render()};
}

}  // namespace

TEST_CASE("highest frequency of a history: that of its velocity, whatever it gives") {
  const double exact = ricker_highest(), w = kPi * kMain;
  const History velocity = history(4, 2000, [w](double t) {
    const double s = w * (t - kPeak);
    return (1 - 2 * s * s) * std::exp(-s * s);
  });
  const History acceleration = history(4, 2000, [w](double t) {
    const double s = w * (t - kPeak);
    return w * (4 * s * s * s - 6 * s) * std::exp(-s * s);
  });
  const History displacement = history(4, 2000, [w](double t) {
    const double s = w * (t - kPeak);
    return (t - kPeak) * std::exp(-s * s);
  });
  // lines of the spectrum are 1/4 Hz apart
  CHECK(std::abs(highest_frequency(velocity, InputKind::kVelocity) - exact) < 0.25);
  CHECK(std::abs(highest_frequency(velocity, InputKind::kForce) - exact) < 0.25);
  CHECK(std::abs(highest_frequency(acceleration, InputKind::kAcceleration) - exact) < 0.25);
  CHECK(std::abs(highest_frequency(displacement, InputKind::kDisplacement) - exact) < 0.25);
  CHECK(highest_frequency(acceleration, InputKind::kVelocity) > exact + 0.25);  // it is not the velocity's
}

TEST_CASE("highest frequency of a record as history is the one that talus record tells") {
  const record::Record file =
      record::read_record(std::string(TALUS_SOURCE_DIR) + "/examples/record/motion.csv");
  const record::Motion motion = record::integrate(record::acceleration_of(file), file.dt);
  const double told = record::highest_frequency(motion);
  const auto as_history = [&](const std::vector<double>& values) {
    return history(motion.duration(), count_of(motion) - 1,
                   [&](double t) { return values[std::lround(t / motion.dt)]; });
  };
  CHECK(std::abs(highest_frequency(as_history(motion.velocity), InputKind::kVelocity) - told) < 1e-9);
  CHECK(std::abs(highest_frequency(as_history(motion.acceleration), InputKind::kAcceleration) - told) < 1e-9);
  // central differences over 2 x 0.01 s take 10 % off 9 Hz: it seems lower by a few lines
  CHECK(std::abs(highest_frequency(as_history(motion.displacement), InputKind::kDisplacement) - told) < 0.5);
}

TEST_CASE("highest frequency: what is held at the end is no jump, what never changes no wave") {
  const auto rise = [](double t) { return t < 0.5 ? 0.5 * (1 - std::cos(2 * kPi * t)) : 1; };
  // rises within 0.5 s: the waves of a rise lie below some 2/0.5 s, however soon the table ends behind it
  for (const double end : {0.5, 0.7, 4.0}) {
    const double f = highest_frequency(history(end, 1000, rise), InputKind::kVelocity);
    CHECK(f > 0.5);
    CHECK(f < 4);
  }
  CHECK(highest_frequency(history(1, 10, [](double) { return 3; }), InputKind::kVelocity) == 0);
  CHECK(highest_frequency(history(1, 10, [](double) { return 0; }), InputKind::kAcceleration) == 0);
  CHECK(highest_frequency(history(1, 10, [](double t) { return 0.1 * t; }), InputKind::kDisplacement) == 0);
  // three points make a triangle: 99.9 % of sinc^4(f/10) lies below 10 Hz x 1.0
  History triangle;
  triangle.time = {0, 0.1, 0.2}, triangle.value = {0, 1, 0};
  const double f = highest_frequency(triangle, InputKind::kForce);
  CHECK(f > 8);
  CHECK(f < 16);
}

TEST_CASE("slowest wave: shear in whole rock, softened across joints of any direction") {
  const double young = 10e9, nu = 0.25, density = 2500, shear = young / (2 * (1 + nu));
  const PlaneModuli rock = plane_moduli(young, nu, Plane::kStrain);
  const auto speed = [&](const std::vector<JointsOfRock>& joints) {
    return slowest_wave({density, jointed_stiffness(rock, joints)});
  };
  CHECK(std::abs(speed({}) / std::sqrt(shear / density) - 1) < 1e-12);
  // springs in a row along the normal: 1/G + frequency/ks
  const double ks = 2e9, frequency = 0.5, soft = 1 / (1 / shear + frequency / ks);
  for (const double degrees : {0.0, 90.0, 30.0, 137.0}) {
    const double a = degrees * kPi / 180;
    CHECK(std::abs(speed({{{std::cos(a), std::sin(a)}, frequency, 0, ks}}) / std::sqrt(soft / density) - 1) <
          1e-9);
  }
}

TEST_CASE("resolution: blocks per wavelength, the line of check and the warning") {
  const double exact_2 = 300 / (ricker_highest() * 2);  // cs / (f h), h = 2 m
  const Checked fine = check_of(row_of(3));
  REQUIRE(fine.list.size() == 1);
  // a line of the spectrum in 5.4 Hz
  CHECK(std::abs(fine.list[0].per_wavelength / exact_2 - 1) < 0.05);
  CHECK(std::abs(fine.list[0].speed - 300) < 1e-9);
  CHECK(std::abs(fine.list[0].size - 2) < 1e-12);
  CHECK(fine.warnings == "");
  CHECK(fine.report.find("\"wave\": 99.9 % of its |V(f)|^2 below") != std::string::npos);
  CHECK(fine.report.find("slowest wave 300 m/s through blocks of 2 m (layer[") != std::string::npos);

  const Checked coarse = check_of(row_of(1));
  REQUIRE(coarse.list.size() == 1);
  CHECK(std::abs(coarse.list[0].per_wavelength / (exact_2 / 3) - 1) < 0.05);
  INFO(coarse.warnings);
  CHECK(coarse.warnings.find("m.toml:8:10: warning: history.wave: its waves are cut short: 8.") !=
        std::string::npos);
  CHECK(coarse.warnings.find("use blocks of at most 5.") != std::string::npos);

  // both sets of joints, 2 m apart, add to the shear: from 180 to 1/(1/180 + 2/(2 x 50)) MPa
  const Checked jointed =
      check_of(row_of(3, "normal_stiffness = \"1 GPa/m\"\nshear_stiffness = \"50 MPa/m\""));
  REQUIRE(jointed.list.size() == 1);
  CHECK(std::abs(jointed.list[0].speed - std::sqrt(1e6 / (1 / 180.0 + 0.02) / 2000)) < 1e-6);

  CHECK(check_of(row_of(1, "kind = \"bonded\"", "static")).list.empty());
}

TEST_CASE(
    "resolution: an automatic step of implicit elasticity is a tenth of the shortest period, and is not warned of") {
  // in blocks of 6 m, which a wave crosses two of in 23 ms
  const std::string text = row_of(1) + "elasticity = \"implicit\"\n";
  Findings findings("m.toml", text);
  const double dt = prepare_run("m.toml", text, {}, findings).plans.at(0).dt;
  CHECK(std::abs(dt * ricker_highest() / 0.1 - 1) < 0.05);
  CHECK(findings.render().find("is long for history") == std::string::npos);
  const std::string still = row_of(3) + "elasticity = \"implicit\"\ntime_step = \"50 ms\"\n";
  Findings warned("m.toml", still);
  prepare_run("m.toml", still, {}, warned);
  CHECK(warned.render().find("0.05 s is long for history \"wave\"") != std::string::npos);
}

TEST_CASE(
    "resolution: slivers make elasticity implicit where a hundred steps go into the shortest period, else not") {
  const auto implicit = [](double steps, const std::string& sliver) {
    const double wave = 2 * 2.0 * steps * ricker_highest();  // crosses two blocks of 2 m in a step [m/s]
    std::string text = row_of(3);
    const std::string young = "\"450 MPa\"";
    // c11 = young (1 - nu)/((1 + nu)(1 - 2 nu))
    text.replace(text.find(young), young.size(),
                 fmt::format("{:.17g}", wave * wave * 2000 * 1.25 * 0.5 / 0.75));
    Findings findings("m.toml", text + sliver);
    return prepare_run("m.toml", text + sliver, {}, findings).scene.model.stages.at(0).implicit;
  };
  const std::string sliver =
      "[[block]]\nname = \"sliver\"\npolygon = [[9, 0], [11, 0], [11, 0.05], [9, 0.05]]\nmaterial = \"soil\"\n";
  CHECK(implicit(115, sliver));
  CHECK(!implicit(85, sliver));
  CHECK(!implicit(115, ""));
  // no history at all: what strikes has waves as short as a block
  std::string strikes = row_of(3) + sliver;
  strikes.erase(strikes.find("x = { velocity = \"wave\" }\n"), 26);
  Findings findings("m.toml", strikes);
  CHECK(!prepare_run("m.toml", strikes, {}, findings).scene.model.stages.at(0).implicit);
}

// Their joints: elastic, so that a step of implicit elasticity is 0.9 ms, or hard.
const char *const
    kElastic = "friction_angle = \"30 deg\"\nnormal_stiffness = \"10 GPa/m\"\nshear_stiffness = \"5 GPa/m\"",
    *const kHard = "friction_angle = \"30 deg\"";

StageInput shaken(const std::string& joint, double highest, const std::string& keys = {}) {
  std::string text = row_of(3, joint) + keys;
  const std::string main = "2.5", faster = fmt::format("{:.17g}", kMain * highest / ricker_highest());
  const size_t line = text.find("expression");
  for (size_t at = text.find(main, line); at < text.find("duration", line);
       at = text.find(main, at + faster.size()))
    text.replace(at, main.size(), faster);
  Findings findings("m.toml", text);
  return prepare_run("m.toml", text, {}, findings).scene.model.stages.at(0);
}

TEST_CASE(
    "resolution: blocks that meet and are shaken slowly deform implicitly and are damped, others are not") {
  for (const char* joint : {kElastic, kHard}) {
    CAPTURE(joint);
    const StageInput stage = shaken(joint, 5);
    CHECK(stage.implicit);
    CHECK(stage.damping_stiffness == 0.5e-3);
    CHECK(damping_text(stage) == ", blocks damped by 0.5 ms");
    // 5 % of critical is 31.8 Hz
    CHECK(shaken(joint, 29, "elasticity = \"implicit\"\n").damping_stiffness == 0.5e-3);
    CHECK(shaken(joint, 35, "elasticity = \"implicit\"\n").damping_stiffness == 0);
    CHECK(shaken(joint, 5, "damping_stiffness = \"0 s\"\n").damping_stiffness == 0);
    CHECK(shaken(joint, 5, "damping_stiffness = \"1 ms\"\n").damping_stiffness == 1e-3);
    CHECK(shaken(joint, 5, "elasticity = \"explicit\"\n").damping_stiffness == 0);
  }
  // a hundred steps of 0.9 ms in the shortest period
  CHECK(shaken(kElastic, 10).implicit);
  CHECK(!shaken(kElastic, 13).implicit);
  const StageInput tied = shaken("kind = \"bonded\"", 5);
  CHECK(!tied.implicit);
  CHECK(tied.damping_stiffness == 0);
  // what falls without a history
  std::string text = row_of(3, kHard);
  text.erase(text.find("x = { velocity"), 26);
  Findings findings("m.toml", text);
  const StageInput falls = prepare_run("m.toml", text, {}, findings).scene.model.stages.at(0);
  CHECK(falls.implicit);
  CHECK(falls.damping_stiffness == 0);
  CHECK(damping_text(falls).empty());
}

TEST_CASE("resolution: every way to shake or push is seen, once per history, rigid blocks carry no waves") {
  std::string text = row_of(3);
  const size_t formula = text.find("expression"), line_end = text.find('\n', formula);
  text.replace(formula, line_end - formula, "expression = \"t < 1 ? 1e-3*(1-cos(2*_pi*t)) : 0\"");
  const auto with = [&](const std::string& what) {
    std::string t = text;
    const size_t at = t.find("x = { velocity = \"wave\" }\n");
    return t.replace(at, 26, what);
  };
  for (const char* what :
       {"x = { velocity = \"wave\" }\ny = { displacement = \"wave\" }\n", "x = { displacement = \"wave\" }\n",
        "[[boundary]]\nname = \"side\"\nkind = \"viscous\"\nmotion = \"upgoing\"\n"
        "edge = [[0, 0], [0, 24]]\nvelocity_y = \"wave\"\n",
        "[[load]]\nname = \"shake\"\nacceleration_x = \"wave\"\n",
        "[[load]]\nname = \"blast\"\nedge = [[0, 0], [0, 24]]\npressure = \"wave\"\n",
        "[[load]]\nname = \"rub\"\nedge = [[0, 0], [0, 24]]\ntraction_y = \"wave\"\n",
        "[[load]]\nname = \"hit\"\npoint = [0, 24]\nforce_x = \"wave\"\n"}) {
    INFO(what);
    CHECK(check_of(with(what)).list.size() == 1);
  }
  CHECK(check_of(with("")).list.empty());
  std::string rigid = text;
  rigid.insert(rigid.find("joint = \"glue\""), "kind = \"rigid\"\n");
  rigid.replace(rigid.find("kind = \"bonded\""), 15, "friction_angle = 0");
  rigid += "time_step = \"1 ms\"\n";
  CHECK(check_of(rigid).list.empty());
}

}  // namespace test_resolution
