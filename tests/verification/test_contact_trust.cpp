// Contact that cannot be fooled: joints without friction carry no shear whatever crosses them, joints close
// as far as their stiffness says, blocks far away change nothing, memory stays when corners change, toes are
// those of Winkler.

#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_contact_trust {

using namespace talus;
using namespace talus::test;

namespace {

std::string head(const std::string& joint, double gravity) {
  return fmt::format(
      "talus = 1\n[model]\ngravity = [0, {}]\n[material.m]\ndensity = 2500\nyoung = \"20 GPa\"\npoisson = 0\n"
      "[joint.j]\n{}\n[contact]\njoint = \"j\"\n[joint.glue]\nkind = \"bonded\"\n",
      -gravity, joint);
}

std::string block(const std::string& name, const std::string& polygon, const std::string& more) {
  return fmt::format("[[block]]\nname = \"{}\"\npolygon = {}\nmaterial = \"m\"\n{}\n", name, polygon, more);
}

std::string grid(const std::string& name, double bottom, int columns, const std::string& joint) {
  return fmt::format(
      "[[grid]]\nname = \"{}\"\nmin = [0, {}]\nmax = [2, {}]\ncells = [{}, 1]\nmaterial = \"m\"\njoint = "
      "\"{}\"\n",
      name, bottom, bottom + 1, columns, joint);
}

// Two rows of blocks under a pressure, the upper one pushed sideways.
std::string two_rows(const std::string& joint, int upper, int lower, const std::string& inner) {
  return head(joint, 0) + grid("lower", 0, lower, inner) + grid("upper", 1, upper, inner) +
         "[[support]]\nname = \"base\"\nedge = [[0, 0], [2, 0]]\n"
         "[history.press]\ntime = [0, 1]\nvalue = [4e5, 4e5]\n"
         "[history.shear]\ntime = [0, 0.01, 1]\nvalue = [0, 3.2e5, 3.2e5]\n"
         "[[load]]\nname = \"press\"\nedge = [[0, 2], [2, 2]]\npressure = \"press\"\n"
         "[[load]]\nname = \"shear\"\nedge = [[0, 2], [2, 2]]\ntraction_x = \"shear\"\n"
         "[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 2\n"
         "[[stage]]\nname = \"push\"\nkind = \"dynamic\"\nduration = 0.03\n"
         "[[monitor]]\nname = \"bed\"\ncontact = [\"upper\", \"lower\"]\n[[monitor]]\nname = \"top\"\npoint "
         "= [1, 1.5]\n";
}

double largest(const std::vector<double>& v) {
  double most = 0;
  for (const double x : v) most = std::max(most, std::abs(x));
  return most;
}

}  // namespace

TEST_CASE("a bed without friction carries no shear, whatever joints cross it") {
  // mass 5000 kg, force 0.64 MN in the end: 128 m/s2 after a ramp of 10 ms
  const double a = 0.64e6 / 5000, ramp = 0.01, t = 0.03;
  const double exact = a * ramp * ramp / 6 + a * ramp / 2 * (t - ramp) + 0.5 * a * (t - ramp) * (t - ramp);
  for (const char* stiffness : {"", "\nnormal_stiffness = \"20 GPa/m\"\nshear_stiffness = \"20 GPa/m\""})
    for (const char* inner : {"glue", "j"})
      for (const int upper : {2, 3}) {
        // loose columns lean under what pushes their tops, and the normal of an elastic bed leans with them
        if (std::string(inner) == "j" && (upper == 3 || *stiffness != 0)) continue;
        CAPTURE(stiffness);
        CAPTURE(inner);
        CAPTURE(upper);
        const CaseResult r =
            run_case(two_rows(std::string("friction_angle = 0") + stiffness, upper, 2, inner));
        // 1e-4 of what pushes; nothing at all holds the row back
        check_below("bed without friction: shear / push", largest(r.column("bed.force_x")) / 0.64e6, 1e-4,
                    1e-6);
        // columns that are not glued come apart by their own strain, 16 um
        check_close("bed without friction: way of the upper row [m]", r.column("top.displacement_x").back(),
                    exact, 1e-3, 1e-4);
      }
}

