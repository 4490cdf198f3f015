// A4a (shear), A7a-c, A7e: plane waves that run straight up a column of level ground through no, one and several
// joints, through a joint that slips, and what comes back.

#include <complex>
#include <numbers>

#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_joint_waves {

using namespace talus;
using namespace talus::test;

namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;
constexpr double kH = 0.2, kWide = 0.4, kYoung = 50e9, kPoisson = 0.25, kDensity = 2650;
const double kC11 = kYoung * (1 - kPoisson) / ((1 + kPoisson) * (1 - 2 * kPoisson));
const double kC33 = kYoung / (2 * (1 + kPoisson));
constexpr double kPeak = 1e-3;  // [m/s] small: turns of blocks are of no account

// A column of level ground, both ends absorbing; a steady sine comes up through the base. Between its parts
// runs the joint "between". It is one block wide with sides that move only along the wave's motion; where it
// is pressed it is two blocks wide with tied sides. (Elastic joints must not be crossed by others here: the
// corners that meet at a crossing carry 1 % of what its faces do.)
struct Column {
  bool shear = false, pressed = false;
  double per_wavelength = 40;  // steps of h/c in a period
  double periods_before = 5;   // until all is steady: three of swelling, then the way there and back
  int periods = 2;             // to be looked at
  std::vector<int> parts;      // blocks, upwards
  std::string joint;           // keys of "between"
  std::string more;            // stages before the wave, loads
  std::vector<double> points;  // monitors p0, p1, ... [blocks from the base]

  double speed() const { return std::sqrt((shear ? kC33 : kC11) / kDensity); }
  double impedance() const { return kDensity * speed(); }
  double block_time() const { return kH / speed(); }
  double period() const { return per_wavelength * block_time(); }
  double omega() const { return 2 * kPi / period(); }
  // pressure waves limit the step: c dt/h = 0.4 for them, 0.2 for shear
  double dt() const { return (shear ? 0.2 : 0.4) * block_time(); }
  std::string axis() const { return shear ? "x" : "y"; }
  int steps_looked_at() const { return static_cast<int>(std::lround(periods * period() / dt())); }

  std::string text() const;
};

std::string Column::text() const {
  const double duration = (periods_before + periods) * period();
  std::string out =
      fmt::format(R"toml(
talus = 1
[material.a]
density = {0}
young = {1}
poisson = {2}
[joint.glue]
kind = "bonded"
[joint.between]
{3}
[history.wave]
expression = "(t < {4:.17g} ? 0.5*(1-cos(_pi*t/{4:.17g})) : 1)*{5}*sin({6:.17g}*t)"
duration = {7:.17g}
samples = 40000
{8}
[[stage]]
name = "wave"
kind = "dynamic"
duration = {7:.17g}
time_step = {9:.17g}
)toml",
                  kDensity, kYoung, kPoisson, joint, 3 * period(), kPeak, omega(), duration, more, dt());
  double from = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    const double to = from + parts[i] * kH;
    out += fmt::format(
        "[[grid]]\nname = \"part{}\"\nmin = [0, {:.17g}]\nmax = [{}, {:.17g}]\ncells = [{}, {}]\n"
        "material = \"a\"\njoint = \"glue\"\n",
        i, from, kWide, to, pressed ? 2 : 1, parts[i]);
    if (i > 0)
      out += fmt::format("[[contact_pair]]\nbetween = [\"part{}\", \"part{}\"]\njoint = \"between\"\n", i - 1,
                         i);
    from = to;
  }
  out += fmt::format(R"toml(
[[boundary]]
name = "base"
kind = "viscous"
edge = [[0, 0], [{0}, 0]]
velocity_{1} = "wave"
motion = "upgoing"
[[boundary]]
name = "top"
kind = "viscous"
edge = [[0, {2:.17g}], [{0}, {2:.17g}]]
static = "free"
)toml",
                     kWide, axis(), from);
  if (pressed)
    out += fmt::format(
        "[[boundary]]\nname = \"sides\"\nkind = \"tied\"\nedge = [[0, 0], [0, {0:.17g}]]\n"
        "to_edge = [[{1}, 0], [{1}, {0:.17g}]]\n",
        from, kWide);
  for (const double x : {0.0, kWide})
    if (!pressed)
      out += fmt::format(
          "[[support]]\nname = \"{4}\"\nedge = [[{0}, 0], [{0}, {1:.17g}]]\n{2} = \"fixed\"\n{3} = "
          "\"free\"\n",
          x, from, shear ? "y" : "x", axis(), x > 0 ? "right" : "left");
  for (size_t i = 0; i < points.size(); ++i)
    out += fmt::format("[[monitor]]\nname = \"p{}\"\npoint = [{}, {:.17g}]\n", i, kWide / 2, points[i] * kH);
  return out;
}

