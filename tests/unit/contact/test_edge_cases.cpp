// Models at the edge of what is sensible: each runs, or is refused with a message.

#include "support/relative.h"
#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_edge_cases {

using namespace talus;
using namespace talus::test;

namespace {

std::string block(const std::string& name, const std::string& polygon, const std::string& kind = "rigid",
                  const std::string& more = "") {
  return fmt::format("[[block]]\nname = \"{}\"\npolygon = {}\nmaterial = \"m\"\nkind = \"{}\"\n{}\n", name,
                     polygon, kind, more);
}

std::string head(double friction = 0.5, double gravity = 10) {
  return fmt::format(
      "talus = 1\n[model]\ngravity = [0, {}]\n[material.m]\ndensity = 2000\nyoung = \"100 MPa\"\npoisson = "
      "0.2\n[joint.j]\nfriction_angle = \"{:.17g} deg\"\n[contact]\njoint = \"j\"\n",
      -gravity, std::atan(friction) * 180 / M_PI);
}

const std::string kFloor = block("floor", "[[-5,-1],[9,-1],[9,0],[-5,0]]", "fixed");

std::string stage(double duration = 0.2, double step = 1e-3) {
  return fmt::format("[[stage]]\nname = \"s\"\nkind = \"dynamic\"\nduration = {}\ntime_step = {}\n", duration,
                     step);
}

std::string contact_monitor(const std::string& a, const std::string& b) {
  return fmt::format("[[monitor]]\nname = \"f\"\ncontact = [\"{}\", \"{}\"]\n", a, b);
}

// Weight of 1 m2 under 10 m/s2.
constexpr double kWeight = 20000;

// How far such a block sinks on two contacts that give a thousandth of what it yields at a corner in 1 ms
// (theory 4.22): weight / (2 K), K = 1000 m / (4 dt^2) [m].
constexpr double kSinks = 10 * 4 * 1e-6 / (2 * 1000);

}  // namespace

TEST_CASE("edge case: clockwise polygon and collinear corners carry like any other") {
  for (const char* polygon :
       {"[[0,0],[0,1],[1,1],[1,0]]", "[[0,0],[0.3,0],[0.5,0],[1,0],[1,1],[0.5,1],[0,1]]"}) {
    const CaseResult r =
        run_case(head() + kFloor + block("b", polygon) + contact_monitor("b", "floor") + stage());
    CHECK(r.column("f.normal_force").back() == approx(kWeight).epsilon(1e-9));
    CHECK(norm(r.state.displacement[1]) == approx(kSinks).epsilon(1e-3));
  }
}

TEST_CASE("edge case: two blocks that share a full edge at a gap of round-off") {
  const CaseResult r = run_case(head() + kFloor + block("a", "[[0,1e-16],[1,1e-16],[1,1],[0,1]]") +
                                block("b", "[[1.0000000000000002,0],[2,0],[2,1],[1.0000000000000002,1]]") +
                                contact_monitor("a", "floor") + stage());
  CHECK(r.column("f.normal_force").back() == approx(kWeight).epsilon(1e-9));
  for (const size_t block : {size_t{1}, size_t{2}})
    CHECK(norm(r.state.displacement[block]) == approx(kSinks).epsilon(1e-3));
}

TEST_CASE("edge case: a block of 1 mm beside one of 100 m") {
  const CaseResult r =
      run_case(head() + kFloor + block("big", "[[-100,-102],[100,-102],[100,-1.5],[-100,-1.5]]", "fixed") +
               block("small", "[[0,0],[0.001,0],[0.001,0.001],[0,0.001]]") +
               contact_monitor("small", "floor") + stage(0.2, 1e-4));
  // places are rounded to 1e-16 m, the contact gives by 2e-10 m
  CHECK(std::abs(r.column("f.normal_force").back() / (kWeight * 1e-6) - 1) < 1e-8);
  CHECK(norm(r.state.displacement[2]) < 1e-9);
  const CaseResult on_big = run_case(head() + block("big", "[[0,0],[100,0],[100,100],[0,100]]", "fixed") +
                                     block("small", "[[50,100],[50.001,100],[50.001,100.001],[50,100.001]]") +
                                     contact_monitor("small", "big") + stage(0.2, 1e-4));
  // places of 100 m are rounded to 1e-14 m, the contact gives by 2e-10 m
  CHECK(on_big.column("f.normal_force").back() == approx(kWeight * 1e-6).epsilon(1e-6));
}