TEST_CASE("a soft joint closes by weight over stiffness, at any depth below a quarter of the block") {
  for (const double kn : {4e5, 1e6, 1e8}) {
    const CaseResult r = run_case(
        head(fmt::format("friction_angle = \"35 deg\"\nnormal_stiffness = {0}\nshear_stiffness = {0}", kn),
             10) +
        block("floor", "[[-5, -1], [5, -1], [5, 0], [-5, 0]]", "kind = \"fixed\"") +
        block("a", "[[0, 0], [1, 0], [1, 1], [0, 1]]", "kind = \"rigid\"") +
        "[[stage]]\nname = \"s\"\nkind = \"static\"\nduration = 20\ntime_step = \"2 ms\"\n"
        "[[monitor]]\nname = \"m\"\npoint = [0.5, 0.5]\n");
    // a side that ends on a wider block bears kn t c (L - c/2) (theory 3.3)
    check_close("soft joint: closure [m]", -r.column("m.displacement_y").back(),
                1 - std::sqrt(1 - 2 * 25000 / kn), 1e-3, 1e-5);
  }
  // 0.5 m of 1 m: the geometry is no longer that of the model
  Findings findings("case.toml", "");
  PreparedRun prepared =
      prepare_run("case.toml",
                  head("friction_angle = 0\nnormal_stiffness = 5e4", 10) +
                      block("floor", "[[-5, -1], [5, -1], [5, 0], [-5, 0]]", "kind = \"fixed\"") +
                      block("a", "[[0, 0], [1, 0], [1, 1], [0, 1]]", "kind = \"rigid\"") +
                      "[[stage]]\nname = \"s\"\nkind = \"static\"\nduration = 20\ntime_step = \"2 ms\"\n",
                  {}, findings);
  State state = start_state(prepared.scene);
  MemoryObserver observer(prepared.scene, nullptr);
  const RunResult run = run_stages(prepared.scene, prepared.plans, state, observer);
  CHECK(run.failure.find("more than a quarter") != std::string::npos);
  CHECK(run.failure.find("normal_stiffness = ") != std::string::npos);
}

TEST_CASE("an elastic joint keeps its shear when another corner comes to its end") {
  // equal widths, so that moving over the middle changes the corner at both ends
  const std::string text =
      head("friction_angle = \"45 deg\"\nnormal_stiffness = 1e9\nshear_stiffness = 1e9", 0) +
      block("lower", "[[0, -0.5], [1, -0.5], [1, 0], [0, 0]]", "kind = \"fixed\"") +
      block("upper", "[[0, 0], [1, 0], [1, 0.5], [0, 0.5]]", "kind = \"rigid\"") +
      "[history.press]\ntime = [0, 1]\nvalue = [1e6, 1e6]\n"
      "[history.push]\ntime = [0, 0.5, 1.5, 2]\nvalue = [0, 0.0008, -0.0008, 0.0008]\n"
      "[[load]]\nname = \"top\"\nedge = [[0, 0.5], [1, 0.5]]\npressure = \"press\"\n"
      "[[support]]\nname = \"push\"\nedge = [[0, 0], [0, 0.5]]\nx = { displacement = \"push\" }\ny = "
      "\"free\"\n"
      "[[stage]]\nname = \"press\"\nkind = \"static\"\nduration = 5\ntime_step = 5e-4\n"
      "[[stage]]\nname = \"shear\"\nkind = \"dynamic\"\nduration = 2\ntime_step = 5e-4\ndamping_mass = 50\n"
      "[[monitor]]\nname = \"joint\"\ncontact = [\"upper\", \"lower\"]\n[[monitor]]\nname = \"m\"\npoint = "
      "[0.5, 0.25]\n";
  const CaseResult r = run_case(text);
  // below 1 MN it never slides: force and displacement are one line, there and back
  double off = 0;
  const auto &f = r.column("joint.force_x"), &x = r.column("m.displacement_x");
  for (size_t i = 0; i < f.size(); ++i) off = std::max(off, std::abs(std::abs(f[i]) - 1e9 * std::abs(x[i])));
  // 0.1 % of inertia and of the overlap that moving takes off, 0.8 mm of 1 m
  check_below("shear of an elastic joint off its line / largest", off / 0.8e6, 3e-3, 2e-3);
}

