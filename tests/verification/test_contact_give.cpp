// Contacts without a stiffness give by 1e-5 of their length at most: loads are shared by redundant contacts in one
// way, blows are not given back, and rigid masses of many blocks are solved at default settings (theory 4.22).

#include <numbers>

#include "support/limit_models.h"
#include "support/run_case.h"
#include "support/tolerance.h"
#include "talus/results/auditor.h"

namespace test_contact_give {

using namespace talus;
using namespace talus::test;
using namespace talus::test::limit;

namespace {

std::string box(const std::string& name, double left, double right, double foot, double top,
                const std::string& kind, const std::string& more = "") {
  return block_text(name, {{left, foot}, {right, foot}, {right, top}, {left, top}}, kind, more);
}

const std::vector<double> kPosts{-1.7, 0.3, 1.6};  // their middles [m]
constexpr double kHalfPost = 0.1;

// A rigid beam of 4 m at rest on three fixed posts: force of each post.
std::vector<double> posts_under_a_beam(const std::vector<int>& order, const std::string& rest,
                                       const std::vector<std::string>& more = {}) {
  std::string text = head_text({0, -kG}, 30, 2000);
  for (const int k : order) {
    if (k == 3)
      text += box("beam", -2, 2, 0, 0.4, "rigid");
    else
      text += box(fmt::format("post{}", k), kPosts[k] - kHalfPost, kPosts[k] + kHalfPost, -1, 0, "fixed");
  }
  std::vector<double> force(kPosts.size());
  run_case(text + rest, more, [&](const Instant& i) {
    if (!i.last) return;
    for (const Patch& c : i.state.patches)
      for (const int block : {c.block_a, c.block_b}) {
        const std::string& name = i.scene.blocks.name[block];
        if (name.starts_with("post")) force.at(name[4] - '0') += c.force[0][0] + c.force[1][0];
      }
  });
  return force;
}

// Six equal springs, one at each corner of a post, under a rigid beam.
double share_of(size_t post) {
  double squares = 0, moment = 0, sum = 0;
  for (const double x : kPosts)
    for (const double at : {x - kHalfPost, x + kHalfPost}) squares += at * at, sum += at;
  const double n = 2 * static_cast<double>(kPosts.size()), middle = sum / n;
  squares -= n * middle * middle;
  moment = -middle;  // of a weight of 1 at x = 0, about the middle of the springs
  return 2 / n + moment * 2 * (kPosts[post] - middle) / squares;
}

// Running bond of bricks of 0.5 m x 0.2 m, with two windows under lintels, on a fixed sill.
std::string wall_text(double tilt_degrees, int& bricks) {
  const double length = 0.5, height = 0.2, angle = radians(tilt_degrees);
  constexpr int kRows = 14, kColumns = 14;
  struct Span {
    double from, to;
  };
  const Span windows[] = {{1.5, 2.5}, {4.5, 5.5}};
  std::string text = head_text({kG * std::sin(angle), -kG * std::cos(angle)}, 35, 2000);
  text += box("sill", -1, kColumns * length + 1, -0.5, 0, "fixed");
  bricks = 0;
  for (int row = 0; row < kRows; ++row) {
    std::vector<double> joints{0};
    for (double x = row % 2 ? 0.5 * length : length; x < kColumns * length - 1e-9; x += length)
      joints.push_back(x);
    joints.push_back(kColumns * length);
    const bool open = row >= 4 && row < 9, lintel = row == 9;
    if (open || lintel)
      for (const Span& w : windows) {
        const double wide = lintel ? 0.25 : 0;
        std::erase_if(joints, [&](double x) { return x > w.from - wide + 1e-9 && x < w.to + wide - 1e-9; });
        for (const double x : {w.from - wide, w.to + wide})
          if (std::ranges::none_of(joints, [x](double y) { return std::abs(x - y) < 1e-9; }))
            joints.push_back(x);
        std::ranges::sort(joints);
      }
    for (size_t k = 0; k + 1 < joints.size(); ++k) {
      const double from = joints[k], to = joints[k + 1];
      if (open && std::ranges::any_of(windows, [&](const Span& w) { return std::abs(w.from - from) < 1e-9; }))
        continue;
      text += box(fmt::format("brick{}", ++bricks), from, to, row * height, (row + 1) * height, "rigid");
    }
  }
  return text;
}

}  // namespace

TEST_CASE("a rigid beam on three posts: forces as by equal springs, whatever the order of the blocks") {
  const double weight = 4 * 0.4 * 2000 * kG;
  const std::string still =
      "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = \"5 s\"\n"
      "damping_local = 0.8\nunbalanced = 1e-9\n";
  const std::vector<double> one = posts_under_a_beam({0, 1, 2, 3}, still),
                            other = posts_under_a_beam({3, 2, 0, 1}, still);
  for (size_t k = 0; k < one.size(); ++k) {
    check_close(fmt::format("beam on three posts: force of post {} [N]", k), one[k], share_of(k) * weight,
                1e-3, 1e-6);
    check_close(fmt::format("the same in another order: force of post {} [N]", k), other[k], one[k], 1e-3,
                1e-6);
  }
}

TEST_CASE("what gives gives two parts in 1000 of a blow back at most, at any step") {
  // 0.05 m of fall: 1 m/s
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    double fastest = 0;
    run_case(head_text({0, -kG}, 30, 2000) + box("floor", -1, 1, -0.5, 0, "fixed") +
                 box("brick", -0.25, 0.25, 0.05, 0.25, "rigid") + stage_text(0.3, step),
             {}, [&](const Instant& i) { fastest = std::max(fastest, i.state.rate[1].a.y); });
    check_below(fmt::format("fallen brick, dt = {:g} s: upward velocity / velocity of the fall", step),
                fastest, 2e-3, 1e-3);
  }
}

