// Ways to shake the same layer on rock: a compliant base under the outcrop motion, a rigid base that moves as
// the foot of the compliant one did, the same as a body force in the frame of the base: one motion. A rigid
// base under the outcrop motion itself is another: what comes down cannot leave (theory 4.18).

#include <numbers>

#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_base_inputs {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kHeight = 30, kShear = 300, kPeak = 0.8, kMain = 2.5, kStep = 1e-3;  // [m], [m/s], [s], [Hz]

double outcrop(double t) {
  const double a = std::pow(std::numbers::pi * kMain * (t - kPeak), 2);
  return 1e-3 * (1 - 2 * a) * std::exp(-a);
}

// A layer of soil with tied sides; `more` says how it is shaken.
std::string layer(const std::string& more) {
  return fmt::format(R"toml(
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
[[grid]]
name = "layer"
min = [0, 0]
max = [6, 30]
cells = [2, 15]
material = "soil"
joint = "glue"
[[boundary]]
name = "sides"
kind = "tied"
edge = [[0, 0], [0, 30]]
to_edge = [[6, 0], [6, 30]]
[[stage]]
name = "shake"
kind = "dynamic"
duration = 4
time_step = {}
[[monitor]]
name = "top"
point = [3, 30]
[[monitor]]
name = "foot"
point = [3, 0]
{})toml",
                     kStep, more);
}

const std::string kOutcrop =
    "[history.outcrop]\nexpression = \"1e-3*(1-2*(_pi*2.5*(t-0.8))^2)*exp(-(_pi*2.5*(t-0.8))^2)\"\n"
    "duration = 4\nsamples = 4000\n";

std::string table(const std::string& name, const std::vector<double>& t, const std::vector<double>& value) {
  std::string times, values;
  for (size_t i = 0; i < t.size(); ++i) {
    times += fmt::format("{}{:.17g}", i > 0 ? ", " : "", t[i]);
    values += fmt::format("{}{:.17g}", i > 0 ? ", " : "", value[i]);
  }
  return fmt::format("[history.{}]\ntime = [{}]\nvalue = [{}]\n", name, times, values);
}

std::string rigid_base(const std::string& x) {
  return "[[support]]\nname = \"base\"\nedge = [[0, 0], [6, 0]]\n" + x;
}

// Displacement of the surface relative to the foot, and largest velocity of the surface from `from` on.
std::vector<double> relative(const CaseResult& r) {
  std::vector<double> out = r.column("top.displacement_x");
  for (size_t i = 0; i < out.size(); ++i) out[i] -= r.column("foot.displacement_x")[i];
  return out;
}

double late_peak(const CaseResult& r, double from) {
  const auto &t = r.column("t [s]"), &v = r.column("top.velocity_x");
  double most = 0;
  for (size_t i = 0; i < t.size(); ++i)
    if (t[i] >= from) most = std::max(most, std::abs(v[i]));
  return most;
}

double misfit(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0, largest = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(a[i] - b[i]));
    largest = std::max(largest, std::abs(b[i]));
  }
  return most / largest;
}

}  // namespace

TEST_CASE("inputs: compliant base, rigid base with its motion, body force in its frame are one motion" *
          doctest::test_suite("optimised")) {
  const CaseResult compliant =
      run_case(layer(kOutcrop + "[[boundary]]\nname = \"base\"\nkind = \"viscous\"\nedge = [[0, 0], [6, 0]]\n"
                                "material = \"rock\"\nvelocity_x = \"outcrop\"\nmotion = \"outcrop\"\n"));
  const auto &t = compliant.column("t [s]"), &foot = compliant.column("foot.displacement_x");

  // places prescribed step by step: the same sums but for the tolerance of the contact equations
  const CaseResult rigid =
      run_case(layer(table("within", t, foot) + rigid_base("x = { displacement = \"within\" }\n")));
  check_below("inputs: rigid base with the motion within", misfit(relative(rigid), relative(compliant)), 1e-2,
              1e-6);

  // minus the second difference is the body force that central differences take for the same motion
  std::vector<double> push(t.size(), 0);
  for (size_t i = 1; i + 1 < t.size(); ++i)
    push[i] = -(foot[i + 1] - 2 * foot[i] + foot[i - 1]) / (kStep * kStep);
  const CaseResult body = run_case(layer(table("inertia", t, push) + rigid_base("") +
                                         "[[load]]\nname = \"shake\"\nacceleration_x = \"inertia\"\n"));
  check_below("inputs: body force in the frame of the base", misfit(relative(body), relative(compliant)),
              1e-2, 1e-6);

  const CaseResult ringing = run_case(layer(kOutcrop + rigid_base("x = { velocity = \"outcrop\" }\n")));
  check_above("inputs: rigid base with the outcrop motion, misfit",
              misfit(relative(ringing), relative(compliant)), 0.5, 1);
  // every wave that came down goes up again, turned over: 2 sum (-1)^n v(t - (2n + 1) H/c). Ten round trips
  // at 25 blocks per wavelength are 0.4 % of a period each
  double exact = 0, exact_compliant = 0;
  for (double time = 3; time < 4; time += kStep) {
    double sum = 0, leaving = 0, share = 1 / 1.2;
    for (int n = 0; n < 40; ++n, share *= -0.8 / 1.2) {
      sum += (n % 2 ? -2 : 2) * outcrop(time - (2 * n + 1) * kHeight / kShear);
      leaving += 2 * share * outcrop(time - (2 * n + 1) * kHeight / kShear);
    }
    exact = std::max(exact, std::abs(sum)), exact_compliant = std::max(exact_compliant, std::abs(leaving));
  }
  check_close("inputs: ringing of the rigid base after 3 s [m/s]", late_peak(ringing, 3), exact, 5e-2, 2e-2);
  check_close("inputs: what is left on the compliant base after 3 s [m/s]", late_peak(compliant, 3),
              exact_compliant, 5e-2, 2e-2);
  check_close("inputs: peak on the compliant base [m/s]", late_peak(compliant, 0), 2.052e-3, 2e-2, 5e-3);
  for (const CaseResult* r : {&compliant, &rigid, &body, &ringing})
    check_below("inputs: energy left over / largest term", r->run.closure(), 1e-2, 1e-9);
}

}  // namespace test_base_inputs
