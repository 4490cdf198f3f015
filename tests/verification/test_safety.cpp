// Factor of safety by strength reduction against limit equilibrium: the two-block slope of A6i, with friction
// alone and with cohesion, and the columns of Goodman and Bray.

#include "support/limit_models.h"
#include "support/relative.h"
#include "support/source_file.h"
#include "support/tolerance.h"
#include "talus/model/joint_law.h"
#include "talus/schema/toml_source.h"
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

TEST_CASE("factor of safety of the two-block slope is that of limit equilibrium" *
          doctest::test_suite("optimised")) {
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

namespace {

// A block on a plane of 30 deg with 35 deg of friction, under its weight of 51012 N; in a second stage an anchor of 50 kN
// normal to the plane.
std::string anchored_text() {
  const double s = std::sin(radians(30)), c = std::cos(radians(30));
  return fmt::format(
             "talus = 1\n[model]\ngravity = [{:.17g}, {:.17g}]\n[material.m]\ndensity = 2600\nyoung = 10e9\npoisson = 0.25\n"
             "[joint.face]\nfriction_angle = \"35 deg\"\nnormal_stiffness = 5e9\nshear_stiffness = 5e9\n[contact]\njoint = "
             "\"face\"\n[bolt_type.strand]\nkind = \"anchored\"\ndiameter = 0.03\nspacing = 1\npretension = 50e3\n"
             "[[bolt]]\nname = \"anchor\"\ntype = \"strand\"\nstage = \"anchor\"\nfrom = [1, 0.99]\nto = [1, -4]\n",
             kG * s, -kG * c) +
         block_text("table", {{-5, -5}, {8, -5}, {8, 0}, {-5, 0}}, "fixed") +
         block_text("block", {{0, 0}, {2, 0}, {2, 1}, {0, 1}}, "deformable") +
         "[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 20\n"
         "[[stage]]\nname = \"anchor\"\nkind = \"static\"\nduration = 20\n";
}

}  // namespace

TEST_CASE("factor of safety: what is put in before the question is asked helps, what comes later does not") {
  const double bare = std::tan(radians(35)) / std::tan(radians(30));
  const double weight = 2 * 2600 * kG;
  const double held =
      (weight * std::cos(radians(30)) + 50e3) * std::tan(radians(35)) / (weight * std::sin(radians(30)));
  // its own force closes the joint and the block by 7.5e-6 m, by which an anchor of 2.8e7 N/m loses 0.4 %: 2e-3 of the factor
  const std::string seek = "[safety]\ntolerance = 0.002\ndisplacement_limit = 1e-3\n";
  const auto factor = [&](const std::string& more, const std::string& stages = "") {
    const SafetyResult r = seek_safety(prepare(anchored_text() + stages + seek + more), Workers());
    REQUIRE(r.status == SafetyStatus::kFound);
    check_below("longer rungs come to the same", std::abs(r.coarse / r.factor() - 1), 2e-3, 1e-6);
    return r.factor();
  };
  check_close("anchored block", factor(""), held, 3e-3, 1e-3);
  check_close("anchored block, before the anchor is there", factor("at = \"settle\"\n"), bare, 3e-3, 1e-3);
  // brackets stop a search and decide nothing
  CHECK(factor("lowest = 0.9\nhighest = 2.7\n") == factor(""));
  // a later stage: what it brings is not there when the question is asked
  const std::string shaken =
      "[[stage]]\nname = \"shake\"\nkind = \"dynamic\"\nduration = 1\n[[load]]\nname = \"push\"\nblock = \"block\"\n"
      "acceleration_x = 100\nstages = [\"shake\"]\n[[change]]\nstage = \"shake\"\njoint = \"face\"\nfriction_angle = "
      "\"5 deg\"\n";
  CHECK(factor("", shaken) == factor(""));
}

TEST_CASE("factor of safety: strength that a stage changes is divided, too") {
  const double exact = std::tan(radians(33)) / std::tan(radians(30));
  const std::string weaker =
      "[[change]]\nstage = \"anchor\"\njoint = \"face\"\nfriction_angle = \"33 deg\"\n"
      "[safety]\ntolerance = 0.002\ndisplacement_limit = 1e-3\n";
  std::string text = anchored_text();
  text.erase(text.find("[[bolt]]"), text.find("[[block]]") - text.find("[[bolt]]"));
  for (const char* from : {"rest", "start"}) {
    const SafetyResult r =
        seek_safety(prepare(text + weaker + fmt::format("from = \"{}\"\n", from)), Workers());
    REQUIRE(r.status == SafetyStatus::kFound);
    check_close(fmt::format("block on a plane, from {}", from), r.factor(), exact, 3e-3, 1e-3);
  }
}

TEST_CASE("factor of safety below one: strength is raised, then lowered") {
  double weight = 0;
  Vec2 length;
  const std::string text = slope_text("friction_angle = \"25 deg\"", &weight, &length) +
                           "[safety]\ntolerance = 0.004\njoints = [\"bed\"]\n";
  const SafetyResult r = seek_safety(prepare(text), Workers());
  REQUIRE(r.status == SafetyStatus::kFound);
  CHECK(!r.trials[0].stands);  // as it is
  check_close("two-block slope that slides: factor of safety", r.factor(),
              exact_factor(25, 0, weight, length), 1e-2, 3e-3);
}

TEST_CASE("reduced strength: tangents and stresses divided, dilation kept below friction") {
  JointProperty j;
  j.friction_angle = radians(45), j.cohesion = 6, j.tensile_strength = 4, j.dilation_angle = radians(20);
  j.residual_friction_angle = radians(30), j.residual_cohesion = 2, j.residual_tensile_strength = 1;
  const JointProperty half = reduced(j, 2);
  CHECK(std::tan(half.friction_angle) == approx(0.5));
  CHECK(std::tan(half.residual_friction_angle) == approx(0.5 / std::sqrt(3.0)));
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
  const std::string file = source_file("examples/toppling/toppling.toml");
  // a short variant: brackets 2 % on either side of tan 45 / tan 38.134 deg
  const PreparedRun prepared =
      prepare(read_text_file(file), {"safety.lowest=1.248", "safety.highest=1.3", "safety.tolerance=0.015"});
  const SafetyResult r = seek_safety(prepared, Workers());
  REQUIRE(r.status == SafetyStatus::kFound);
  check_close("toppling: factor of safety", r.factor(), 1 / std::tan(radians(38.134)), 2e-2, 1e-2);
}

// --- a load, a tilt, an acceleration that is raised ---

namespace {

// What the search finds, at most `off` from `exact`, with what it says of its trials.
void check_limit(const std::string& name, const std::string& text, double exact, double off) {
  const SafetyResult r = seek_safety(prepare(text), Workers());
  INFO(name);
  REQUIRE(r.status == SafetyStatus::kFound);
  check_below(name + ": off " + fmt::format("{:.5g}", exact), std::abs(r.factor() / exact - 1), off, 1e-6);
  // trials go on from the last that stands: nothing is let fall for it
  for (const SafetyTrial& t : r.trials) {
    CHECK(t.stands == (t.factor <= r.stands));
    check_below(name + ": closure of the ledger", t.closure, 1e-2, 1e-14);
  }
}

std::string box_text(const std::string& name, Vec2 low, Vec2 high, const std::string& kind) {
  return block_text(name, {low, {high.x, low.y}, high, {low.x, high.y}}, kind);
}

const std::string kStand =
    "[[stage]]\nname = \"stand\"\nkind = \"static\"\nduration = 20\ntime_step = 2e-3\n";

// Bricks of 4 x 1.75 in running bond, half bricks close the first, third ... course.
std::string bond_text(int courses) {
  return head_text({0, -kG}, std::atan(0.65) * 180 / std::numbers::pi, 2000) +
         fmt::format(
             "[[region]]\nname = \"wall\"\npolygon = [[0, 0], [20, 0], [20, {0}], [0, {0}]]\nmaterial = \"m\"\nkind = "
             "\"rigid\"\n[[masonry]]\nname = \"bond\"\nregion = \"wall\"\nlength = 4\nheight = 1.75\noverlap = "
             "0.5\norigin = [2, 0]\n",
             1.75 * courses) +
         box_text("ground", {-5, -1}, {30, 0}, "fixed") +
         "[[stage]]\nname = \"stand\"\nkind = \"static\"\nduration = 60\ntime_step = 5e-3\n";
}

}  // namespace

TEST_CASE("collapse by tilt: a block that had to fall to its place before is tilted from rest") {
  // its stage is followed by motion; the trials are of steps from rest again
  for (const char* step : {"", "time_step = \"0.2 ms\"\n"}) {
    const std::string text = fmt::format(
        "talus = 1\n[model]\ngravity = [0, -9.81]\n[material.m]\ndensity = 2500\nyoung = \"5 GPa\"\npoisson = 0.2\n"
        "[joint.j]\nfriction_angle = \"30 deg\"\nnormal_stiffness = \"10 GPa/m\"\nshear_stiffness = \"10 GPa/m\"\n[contact]\n"
        "joint = \"j\"\n{}{}[[stage]]\nname = \"fall\"\nkind = \"static\"\nduration = 10\n{}[safety]\nby = "
        "\"tilt\"\nlowest = 1\nhighest = 40\n",
        block_text("lower", {{-3, -1}, {5, -1}, {5, 0}, {-3, 0}}, "fixed"),
        block_text("upper", {{0, 4}, {2, 4}, {2, 5}, {0, 5}}, "deformable"), step);
    const SafetyResult r = seek_safety(prepare(text), Workers());
    CHECK(r.stands == relative(30, 5e-3));
  }
}

TEST_CASE("collapse by tilt: a block slides at its friction angle, and tips where its foot is narrow") {
  const std::string head =
      head_text({0, -kG}, 30, 2000) + box_text("ground", {-5, -1}, {9, 0}, "fixed") + kStand;
  // found to 0.05 deg of some 30: 1.7e-3; the give of hard contacts moves the toe by less than that of a block
  check_limit("slides", head + box_text("b", {0, 0}, {1, 0.5}, "rigid") + "[safety]\nby = \"tilt\"\n", 30,
              3e-3);
  check_limit("tips", head + box_text("b", {0, 0}, {1, 2.5}, "rigid") + "[safety]\nby = \"tilt\"\n",
              std::atan(0.4) * 180 / std::numbers::pi, 5e-3);
}

TEST_CASE("collapse by load: a block is pushed off by so many times the load") {
  const std::string text = head_text({0, -kG}, 30, 2000) + box_text("ground", {-5, -1}, {9, 0}, "fixed") +
                           box_text("b", {0, 0}, {2, 0.5}, "rigid") + kStand;
  const double bears = std::tan(radians(30)) * kG;
  check_limit(
      "acceleration",
      text +
          "[[load]]\nname = \"push\"\nblock = \"b\"\nacceleration_x = 2\n[safety]\nby = \"load\"\nload = \"push\"\n",
      bears / 2, 4e-3);
  // 2000 kg on an edge of 0.5 m
  check_limit(
      "pressure",
      text +
          "[[load]]\nname = \"push\"\nedge = [[0, 0], [0, 0.5]]\npressure = 8000\n[safety]\nby = \"load\"\nload = \"push\"\n",
      bears * 2000 / 4000, 4e-3);
}

TEST_CASE("collapse by tilt: the two-block slope") {
  const double mu = std::tan(radians(34)), t1 = radians(kSteep), t2 = radians(kFlat);
  // both weights alike, turned by the tilt; the face between them bears across itself alone
  const auto needs_more = [&](double tilt) {
    const double c = std::cos(tilt), s = std::sin(tilt);
    const double n1 = c / (std::cos(t1) + mu * std::sin(t1)), n2 = c / (std::cos(t2) + mu * std::sin(t2));
    return s + n1 * (std::sin(t1) - mu * std::cos(t1)) > n2 * (mu * std::cos(t2) - std::sin(t2)) - s;
  };
  double low = 0, high = radians(20);
  while (high - low > 1e-12) (needs_more(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
  check_limit("two blocks",
              slope_text("friction_angle = \"34 deg\"") +
                  "[safety]\nby = \"tilt\"\nlowest = 0.1\nhighest = 15\ntolerance = 0.01\n",
              low * 180 / std::numbers::pi, 1e-2);
}

TEST_CASE("collapse by acceleration: arches") {
  // by linear programming over contact forces at the corners of the faces, friction 0.7 (hinges govern)
  for (const auto& [arch, limit] :
       {std::pair(Arch{157.5, 0.15, 7}, 0.373612), std::pair(Arch{180, 0.2, 15}, 0.286357)}) {
    const std::string text =
        arch_text(arch, 0, std::atan(0.7) * 180 / std::numbers::pi) +
        "[[stage]]\nname = \"stand\"\nkind = \"static\"\nduration = 60\ntime_step = 4e-3\n";
    check_limit(fmt::format("arch of {} voussoirs", arch.voussoirs),
                text + "[safety]\nby = \"acceleration\"\nlowest = 0.1\nhighest = 0.6\n", limit, 1e-2);
  }
}

TEST_CASE("collapse by acceleration: brick walls of Ferris and Tin-Loi" * doctest::test_suite("optimised")) {
  // 33 blocks: 0.6429 (2001), which is also what linear programming gives
  check_limit("33 blocks", bond_text(6) + "[safety]\nby = \"acceleration\"\nlowest = 0.3\nhighest = 0.9\n",
              0.642859, 1e-2);
  // 55 blocks: friction without dilation fails below the linear programme (0.57999); above 0.55
  const SafetyResult r = seek_safety(
      prepare(bond_text(10) + "[safety]\nby = \"acceleration\"\nlowest = 0.3\nhighest = 0.9\n"), Workers());
  CHECK(r.stands > 0.55);
  CHECK(r.fails < 0.58);
}

TEST_CASE("collapse: the bracket only stops the search, and longer rungs come to the same" *
          doctest::test_suite("optimised")) {
  const auto found = [](const std::string& bracket) {
    return seek_safety(
        prepare(bond_text(6) + "[safety]\nby = \"acceleration\"\ntolerance = 0.005\n" + bracket), Workers());
  };
  const SafetyResult r = found("");
  REQUIRE(r.status == SafetyStatus::kFound);
  check_below("33 blocks: by rungs twice as long", std::abs(r.coarse - r.factor()), 0.005, 1e-12);
  for (const char* bracket : {"lowest = 0.6\n", "highest = 0.7\n", "lowest = 0.001\nhighest = 40\n"}) {
    const SafetyResult other = found(bracket);
    CHECK(other.stands == r.stands);
    CHECK(other.fails == r.fails);
  }
  CHECK(found("lowest = 0.7\n").status == SafetyStatus::kBelow);
  const SafetyResult above = found("highest = 0.3\n");
  CHECK(above.status == SafetyStatus::kAbove);
  CHECK(above.stands == 0.3);
}

TEST_CASE("collapse: several trials at once come to the same, and what is known is not run again") {
  const PreparedRun prepared = prepare(
      bond_text(6) + "[safety]\nby = \"acceleration\"\nlowest = 0.3\nhighest = 0.9\ntolerance = 0.01\n");
  const SafetyResult one = seek_safety(prepared, Workers());
  SafetySettings settings;
  settings.jobs = 3;
  const SafetyResult three = seek_safety(prepared, Workers(), settings);
  CHECK(std::abs(one.factor() - three.factor()) <= 0.01);
  settings.jobs = 1;
  settings.known = one.trials;
  const SafetyResult again = seek_safety(prepared, Workers(), settings);
  CHECK(safety_csv(again) == safety_csv(one));
}

}  // namespace test_safety