TEST_CASE(
    "the toe of a rocked block is that of Winkler's foundation, with no step where it becomes a corner") {
  const CaseResult r = run_case(
      head("friction_angle = \"60 deg\"\nnormal_stiffness = 1e9\nshear_stiffness = 1e9", 10) +
      block("lower", "[[-2, -0.5], [3, -0.5], [3, 0], [-2, 0]]", "kind = \"fixed\"") +
      block("upper", "[[0, 0], [1, 0], [1, 2], [0, 2]]", "kind = \"rigid\"") +
      "[history.press]\ntime = [0, 1]\nvalue = [5e5, 5e5]\n[history.push]\ntime = [0, 2]\nvalue = [0, 0.1]\n"
      "[[load]]\nname = \"top\"\nedge = [[0, 2], [1, 2]]\npressure = \"press\"\n"
      "[[support]]\nname = \"push\"\npoint = [0, 2]\nx = { displacement = \"push\" }\ny = \"free\"\n"
      "[[stage]]\nname = \"press\"\nkind = \"static\"\nduration = 5\ntime_step = 5e-4\n"
      "[[stage]]\nname = \"push\"\nkind = \"dynamic\"\nduration = 2\ntime_step = 5e-4\ndamping_mass = 20\n"
      "[[monitor]]\nname = \"left\"\npoint = [0.02, 0.02]\n[[monitor]]\nname = \"right\"\npoint = [0.98, "
      "0.02]\n"
      "[[monitor]]\nname = \"joint\"\ncontact = [\"upper\", \"lower\"]\n");
  const auto &left = r.column("left.displacement_y"), &right = r.column("right.displacement_y"),
             &force = r.column("joint.force_y");
  double jump = 0;
  size_t seen = 0;
  const double wanted[] = {0.005, 0.01, 0.019, 0.021, 0.03, 0.045};
  for (size_t i = 1; i < left.size(); ++i) {
    const double theta = (left[i] - right[i]) / 0.96;
    if (theta > 0.002) jump = std::max(jump, std::abs(std::abs(force[i]) - std::abs(force[i - 1])) / 0.55e6);
    if (seen == std::size(wanted) || theta < wanted[seen]) continue;
    ++seen;
    // depth of the corner against sqrt(2 N theta/kn)
    const double depth = -(right[i] - 0.02 * theta);
    check_close(fmt::format("toe at {} rad: depth [m]", wanted[seen - 1]), depth,
                std::sqrt(2 * std::abs(force[i]) * theta / 1e9), 2e-2, 3e-3);
  }
  CHECK(seen == std::size(wanted));
  check_below("toe: largest step of the force / force", jump, 1e-2, 5e-3);
}

TEST_CASE(
    "a deformable block that must stick does not creep, with nothing but material, joint and block given") {
  const double slope = 25 * M_PI / 180, c = std::cos(slope), s = std::sin(slope);
  const auto at = [&](double x, double y) {
    return fmt::format("[{:.17g}, {:.17g}]", c * x + s * y, -s * x + c * y);
  };
  const CaseResult r = run_case(
      head("friction_angle = \"26.5 deg\"", 9.81) +
      block("plane", fmt::format("[{}, {}, {}, {}]", at(-1, -1), at(4, -1), at(4, 0), at(-1, 0)),
            "kind = \"fixed\"") +
      block("b", fmt::format("[{}, {}, {}, {}]", at(0, 0), at(1, 0), at(1, 0.5), at(0, 0.5)), "") +
      "[[stage]]\nname = \"stand\"\nkind = \"dynamic\"\nduration = 3\n[[monitor]]\nname = \"m\"\npoint = " +
      at(0.5, 0.25) + "\n");
  const auto& x = r.column("m.displacement_x");
  check_below("block at 93.5 % of its friction: moved in the last 2.5 s [m]",
              std::abs(x.back() - x[x.size() / 6]), 1e-6, 1e-9);
}

}  // namespace test_contact_trust