// Steady motion at a monitor: v = Im(amplitude exp(i w t)).
Complex amplitude(const Column& c, const CaseResult& r, int point) {
  const auto &t = r.column("t [s]"), &v = r.column(fmt::format("p{}.velocity_{}", point, c.axis()));
  const size_t first = t.size() - static_cast<size_t>(c.steps_looked_at());
  Complex sum;
  for (size_t i = first; i < t.size(); ++i) sum += v[i] * std::polar(1.0, -c.omega() * t[i]);
  return Complex(0, 2) * sum / static_cast<double>(t.size() - first);
}

// Wave number x h of the bonded row under central differences (A4).
double discrete_kh(const Column& c) {
  const double ws = 2 / c.dt() * std::sin(c.omega() * c.dt() / 2) * c.block_time();
  return std::acos((6 - 2 * ws * ws) / (6 + ws * ws));
}

// Waves up and down at block j = 0 from the motion at blocks j0 and j1.
std::pair<Complex, Complex> up_and_down(Complex v0, Complex v1, double j0, double j1, double kh) {
  const auto e = [kh](double j) { return std::polar(1.0, kh * j); };
  const Complex d = e(-j0) * e(j1) - e(j0) * e(-j1);
  return {(v0 * e(j1) - v1 * e(j0)) / d, (e(-j0) * v1 - e(-j1) * v0) / d};
}

// A static stage in which a pressure [Pa] comes to act on the top, and stays [m].
std::string weight_stage(double pressure, double height) {
  return fmt::format(R"toml(
[history.weight]
time = [0, 1]
value = [{0}, {0}]
[[load]]
name = "weight"
edge = [[0, {1:.17g}], [{2}, {1:.17g}]]
pressure = "weight"
[[stage]]
name = "load"
kind = "static"
duration = 1
)toml",
                     pressure, height, kWide);
}

// Never opens, never slips; stiffness along both axes [Pa/m].
std::string elastic(double stiffness) {
  return fmt::format(
      "normal_stiffness = {0:.17g}\nshear_stiffness = {0:.17g}\ncohesion = 1e9\ntensile_strength = 1e9",
      stiffness);
}

// Motion below, above: [reflected, transmitted] as shares of what comes up.
struct Shares {
  double reflected, transmitted, closure;
  Complex above;
};

Shares shares_of(Column c, const std::vector<std::string>& overrides = {}) {
  int height = 0;
  for (const int n : c.parts) height += n;
  const double near = c.parts[0] - 4, far = near - std::floor(c.per_wavelength / 4);
  c.points = {far, near, height - 6.0};
  const CaseResult r = run_case(c.text(), overrides);
  const auto [up, down] = up_and_down(amplitude(c, r, 0), amplitude(c, r, 1), far - c.parts[0],
                                      near - c.parts[0], discrete_kh(c));
  const Complex above = amplitude(c, r, 2);
  return {std::abs(down / up), std::abs(above / up), r.run.closure(), above / up};
}

const char* letter(bool shear) { return shear ? "S" : "P"; }

}  // namespace

TEST_SUITE_BEGIN("optimised");

