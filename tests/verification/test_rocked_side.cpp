// A side that is rocked on an elastic joint bears by Winkler's foundation, and gives back the work it took.

#include "support/junction_models.h"

namespace test_rocked_side {

using namespace talus;
using namespace talus::test;
using namespace talus::test::junction;

// A block of 1 m x 2 m, driven, turns about its lower right corner, which is kept at one depth in a joint of
// kn; the block below is held at its two lower corners. With c the depth and theta the turn, by Winkler's
// foundation:
//
//   closed side (theta < c/b):  N = kn (c - b tan(theta)/2) b,     else its part:  N = kn c^2/(2 tan(theta))
//
// and from the other side of the corner kn c^2 tan(theta)/2 more.
struct Rocked {
  CaseResult run;
  std::vector<double> stored;  // [J] minus the work of joints
  double left_over = 0;
};

Rocked rocked(const std::string& joint, const std::string& turn, const std::string& depth, double duration,
              double step, double alpha) {
  Rocked out;
  // displacement of the centroid, 1 m above and 0.5 m left of the corner, that puts the corner at x = 1, y =
  // -depth
  const auto history = [&](const char* name, const std::string& formula) {
    return fmt::format("[history.{}]\nexpression = \"{}\"\nduration = {}\nsamples = 20000\n", name, formula,
                       duration);
  };
  out.run = audited(
      fmt::format(
          "talus = 1\n[material.m]\ndensity = 2500\n[joint.j]\n{}\n[contact]\njoint = \"j\"\nalpha = {}\n",
          joint, alpha) +
          block_text("lower", box_polygon(-1, -1, 3, 0), "rigid") +
          "[[support]]\nname = \"west\"\npoint = [-1, -1]\n[[support]]\nname = \"east\"\npoint = [3, -1]\n" +
          block_text("upper", box_polygon(0, 0, 1, 2), "driven") +
          "motion_rotation = { displacement = \"turn\" }\nmotion_x = { displacement = \"x\" }\n"
          "motion_y = { displacement = \"y\" }\n" +
          history("turn", "-(" + turn + ")") +
          history("x", fmt::format("0.5 - 0.5*cos({0}) + sin({0})", turn)) +
          history("y", fmt::format("-({1}) + 0.5*sin({0}) + cos({0}) - 1", turn, depth)) +
          stage("turn", true, duration, step) + between("joint", "upper", "lower") +
          "[[monitor]]\nname = \"west\"\nsupport = \"west\"\n[[monitor]]\nname = \"east\"\nsupport = "
          "\"east\"\n",
      [&](const Instant& i) {
        out.stored.push_back(-i.report.energy.work[Cause::kJoints]);
        out.left_over = std::max(out.left_over, std::abs(i.report.energy.left_over));
      });
  return out;
}

TEST_CASE("a rocked side bears by Winkler's foundation: closed, partly open, and by its corner alone") {
  const double kn = 1e9, c = 2e-3, b = 1, most = 0.1, duration = 1;
  // the depth first, in 0.1 s, then the turn
  const Rocked r =
      rocked("friction_angle = 0\nnormal_stiffness = 1e9", fmt::format("{}*max(0, t - 0.1)", most),
             fmt::format("{}*min(1, t/0.1)", c), duration + 0.1, 1e-4, 0.2);
  const auto &t = r.run.column("t [s]"), &force = r.run.column("joint.force_y"),
             &west = r.run.column("west.reaction_y"), &east = r.run.column("east.reaction_y");
  const auto row = [&](double theta) { return row_at(r.run, 0.1 + duration * theta / most - 1e-9); };
  for (const double theta : {0.001, 0.01, 0.02, 0.05, 0.1}) {
    const size_t i = std::min(row(theta), t.size() - 1);
    const double slope = std::tan(theta), open = c - b * slope;
    const bool closed = open > 0;
    // closures c and `open` at the ends, or c and 0 over c/slope
    const double bottom = closed ? kn * 0.5 * (c + open) * b : kn * c * c / (2 * slope);
    // by its corner alone: half the overlap by the lower side, half by the two upper ones, along theirs (eq. 3.3),
    // which share the overlap along the bisector of the corner
    const double share = c * c / 2 / std::tan(theta + std::numbers::pi / 4),
                 whole = c * c / 2 * (1 / slope + slope);
    const double corner = 0.5 * kn *
                          (whole + (c * c / 2 / slope - share) * std::cos(theta) +
                           (c * c / 2 * slope + share) * std::sin(theta));
    const double exact = closed ? bottom + kn * c * c * slope / 2 : corner;
    check_close(fmt::format("rocked side at {} rad: force [N]", theta), force[i], exact, 2e-2, 1e-3);
    // of the resultant from the corner, by the reactions at x = -1 and x = 3
    const double from_corner = 1 - (-west[i] + 3 * east[i]) / (west[i] + east[i]);
    const double centre = closed ? b * (c + 2 * open) / (3 * (c + open)) : c / (3 * slope);
    check_close(
        fmt::format("rocked side at {} rad: place of the force [m]", theta), from_corner,
        (bottom * centre - kn * c * c * slope / 2 * c * slope / 3) / (bottom + kn * c * c * slope / 2),
        2e-2 + 0.5 * theta, 1e-3);  // of the foundation, not of the overlap: half the turn
  }
  double step = 0;
  for (size_t i = row(0.015); i < row(0.025); ++i)
    step = std::max(step, std::abs(force[i + 1] - force[i]) / force[i]);
  check_below("rocked side: largest step of the force from 0.015 to 0.025 rad / force", step, 5e-3, 1e-3);
}

TEST_CASE("a side that is rocked to 0.05 rad and back gives back the work that it took") {
  const double kn = 1e9, c = 2e-3, duration = 2;
  for (const std::string& joint :
       {std::string("friction_angle = 0\nnormal_stiffness = 1e9"),
        std::string("friction_angle = \"89 deg\"\nnormal_stiffness = 1e9\nshear_stiffness = 1e9")}) {
    CAPTURE(joint);
    // deeper on the way there than on the way back, open at both ends of the cycle
    const Rocked r = rocked(joint, "0.025*(1 - cos(_pi*t))",
                            fmt::format("{}*sin(_pi*t/2)*(1 + 0.5*sin(_pi*t))", c), duration, 1e-4, 0);
    const auto& time = r.run.column("t [s]");
    double most = 0, off = 0, shear = 0;
    for (size_t i = 0; i < time.size(); ++i) {
      const double t = time[i], pi = std::numbers::pi, slope = std::tan(0.025 * (1 - std::cos(pi * t)));
      const double depth = c * std::sin(pi * t / 2) * (1 + 0.5 * std::sin(pi * t)),
                   open = std::max(0.0, depth - slope);
      // integrals of the closure along both sides of the corner; slope 0: nothing is closed
      const double exact =
          slope > 0 ? kn / 6 * ((std::pow(depth, 3) - std::pow(open, 3)) / slope + std::pow(depth, 3) * slope)
                    : 0;
      most = std::max(most, exact), off = std::max(off, std::abs(r.stored[i] - exact));
      // the corner stays where it is (400 N: 1 % of the normal force): at the distance s from it the side has
      // slipped by s (1 - cos), where it is closed
      const double length = slope > 0 ? std::min(1.0, depth / slope) : 1,
                   slip = 1 - std::cos(std::atan(slope));
      shear = std::max(shear, std::abs(r.run.column("joint.force_x")[i]) - 1e9 * slip * length * length / 2);
    }
    // the energy of the overlap is less than that of the foundation by half the turn (eq. 3.2)
    check_below("rocked to 0.05 rad and back: work off that of the foundation / largest", off / most,
                0.5 * 0.05, 1e-3);
    // with shear: what opens loses its elastic slip (theory 3.7)
    check_below("rocked to 0.05 rad and back: work left over / largest", std::abs(r.stored.back()) / most,
                2e-3, 1e-5);
    check_below("rocked to 0.05 rad and back: ledger / largest", r.left_over / most, 1e-3, 1e-9);
    // not yet: as it comes back the shear of a side that slides is not that of its slip
    if (joint.find("89") == std::string::npos)
      check_below("rocked to 0.05 rad and back: shear beyond that of its slip [N]", shear, 400, 1);
  }
}

}  // namespace test_rocked_side