TEST_CASE("a tower of 100 rigid blocks stands at default settings") {
  std::string text = head_text({0, -kG}, 30, 2000) + box("ground", -2, 2, -1, 0, "fixed");
  for (int k = 0; k < 100; ++k)
    text += box(fmt::format("b{}", k), -0.5, 0.5, 0.5 * k, 0.5 * (k + 1), "rigid");
  // each joint closes by 1e-5 of its length of 1 m where it bears the weight of all 100; by less in steps in which blocks would
  // swing on that (theory 4.22), as in those of "auto"
  double closed = 0;
  for (int k = 1; k <= 100; ++k) closed += 1e-5 * k / 100;
  for (const std::string step : {"", "time_step = \"2 ms\"\n"}) {
    double foot = 0, moved = 0, dt = 0;
    run_case(
        text +
            "[[stage]]\nname = \"stand\"\nkind = \"dynamic\"\nduration = \"1 s\"\ndamping_mass = \"5 1/s\"\n" +
            step,
        {}, [&](const Instant& i) {
          if (!i.last) return;
          dt = i.work.clock.dt;
          for (const Patch& c : i.state.patches)
            if (i.scene.blocks.name[c.block_a] == "ground") foot += c.force[0][0] + c.force[1][0];
          for (const Vec2 d : i.state.displacement) moved = std::max(moved, norm(d));
        });
    check_close("tower of 100: force at its foot [N]", foot, 100 * 0.5 * 2000 * kG, 1e-3, 1e-5);
    if (step.empty()) {
      // each of two points by a thousandth of what its blocks yield in the step, 4/m apiece: two between blocks, one on the ground
      const double joints = 2 * 99 * 100 / 2 + 100;
      check_close("tower of 100: its top sinks in steps of its own by [m]", moved,
                  joints * kG * dt * dt * 4 / (2 * 1000), 1e-2, 1e-3);
    } else {
      check_close("tower of 100: its top sinks by [m]", moved, closed, 1e-2, 1e-4);
    }
  }
}

TEST_SUITE_BEGIN("optimised");

TEST_CASE("a wall of rigid bricks with two windows, upright and tilted, at default settings") {
  for (const double tilt : {0.0, 20.0, 28.0}) {
    int bricks = 0;
    const std::string text = wall_text(tilt, bricks);
    CHECK(bricks > 180);
    double farthest = 0;
    bool valid = false;
    std::optional<Auditor> audit;
    const CaseResult r =
        run_case(text + "[[stage]]\nname = \"tilted\"\nkind = \"dynamic\"\nduration = \"1.5 s\"\n", {},
                 [&](const Instant& i) {
                   if (!audit) audit.emplace(i.scene);
                   audit->at(i, false);
                   if (!i.last) return;
                   for (const Vec2 d : i.state.displacement) farthest = std::max(farthest, norm(d));
                   valid = audit->report().valid();
                 });
    CHECK(valid);
    const std::string what = fmt::format("wall tilted by {:g} deg: ", tilt);
    check_below(what + "farthest motion of a brick [m]", farthest, 1e-3, 1e-4);
    check_below(what + "energy left over / largest term", r.run.closure(), 1e-2, 1e-6);
  }
}

TEST_SUITE_END();

}  // namespace test_contact_give