TEST_CASE("A4a shear wave: phase speed follows the discrete dispersion law") {
  for (const int n : {8, 10, 20}) {
    Column c;
    c.shear = true, c.per_wavelength = n, c.parts.assign(1, 60), c.joint = "friction_angle = 0";
    c.periods_before = 3 + 180.0 / n, c.points = {20, 50};
    const CaseResult r = run_case(c.text());
    const double kh = discrete_kh(c);
    double lag = -std::arg(amplitude(c, r, 1) / amplitude(c, r, 0));
    lag += 2 * kPi * std::round((30 * kh - lag) / (2 * kPi));
    // the far end sends back 0.35 % at 8 a period, 0.05 % at 20: up to so many radians in 30 kh
    check_close(fmt::format("A4a S phase speed / c at {} steps of h/c a period", n),
                c.omega() * c.block_time() / (lag / 30), c.omega() * c.block_time() / kh, 3e-3, 5e-4);
    check_below(fmt::format("A4a S n={} energy left over / largest term", n), r.run.closure(), 1e-2, 1e-9);
  }
}

TEST_CASE("A7a one joint: transmitted and reflected share, P and S") {
  for (const bool shear : {false, true})
    for (const double xi : {0.1, 0.25, 0.5, 1.0, 2.0})
      for (const double alpha : {0.0, 0.2}) {
        if (alpha > 0 && xi != 0.5 && xi != 2) continue;
        Column c;
        c.shear = shear, c.parts = {16, 16};
        c.joint = elastic(c.omega() * c.impedance() / (2 * xi));
        const Shares s = shares_of(c, {fmt::format("contact.alpha={}", alpha)});
        const Complex exact = 1.0 / Complex(1, xi);
        const std::string what = fmt::format("A7a {} xi={} alpha={}", letter(shear), xi, alpha);
        // 40 blocks per wavelength; alpha is a dashpot of alpha kn dt in the joint, 1.3 % of its force at
        // most
        check_close(what + " transmitted share", s.transmitted, std::abs(exact), 2e-2, 5e-3);
        check_close(what + " returned share", s.reflected, xi * std::abs(exact), 2e-2, 5e-3, 1);
        if (alpha == 0)
          check_close(what + " energy that passes and returns",
                      std::pow(s.transmitted, 2) + std::pow(s.reflected, 2), 1, 1e-2, 2e-3);
        check_below(what + ": energy left over / largest term", s.closure, 1e-2, 1e-9);
      }
}

// Joints of Kelvin's kind, k (1 + i w T), that are pressed and do not slip: what of a pressure wave is lost. A row of them, far
// nearer to each other than a wave is long, loses as a medium of wave number w sqrt(density (1/M + 1/(k s (1 + i w T)))),
// in proportion to the length and, for w T << 1, to the square of the frequency.
TEST_CASE("A7e damped joints: what one of them keeps of a wave, and the loss per length of a row") {
  const auto pressed = [](Column& c, double stiffness, double time) {
    c.joint = fmt::format(
        "friction_angle = \"60 deg\"\nnormal_stiffness = {0:.17g}\nshear_stiffness = {0:.17g}\ndamping_time = {1:.17g}",
        stiffness, time);
    int height = 0;
    for (const int n : c.parts) height += n;
    c.more = weight_stage(1e6, height * kH);
  };
  const auto kelvin = [](const Column& c, double time) { return Complex(1, c.omega() * time); };
  for (const double time : {2e-5, 1e-4, 2.5e-4})
    for (const double xi : {0.25, 1.0}) {
      Column c;
      c.parts = {16, 16};
      pressed(c, c.omega() * c.impedance() / (2 * xi), time);
      const Shares s = shares_of(c);
      const Complex give = Complex(0, xi) / kelvin(c, time), through = 1.0 / (1.0 + give),
                    back = give * through;
      const std::string what = fmt::format("A7e T={} ms xi={}", 1e3 * time, xi);
      check_close(what + " transmitted share", s.transmitted, std::abs(through), 1e-2, 3e-3);
      check_close(what + " returned share", s.reflected, std::abs(back), 1e-2, 3e-3, 1);
      check_close(what + " energy that is lost", 1 - std::pow(s.transmitted, 2) - std::pow(s.reflected, 2),
                  1 - std::norm(through) - std::norm(back), 1e-2, 3e-3);
    }
  for (const double per_wavelength : {40.0, 80.0}) {
    const double time = 2.5e-4;
    const int joints = per_wavelength > 40 ? 19 : 9, apart = 2;
    Column c;
    c.per_wavelength = per_wavelength, c.periods_before = 8;
    c.parts.assign(1, per_wavelength > 40 ? 26 : 16);
    for (int i = 1; i < joints; ++i) c.parts.push_back(apart);
    c.parts.push_back(16);
    const double spacing = apart * kH,
                 stiffness = 20 * kC11 / spacing;  // a twentieth of what the blocks give
    pressed(c, stiffness, time);
    const Shares s = shares_of(c);
    // a loss is of the first order in what joints give, what the ends of the row send back of the second
    const Complex k =
        c.omega() * std::sqrt(kDensity * (1 / kC11 + 1.0 / (stiffness * spacing * kelvin(c, time))));
    check_close(fmt::format("A7e loss per metre at {:.4g} Hz", 1 / c.period()),
                -std::log(s.transmitted) / (joints * spacing), -k.imag(), 1e-2, 3e-3);
  }
}

