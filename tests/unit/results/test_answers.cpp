// What monitors come to: motions known in closed form, stage by stage.

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "support/relative.h"
#include "support/run_case.h"
#include "support/told.h"
#include "support/tolerance.h"
#include "talus/results/answers.h"
#include "talus/results/histories.h"

namespace test_answers {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kSpin = 3, kSpeed = 2;  // [rad/s], [m/s]

// Keeps the histories of a run, and what they came to.
struct Kept : Observer {
  explicit Kept(const Scene& scene) : histories(scene, nullptr) {}
  void at(const Instant& i) override { histories.at(i, false); }
  Histories histories;
};

const Answer& answer(const Histories& h, int stage, const std::string& title) {
  const Answers& all = h.answers();
  for (const Answers::Stage& s : all.stages())
    for (size_t k = 0; k < all.titles().size(); ++k)
      if (s.stage == stage && all.titles()[k].text().rfind(title, 0) == 0) return s.asked[k];
  FAIL(title);
  std::abort();
}

struct Done {
  PreparedRun prepared;
  std::unique_ptr<Kept> kept;
  RunResult result;
};

std::unique_ptr<Done> run(const std::string& text) {
  Findings findings("model.toml", text);
  auto done = std::make_unique<Done>();
  done->prepared = prepare_run("model.toml", text, {}, findings);
  done->kept = std::make_unique<Kept>(done->prepared.scene);
  State state = start_state(done->prepared.scene);
  done->result = run_stages(done->prepared.scene, done->prepared.plans, state, *done->kept, Workers(1));
  return done;
}

// A rigid block of 1 m that flies along x and spins [rad/s], without anything else.
std::string flying_block(double spin) {
  return fmt::format(
      "talus = 1\n[material.m]\ndensity = 2500\n[[block]]\nname = \"b\"\npolygon = [[0, 0], [1, 0], [1, 1], [0, "
      "1]]\nmaterial = \"m\"\nkind = \"rigid\"\nvelocity = [{}, 0]\nspin = \"{} rad/s\"\n",
      kSpeed, spin);
}

}  // namespace

TEST_CASE("answers of a rigid block that spins while it flies") {
  // X = V t along x, turned by w t; a point at arm r has the acceleration w^2 r towards the centre
  const auto done = run(flying_block(kSpin) + R"(
[[stage]]
name = "first"
kind = "dynamic"
duration = 1
time_step = "1 ms"
[[stage]]
name = "second"
kind = "dynamic"
duration = 2
time_step = "1 ms"
[[monitor]]
name = "middle"
centroid = "b"
[[monitor]]
name = "corner"
point = [1, 1]
relative_to = "b"
spectrum = true
[[monitor]]
name = "gauge"
crack = [[0, 0], [1, 0]]
)");
  const Histories& h = done->kept->histories;
  REQUIRE(h.answers().stages().size() == 2);
  for (const int stage : {0, 1}) {
    const double begin = stage, end = stage == 0 ? 1 : 3;
    const Answer& x = answer(h, stage, "middle.displacement_x");
    // the last instant of a stage but the last is one step before its end
    const double last = stage == 0 ? end - 1e-3 : end;
    check_below("displacement at the start", std::abs(x.at_start - kSpeed * begin), 1e-9, 1e-13);
    check_below("displacement at the end", std::abs(x.at_end - kSpeed * last), 1e-9, 1e-13);
    CHECK(x.least == x.at_start);
    CHECK(x.greatest == x.at_end);
    check_below("time of the greatest", std::abs(x.time_of_greatest - last), 1e-9, 1e-13);
    // a straight line: its mean over the last tenth is its value in the middle of that, half a step early
    // where the instant of the end belongs to the next stage
    const double tail = end - 0.05 * (end - begin) - (stage == 0 ? 0.5e-3 : 0);
    check_below("residual", std::abs(x.residual(true) - kSpeed * tail), 1e-9, 1e-12);
    check_below("rotation", std::abs(answer(h, stage, "middle.rotation").at_end - kSpin * last), 1e-9, 1e-12);
  }
  // the corner goes round the middle: radius sqrt(0.5)
  const double radius = std::sqrt(0.5), central = kSpin * kSpin * radius;
  const double least = answer(h, 1, "corner.acceleration_x").least,
               most = answer(h, 1, "corner.acceleration_x").greatest;
  check_below("acceleration along x, least", std::abs(least / -central - 1), 1e-5, 1e-12);
  check_below("acceleration along x, greatest", std::abs(most / central - 1), 1e-5, 1e-12);
  // relative to the centre it never goes further than a diameter: that is reached after half a turn, within a step
  const double farthest = answer(h, 1, "corner.displacement_x").least;
  check_below("farthest from its place", std::abs(farthest + 0.5 + radius), 1e-5, 1e-12);
  CHECK(answer(h, 1, "gauge.sliding").greatest == approx(1).epsilon(1e-5));  // a bar of 1 m turned
  CHECK(answer(h, 1, "gauge.opening").least == approx(-2).epsilon(1e-5));
  const Histories::Spectra spectra = h.spectra();
  REQUIRE(spectra.columns.size() == 3);
  CHECK(spectra.columns[1] == "corner.Sa_x [m/s2]");
  // a stiff oscillator under an acceleration that is there at once: half a period later it has gone beyond the ground
  // by what is left of the start, exp(-0.05 pi), while the corner has turned by 0.03 rad; error of second order in that
  const double a0 = std::cos(std::numbers::pi / 4), a1 = std::cos(std::numbers::pi / 4 + kSpin * 0.01);
  const double expected = central * (a1 + a0 * std::exp(-0.05 * std::numbers::pi));
  check_below("Sa at 0.02 s", std::abs(spectra.values[1][0] / expected - 1), 2e-3, 1e-12);
}

