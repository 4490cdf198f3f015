// Factor of safety by strength reduction against limit equilibrium: the two-block slope of A6i, with friction
// alone and with cohesion, and the columns of Goodman and Bray.

#include "support/limit_models.h"
#include "support/tolerance.h"
#include "talus/model/joint_law.h"
#include "talus/model/toml_source.h"
#include "talus/talus.h"

namespace test_safety {

using namespace talus;
using namespace talus::test;
using namespace talus::test::limit;

namespace {

constexpr double kSteep = 45, kFlat = 20;  // [deg]

PreparedRun prepare(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Findings findings("case.toml", text);
  return prepare_run("case.toml", text, overrides, findings);
}

// Two rigid blocks of equal weight on planes of 45 and 20 deg, a frictionless vertical face between them.
std::string slope_text(const std::string& bed, double* weight = nullptr, Vec2* length = nullptr) {
  const double t1 = std::tan(radians(kSteep)), t2 = std::tan(radians(kFlat)), step = 0.5;
  const Polygon ground{{-4, -9}, {6, -9}, {6, -step - 6 * t2}, {0, -step}, {0, 0}, {-4, 4 * t1}};
  const Polygon upper{{0, 0}, {0, 2.5}, {-1, 2.5}, {-1, t1}};
  const Polygon lower{{0, -step}, {2, -step - 2 * t2}, {2, 2.5}, {0, 2.5}};
  const double w1 = std::abs(signed_area(upper)), w2 = std::abs(signed_area(lower));
  if (weight) *weight = 2000 * w1 * kG;
  if (length) *length = {1 / std::cos(radians(kSteep)), 2 / std::cos(radians(kFlat))};
  std::string text = fmt::format(
      "talus = 1\n[model]\ngravity = [0, {}]\n[material.m]\ndensity = 2000\n[material.n]\ndensity = {:.17g}\n"
      "[joint.bed]\n{}\n[joint.smooth]\n[contact]\njoint = \"bed\"\n[[contact_pair]]\nbetween = [\"upper\", "
      "\"lower\"]\njoint = \"smooth\"\n",
      -kG, 2000 * w1 / w2, bed);
  text += block_text("ground", ground, "fixed") + block_text("upper", upper, "rigid");
  std::string last = block_text("lower", lower, "rigid");
  last.replace(last.find("\"m\""), 3, "\"n\"");
  return text + last + "[[stage]]\nname = \"stand\"\nkind = \"static\"\nduration = 2\ntime_step = 1e-3\n";
}

// The factor at which the push that the upper block needs is the push that the lower one bears.
double exact_factor(double friction, double cohesion, double weight, Vec2 length) {
  const double s1 = std::sin(radians(kSteep)), c1 = std::cos(radians(kSteep)), s2 = std::sin(radians(kFlat)),
               c2 = std::cos(radians(kFlat));
  double low = 0.1, high = 10;
  while (high - low > 1e-12) {
    const double f = 0.5 * (low + high), mu = std::tan(radians(friction)) / f, c = cohesion / f;
    const double needs = (weight * (s1 - mu * c1) - c * length.x) / (c1 + mu * s1);
    const double bears = (weight * (mu * c2 - s2) + c * length.y) / (c2 + mu * s2);
    (needs < bears ? low : high) = f;
  }
  return low;
}

}  // namespace

TEST_CASE("factor of safety of the two-block slope is that of limit equilibrium") {
  struct Case {
    double friction, cohesion;
    std::string more;
  };
  for (const Case& c : {Case{40, 0, ""}, Case{30, 8e3, ""},
                        Case{30, 8e3, "normal_stiffness = 1e9\nshear_stiffness = 5e8\n"}}) {
    double weight = 0;
    Vec2 length;
    // cohesion that stays: limit equilibrium has both planes at their strength at once
    const std::string bed =
        fmt::format("friction_angle = \"{} deg\"\ncohesion = {}\nresidual_cohesion = {}\n{}", c.friction,
                    c.cohesion, c.cohesion, c.more);
    const std::string text = slope_text(bed, &weight, &length) +
                             "[safety]\nlowest = 0.5\nhighest = 3\ntolerance = 0.004\njoints = [\"bed\"]\n";
    const SafetyResult r = seek_safety(prepare(text), Workers());
    REQUIRE(r.status == SafetyStatus::kFound);
    // half the tolerance of the search
    check_close(fmt::format("two-block slope, {:g} deg, {:g} Pa{}: factor of safety", c.friction, c.cohesion,
                            c.more.empty() ? "" : ", soft"),
                r.factor(), exact_factor(c.friction, c.cohesion, weight, length), 1e-2, 2e-3);
    CHECK(r.fails - r.stands <= 0.004);
    for (const SafetyTrial& t : r.trials) {
      check_below("energy left over / largest term", t.closure, 1e-3, 1e-9);
      CHECK(t.stands == (t.factor <= r.stands));
    }
  }
}

TEST_CASE("brackets that do not hold the factor are told, and trials repeat to the last bit") {
  const std::string text = slope_text("friction_angle = \"40 deg\"");  // 1.317
  CHECK(seek_safety(prepare(text + "[safety]\nlowest = 1.4\n"), Workers()).status == SafetyStatus::kBelow);
  CHECK(seek_safety(prepare(text + "[safety]\nhighest = 1.2\n"), Workers()).status == SafetyStatus::kAbove);
  const std::string wide = text + "[safety]\ntolerance = 0.5\n";
  const PreparedRun prepared = prepare(wide);
  CHECK(safety_csv(seek_safety(prepared, Workers())) == safety_csv(seek_safety(prepared, Workers(2))));
  // a dynamic beginning has no rest to be judged by
  CHECK_THROWS_AS(seek_safety(prepare(text, {"stage.stand.kind=\"dynamic\""}), Workers()), InputError);
}

TEST_CASE("reduced strength: tangents and stresses divided, dilation kept below friction") {
  JointProperty j;
  j.friction_angle = radians(45), j.cohesion = 6, j.tensile_strength = 4, j.dilation_angle = radians(20);
  j.residual_friction_angle = radians(30), j.residual_cohesion = 2, j.residual_tensile_strength = 1;
  const JointProperty half = reduced(j, 2);
  CHECK(std::tan(half.friction_angle) == doctest::Approx(0.5));
  CHECK(std::tan(half.residual_friction_angle) == doctest::Approx(0.5 / std::sqrt(3.0)));
  CHECK(half.cohesion == 3);
  CHECK(half.tensile_strength == 2);
  CHECK(half.residual_cohesion == 1);
  CHECK(half.residual_tensile_strength == 0.5);
  CHECK(half.dilation_angle == half.residual_friction_angle);  // 16.1 deg
  CHECK(reduced(j, 1.1).dilation_angle == j.dilation_angle);
  j.bonded = true;
  CHECK(reduced(j, 2).cohesion == 6);
}

TEST_CASE("example toppling: the factor of safety of Goodman and Bray's columns") {
  const std::string file = std::string(TALUS_SOURCE_DIR) + "/examples/toppling/toppling.toml";
  // a short variant: brackets 2 % on either side of tan 45 / tan 38.134 deg
  const PreparedRun prepared =
      prepare(read_text_file(file), {"safety.lowest=1.248", "safety.highest=1.3", "safety.tolerance=0.015"});
  const SafetyResult r = seek_safety(prepared, Workers());
  REQUIRE(r.status == SafetyStatus::kFound);
  check_close("toppling: factor of safety", r.factor(), 1 / std::tan(radians(38.134)), 2e-2, 1e-2);
}

}  // namespace test_safety