TEST_CASE("A7a the delay of one joint, and a bond that is no joint") {
  Column c;
  c.parts = {16, 16}, c.joint = "kind = \"bonded\"";
  const Shares bond = shares_of(c);
  // what the ends send back, 1e-4 at 40 blocks per wavelength
  check_close("A7a exact bond transmitted share", bond.transmitted, 1, 1e-3, 2e-4);
  check_below("A7a exact bond returned share", bond.reflected, 1e-3, 2e-4);
  for (const double xi : {0.25, 1.0}) {
    c.joint = elastic(c.omega() * c.impedance() / (2 * xi));
    const Shares s = shares_of(c, {"contact.alpha=0"});
    check_close(fmt::format("A7a xi={} delay [rad]", xi), -std::arg(s.above / bond.above), std::atan(xi),
                2e-2, 5e-3);
  }
}

TEST_CASE("A7c parallel joints: transfer matrix, not the power of one") {
  // |T| at distances of 0.05, 0.1 and 0.25 wavelengths, xi = 0.5
  const struct {
    int joints;
    double at[3];
  } table[] = {{2, {.78218, .88898, .89443}}, {3, {.79272, .99953, 1.0}}, {5, {.99629, .88400, .89443}}};
  for (const bool shear : {false, true})
    for (const auto& [joints, exact] : table)
      for (const size_t k : {0u, 1u, 2u}) {
        Column c;
        c.shear = shear, c.parts.assign(1, 16);
        const int apart = k == 0 ? 2 : k == 1 ? 4 : 10;  // blocks, of 40 to a wavelength
        for (int i = 1; i < joints; ++i) c.parts.push_back(apart);
        c.parts.push_back(16);
        c.periods_before = joints == 5 ? 12 : 8;  // waves go to and fro between the joints
        c.joint = elastic(c.omega() * c.impedance());
        const Shares s = shares_of(c, {"contact.alpha=0"});
        const std::string what =
            fmt::format("A7c {} N={} S/lambda={}", letter(shear), joints, apart / c.per_wavelength);
        check_close(what + " transmitted share", s.transmitted, exact[k], 3e-2, 1e-2);
        check_close(what + " energy that passes and returns",
                    std::pow(s.transmitted, 2) + std::pow(s.reflected, 2), 1, 2e-2, 5e-3);
      }
}