TEST_CASE("answers go by every step, whatever the rows of histories are, and by the stages that were run") {
  const auto done =
      run(replaced(kShakenBlock + "[output]\nhistory_interval = 1\n[[monitor]]\nname = \"base\"\n"
                                  "centroid = \"floor\"\n[[monitor]]\nname = \"foot\"\ncontact = "
                                  "[\"stone\", \"floor\"]\n",
                   "name = \"shake\"", "name = \"shake hard\""));
  const Histories& h = done->kept->histories;
  // v = 0.1 sin(4 pi t): greatest 0.1 at 0.125 s
  const Answer& v = answer(h, 0, "base.velocity_x");
  check_below("greatest velocity", std::abs(v.greatest - 0.1), 1e-4, 1e-9);
  CHECK(answer(h, 0, "base.acceleration_x").greatest == approx(0.4 * std::numbers::pi).epsilon(1e-3));
  REQUIRE(h.touches().size() == 1);
  CHECK(h.touches()[0].first == 0);
  CHECK(h.touches()[0].last == approx(2).epsilon(1e-9));
  const std::string csv = h.answers().csv();
  CHECK(csv.find("base,velocity_x,m/s,shake hard,") != std::string::npos);
}

TEST_CASE("rows of an interval are even, whatever the step, and begin anew with each stage") {
  // X = V t: linear between steps, so that rows are exact
  const std::string text = flying_block(0) + R"(
[[stage]]
name = "first"
kind = "dynamic"
duration = "0.105 s"
time_step = "7 ms"
[[stage]]
name = "second"
kind = "dynamic"
duration = "0.06 s"
time_step = "25 ms"
reset_displacements = true
[[monitor]]
name = "b"
centroid = "b"
)";
  Findings findings("model.toml", text);
  PreparedRun prepared = prepare_run("model.toml", text, {}, findings);
  std::vector<std::vector<double>> rows;
  struct EvenRows : Observer {
    EvenRows(const Scene& scene, std::vector<std::vector<double>>& all)
        : histories(scene, [&all](const std::vector<double>& row) { all.push_back(row); }) {}
    void at(const Instant& i) override { histories.at_even(i, 0.01, even); }
    Histories histories;
    Histories::Even even;
  } observer(prepared.scene, rows);
  State state = start_state(prepared.scene);
  run_stages(prepared.scene, prepared.plans, state, observer, Workers(1));
  // 0 to 0.1, then from 0.105 on by 0.01 to 0.165, which is its end: 20 ms are three steps of it
  REQUIRE(rows.size() == 11 + 7);
  for (size_t k = 0; k < rows.size(); ++k) {
    const double t = k < 11 ? 0.01 * static_cast<double>(k) : 0.105 + 0.01 * static_cast<double>(k - 11);
    INFO(k);
    CHECK(std::abs(rows[k][0] - t) < 1e-12);
    // the last row before displacements are reset has those of the step before it, at 0.098 s
    CHECK(std::abs(rows[k][2] - kSpeed * (k < 10 ? t : k == 10 ? 0.098 : t - 0.105)) < 1e-12);
  }
}

}  // namespace test_answers