TEST_CASE("edge case: blocks that touch at one corner") {
  // a square standing on its corner on the corner of another: held by nothing sideways, it stays while
  // nothing pushes it
  const CaseResult r =
      run_case(head(0.5, 0) + block("a", "[[0,0],[1,0],[1,1],[0,1]]") +
               block("b", "[[1,1],[2,1],[2,2],[1,2]]", "rigid", "velocity = [-0.1, -0.1]") + stage(0.1));
  // b comes in along the diagonal: momentum is shared, nothing passes through
  const Vec2 closing = displacement_at(r.state, 0, {0.5, 0.5}) -
                       displacement_at(r.state, 1, {-0.5, -0.5});  // the corners overlap by its smaller part
  const double overlap = std::min(closing.x, closing.y);
  CHECK(overlap < 2e-4);
  CHECK(r.state.rate[0].a.x * 2000 + r.state.rate[1].a.x * 2000 == approx(-200).epsilon(1e-9));
  CHECK(r.state.rate[0].a.y * 2000 + r.state.rate[1].a.y * 2000 == approx(-200).epsilon(1e-9));
}

TEST_CASE("edge case: four blocks meet at a point under load") {
  std::string text = head();
  const char* squares[] = {"[[0,0],[1,0],[1,1],[0,1]]", "[[1,0],[2,0],[2,1],[1,1]]",
                           "[[0,1],[1,1],[1,2],[0,2]]", "[[1,1],[2,1],[2,2],[1,2]]"};
  for (const std::string kind : {"rigid", "deformable"}) {
    std::string model = text + kFloor;
    for (int i = 0; i < 4; ++i) model += block(fmt::format("b{}", i), squares[i], kind);
    for (int i = 0; i < 2; ++i)
      model += fmt::format("[[monitor]]\nname = \"f{0}\"\ncontact = [\"b{0}\", \"floor\"]\n", i);
    model += "[[stage]]\nname = \"s\"\nkind = \"static\"\nduration = 5\nunbalanced = 1e-6\n" +
             std::string(kind == "rigid" ? "time_step = 1e-3\n" : "");
    const CaseResult r = run_case(model);
    CHECK(r.column("f0.force_y").back() + r.column("f1.force_y").back() == approx(4 * kWeight).epsilon(1e-5));
    for (const Vec2 d : r.state.displacement) CHECK(norm(d) < 1e-3);
  }
}

TEST_CASE("edge case: mu = 0 and mu = 2") {
  const CaseResult smooth = run_case(
      head(0) + kFloor + block("b", "[[0,0],[1,0],[1,1],[0,1]]", "rigid", "velocity = [1, 0]") + stage());
  CHECK(smooth.state.displacement[1].x == approx(0.2).epsilon(1e-12));
  // so rough that it tips instead of sliding: the corner in front does not move
  const CaseResult rough =
      run_case(head(2) + kFloor + block("b", "[[0,0],[1,0],[1,1],[0,1]]", "rigid", "velocity = [1, 0]") +
               stage(0.05, 1e-4));
  const Vec2 front =
      displacement_at(rough.state, 1, rough.state.displacement.empty() ? Vec2{} : Vec2{0.5, -0.5});
  CHECK(std::abs(front.x) < 2e-4);  // one step at 1 m/s before friction acts
  CHECK(rough.state.angle[1] < -0.01);
}

TEST_CASE("edge case: no gravity, one block alone") {
  const CaseResult r = run_case("talus = 1\n[material.m]\ndensity = 2000\n" +
                                block("b", "[[0,0],[1,0],[0,1]]", "rigid", "spin = \"1 rad/s\"") + stage(1));
  CHECK(r.state.angle[0] == approx(1).epsilon(1e-12));
  CHECK(norm(r.state.displacement[0]) == 0);
}

TEST_CASE("edge case: no block, or an edge of length zero, is refused") {
  const auto refusal = [](const std::string& text) {
    Findings findings("m", text);
    try {
      prepare_run("m", text, {}, findings);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(refusal("talus = 1\n" + stage()).find("the model has no block") != std::string::npos);
  CHECK(refusal(head() + block("b", "[[0,0],[1,0],[1,0],[0,1]]") + stage())
            .find("has an edge of length zero") != std::string::npos);
}

}  // namespace test_edge_cases