namespace {

// Shares of amplitude at an interface that slips at beta times the stress of the wave, by integration of what
// it lets through, clip(v, +-beta), and sends back.
struct SlipShares {
  double reflected = 0, transmitted = 0, absorbed = 0;
};

SlipShares slip_exact(double beta) {
  constexpr int kSamples = 100000;
  SlipShares s;
  double through = 0, back = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double v = std::sin(2 * kPi * (i + 0.5) / kSamples), t = std::clamp(v, -beta, beta);
    through += 2 * t * t / kSamples, back += 2 * (v - t) * (v - t) / kSamples;
  }
  return {std::sqrt(back), std::sqrt(through), std::sqrt(std::max(0.0, 1 - through - back))};
}

void slips_under_a_wave(const std::vector<double>& betas) {
  CHECK(std::abs(slip_exact(0.3).reflected - .63604) < 1e-5);
  CHECK(std::abs(slip_exact(0.3).transmitted - .39607) < 1e-5);
  CHECK(std::abs(slip_exact(0.3).absorbed - .66226) < 1e-5);

  Column c;
  c.shear = c.pressed = true, c.parts = {16, 16}, c.points = {12, 20};
  const double pressure = 1e6, stress = c.impedance() * kPeak;
  c.more = weight_stage(pressure, 32 * kH);
  struct Run {
    std::vector<double> below, above;
    double lost = 0, closure = 0;
  };
  const auto run = [&](double beta) {
    c.joint = fmt::format("friction_angle = \"{:.17g} rad\"", std::atan(beta * stress / pressure));
    Run out;
    std::vector<double> friction;
    const CaseResult r = run_case(c.text(), {}, [&](const Instant& i) {
      if (i.stage == 1) friction.push_back(i.report.energy.work[Cause::kFriction]);
    });
    const int last = c.steps_looked_at();
    const auto tail = [last](const std::vector<double>& v) {
      std::vector<double> values;
      for (size_t k = v.size() - last; k < v.size(); ++k) values.push_back(v[k]);
      return values;
    };
    out.below = tail(r.column("p0.velocity_x")), out.above = tail(r.column("p1.velocity_x"));
    out.lost = friction[friction.size() - 1 - last] - friction.back();
    out.closure = r.run.closure();
    return out;
  };
  const auto power = [](const std::vector<double>& v) {
    double sum = 0;
    for (const double x : v) sum += x * x;
    return sum / static_cast<double>(v.size());
  };
  const Run whole = run(2.5);  // sticks: the wave as it comes up
  check_close("A7b beta=2.5 T", std::sqrt(power(whole.above) / power(whole.below)), 1, 2e-2, 5e-3);
  // beside the elastic energy of what contacts give, about p_t^2 / 2 of their compliance
  check_below("A7b beta=2.5 friction work [J]", std::abs(whole.lost), 1e-8, 1e-12);
  for (const double beta : betas) {
    const Run slipping = run(beta);
    std::vector<double> back;
    for (size_t i = 0; i < whole.below.size(); ++i) back.push_back(slipping.below[i] - whole.below[i]);
    const SlipShares exact = slip_exact(beta);
    const double incident = c.impedance() * power(whole.below) * c.periods * c.period() * kWide;  // [J]
    const std::string what = fmt::format("A7b beta={} ", beta);
    check_close(what + "R", std::sqrt(power(back) / power(whole.below)), exact.reflected, 2e-2, 5e-3, 1);
    check_close(what + "T", std::sqrt(power(slipping.above) / power(whole.below)), exact.transmitted, 2e-2,
                5e-3, 1);
    check_close(what + "A, of friction work", std::sqrt(slipping.lost / incident), exact.absorbed, 2e-2, 5e-3,
                1);
    check_below(what + "energy left over / largest term", slipping.closure, 1e-2, 1e-9);
  }
}

}  // namespace

TEST_CASE("A7b interface that slips under a shear wave: what passes, returns and is lost (Miller)") {
  slips_under_a_wave({0.3, 0.7});
}

TEST_SUITE_END();

TEST_SUITE("long: slip") {
  TEST_CASE("A7b interface that slips under a shear wave, at five strengths") {
    slips_under_a_wave({0.1, 0.3, 0.5, 0.7, 0.9});
  }
}

}  // namespace test_joint_waves
