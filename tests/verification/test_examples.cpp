// Every example runs, and gives the number that its README quotes.

#include "support/run_case.h"
#include "support/source_file.h"
#include "support/tolerance.h"
#include "talus/record/read_record.h"
#include "talus/schema/toml_source.h"

namespace test_examples {

using namespace talus;
using namespace talus::test;

namespace {

CaseResult run_example(const std::string& name, const std::function<void(const Instant&)>& watch = nullptr) {
  const std::string file = source_file(fmt::format("examples/{0}/{0}.toml", name));
  return run_case(read_text_file(file), {}, watch, nullptr, file);
}

}  // namespace

TEST_CASE("example wave_column: the pulse doubles at the free end") {
  const CaseResult r = run_example("wave_column");
  const auto &t = r.column("t [s]"), &end = r.column("free_end.velocity_x"),
             &middle = r.column("middle.velocity_x");
  size_t top = 0;
  for (size_t i = 0; i < t.size() && t[i] < 6e-3; ++i)  // before the reflection returns
    if (middle[i] > middle[top]) top = i;
  // samples at every 70 us miss the top of a 1.4 ms half-sine by up to 0.3 %
  check_close("wave_column free end [m/s]", *std::max_element(end.begin(), end.end()), 2, 1e-2, 5e-3);
  check_close("wave_column peak at the middle [s]", t[top], 10 / 2828.42712 + 0.5 * 1.41421356e-3, 7.1e-5,
              4e-5, 1);
  check_below("wave_column energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("example pull_apart: breaks once at tensile strength x area") {
  bool broken = false;
  double force_after = 0;
  const CaseResult r = run_example("pull_apart", [&](const Instant& i) {
    if (i.state.face[0].broken) broken = true;
    if (broken) force_after = std::max(force_after, std::abs(i.state.bond_force[0][0]));
  });
  const auto& f = r.column("joint.normal_force");
  check_close("pull_apart largest pull of the joint [N]", *std::min_element(f.begin(), f.end()), -500e3, 1e-9,
              1e-12);
  CHECK(r.run.broken_faces == 1);
  CHECK(force_after == 0);
  CHECK(f.back() == 0);
  check_below("pull_apart energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("example shaken_tower: carries its weight at rest, then follows the base") {
  double at_rest = 0, slip = 0, start = 0;
  const CaseResult r = run_example("shaken_tower", [&](const Instant& i) {
    if (i.stage != 1) return;
    const int base = 0, tower = 1;  // the driven block comes first, then the lowest cell
    const double foot =
        displacement_at(i.state, tower, i.scene.blocks.corner({tower, 0})).x - i.state.displacement[base].x;
    if (i.stage_start) {
      start = foot;
      for (const Patch& c : i.state.patches) at_rest += c.force[0][0] + c.force[1][0];
    }
    slip = std::max(slip, std::abs(foot - start));
  });
  check_close("shaken_tower footing at rest [N]", at_rest, 39240, 1e-5, 1e-6);
  // contacts give by less than a millionth of a cell
  check_below("shaken_tower slip of the foot on its base [m]", slip, 5e-7, 1e-7);
  CHECK(r.run.stages[0].at_rest);
  check_below("shaken_tower energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("example spinning_block: mean and first peak of the centrifugal stress") {
  const CaseResult r = run_example("spinning_block");
  const auto& s = r.column("spinner.stress_xx");
  double mean = 0;
  for (const double v : s) mean += v / static_cast<double>(s.size());
  // mean over some 200 breaths, not a whole number of them: 1/200
  check_close("spinning_block mean stress [Pa]", mean, 83333.3, 5e-3, 1e-3);
  check_close("spinning_block peak stress [Pa]", *std::max_element(s.begin(), s.end()), 166666.7, 2e-3, 1e-3);
  check_below("spinning_block energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("example sliding_block: slip on a table that shakes sideways and up and down") {
  // A2d of the verification plan, a = 0.8, b = 0.4, f = 1 Hz; reference good to 5e-4
  const CaseResult r = run_example("sliding_block");
  const auto& x = r.column("block.displacement_x");
  check_close("sliding_block slip after 0.5 s [m]", x[500], -0.019300, 2e-3, 2e-5, 1);
  check_close("sliding_block slip after 1 s [m]", x[1000], 0.242553, 1e-3, 1e-4);
  check_close("sliding_block slip after 5 s [m]", x[5000], 1.423471, 1e-3, 1e-4);
  check_below("sliding_block energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE(
    "example record: slip of a block in a synthetic earthquake, seen from the ground and from the table") {
  const CaseResult r = run_example("record");
  const auto &block = r.column("block.displacement_x"), &table = r.column("table.displacement_x"),
             &block_2 = r.column("block_2.displacement_x");

  // rigid block with Coulomb friction: w' = -a - mu g sign(w), stuck while |a| <= mu g; the acceleration of
  // the file is linear between its samples. Steps of 10 us: 1e-5 s x 1 m/s of slip
  const record::Record motion = record::read_record(source_file("examples/record/motion.csv"));
  const double limit = 9.81 * std::tan(20 * M_PI / 180), h = 1e-5;
  const int fine = 1000;  // steps per sample; the run takes 10
  double w = 0, slip = 0, worst_2 = 0, worst = 0, largest = 0;
  for (size_t i = 0; i + 1 < motion.value.size(); ++i) {
    for (int k = 0; k < fine; ++k) {
      const double a = motion.value[i] + (motion.value[i + 1] - motion.value[i]) * (k + 0.5) / fine;
      const double before = w;
      if (w == 0)
        w = std::abs(a) <= limit ? 0 : h * (-a - std::copysign(limit, -a));
      else if (w += h * (-a - std::copysign(limit, w)); w * before < 0)
        w = 0;
      slip += 0.5 * h * (before + w);
    }
    largest = std::max(largest, std::abs(slip));
    worst_2 = std::max(worst_2, std::abs(block_2[10 * (i + 1)] - slip));
    worst = std::max(worst, std::abs(block[10 * (i + 1)] - table[10 * (i + 1)] - slip));
  }
  check_close("record slip after 20 s, by the load [m]", block_2[20000], slip, 1e-4, 2e-5, 1);
  check_below("record slip by the load, largest error at any time [m]", worst_2, 1e-4, 2e-5);
  // velocities of the file are joined by straight lines: steps of acceleration, off by up to half a change
  // per sample
  check_below("record slip on the moving table, largest error at any time [m]", worst, 1e-3, 5e-4);
  check_below("record energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("example elastic_joint: sinks, slips and leans as calculated by hand") {
  // W/(kn A); W_x/(ks A) + (W_x/2)/(kn/12) x 1/2. The leaning weight adds its own moment: 1.4e-4 of the
  // leaning part
  const CaseResult r = run_example("elastic_joint");
  check_close("elastic_joint settlement [m]", r.column("centre.displacement_y").back(), -2600 * 9 / 1e9, 2e-4,
              1e-5);
  check_close("elastic_joint sideways [m]", r.column("centre.displacement_x").back(),
              2600 * 2 / 0.5e9 + 3 * 2600 * 2 / 1e9, 2e-4, 1e-4);
  check_below("elastic_joint energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("example bouncing_block: the coefficient of restitution") {
  // half a step of 0.1 ms in 0.2 s of flight
  const CaseResult r = run_example("bouncing_block");
  const auto& y = r.column("block.displacement_y");
  check_close("bouncing_block height after the bounce [m]",
              *std::max_element(y.begin() + 4500, y.begin() + 8000) + 0.8, 0.2, 2e-3, 1e-3);
  check_below("bouncing_block energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("example creeping_block: the smoothed friction law creeps, the faster the smaller the step") {
  // epsilon2 tan(pi m / 2) / dt with m = tan 20 / tan 30
  const double share = std::tan(20 * M_PI / 180) / std::tan(30 * M_PI / 180);
  for (const double dt : {1e-3, 1e-4}) {
    const CaseResult r = run_case(read_text_file(source_file("examples/creeping_block/creeping_block.toml")),
                                  {fmt::format("stage.stand.time_step={}", dt)});
    check_close(fmt::format("creeping_block velocity at dt = {:g} s [m/s]", dt),
                r.column("block.velocity_x").back(), 6e-8 * std::tan(M_PI * share / 2) / dt, 1e-2, 1e-3);
  }
  const CaseResult exact =
      run_case(read_text_file(source_file("examples/creeping_block/creeping_block.toml")),
               {"contact={joint=\"face\"}"});
  // contacts give, once, by far less than a millionth of the block
  const auto& x = exact.column("block.displacement_x");
  check_below("creeping_block with the exact law, elastic slip [m]", std::abs(x.back()), 1e-7, 1e-8);
  check_below("creeping_block with the exact law, slip after half of the run [m]",
              std::abs(x.back() - x[x.size() / 2]), 1e-12, 1e-15);
}

TEST_CASE("example incline: slip after 1 s") {
  const CaseResult r = run_example("incline");
  const double t = M_PI / 180, exact = 0.5 * 9.81 * (std::sin(30 * t) - std::tan(15 * t) * std::cos(30 * t));
  // the file gives coordinates to 1e-9 m
  check_close("incline slip after 1 s [m]",
              std::hypot(r.column("block.displacement_x").back(), r.column("block.displacement_y").back()),
              exact, 1e-6, 1e-8);
}

TEST_CASE("example rocking_block: first impact") {
  const CaseResult r = run_example("rocking_block");
  const auto &t = r.column("t [s]"), &x = r.column("top.displacement_x");
  // upright when the top has moved back by its tilt, 1.9 m sin 7.02 deg - 0.25 (1 - cos): from there on it
  // leans over the other corner
  const double upright =
      0.25 - (0.25 * std::cos(0.5 * std::atan(0.25)) - 1.9 * std::sin(0.5 * std::atan(0.25)));
  size_t i = 0;
  while (i < x.size() && x[i] < upright) ++i;
  REQUIRE(i < x.size());
  check_close("rocking_block first impact [s]", t[i], 0.4938, 1e-2, 3e-3);
  check_below("rocking_block energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("example arch: the springings carry the weight and the same thrust") {
  const CaseResult r = run_example("arch");
  const double area = 15 * 0.5 * std::sin(M_PI / 15) * (5.375 * 5.375 - 4.625 * 4.625);
  const double half = 0.5 * area * 2400 * 9.81;
  check_close("arch left springing [N]", r.column("left.force_y").back(), half, 1e-4, 1e-5);
  check_close("arch right springing [N]", r.column("right.force_y").back(), half, 1e-4, 1e-5);
  check_close("arch thrust left and right [N]", r.column("left.force_x").back(),
              -r.column("right.force_x").back(), 1e-4, 1e-5);
  CHECK(r.run.stages[0].at_rest);
  check_below("arch energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_SUITE_BEGIN("optimised");

TEST_CASE("example dominoes: all ten fall") {
  const CaseResult r = run_example("dominoes");
  for (int i = 1; i <= 10; ++i) CHECK(r.column(fmt::format("top_{}.displacement_x", i)).back() > 0.025);
  CHECK(r.column("top_10.displacement_x").back() > 0.045);
  check_below("dominoes energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("example pile: no stone inside another, comes to rest, the same bits twice") {
  std::vector<double> bits[2];
  for (std::vector<double>& run : bits) {
    double beyond = 0,
           at_frame = 0;  // deepest overlap: at any step, as share of the allowed one; at frames, of the slop
    const CaseResult r = run_example("pile", [&](const Instant& i) {
      const double least = *std::min_element(i.scene.blocks.size.begin(), i.scene.blocks.size.end());
      // the arc that a corner or an edge leaves its tangent by in a step: 1/2 (dt spin)^2 of the arm
      // (theory 3.3)
      const auto arc = [&](int block) {
        const double turn = i.plan.dt * i.work.rate_before[block].G.yx;
        return 0.5 * turn * turn * i.scene.blocks.size[block];
      };
      for (size_t n = 0; n < 2 * i.state.patches.size(); ++n) {
        const double gap = i.work.gaps[n];
        const int a = i.state.patches[n / 2].block_a, b = i.state.patches[n / 2].block_b;
        const double size = std::min(i.scene.blocks.size[a], i.scene.blocks.size[b]);
        const double allowed =
            i.scene.model.contact.slop * size + i.scene.model.solver.tolerance * least + arc(a) + arc(b);
        beyond = std::max(beyond, -gap / allowed);
        const double slop = i.scene.model.contact.slop * size;
        if (i.state.step % 250 == 0) at_frame = std::max(at_frame, -gap / slop);
      }
    });
    // not yet: a corner that comes over another one within a step is not always foreseen; it keeps what it has gone in by
    // for a while (theory 3.3). One run is a sample: with gravity that differs in the tenth digit the first is 7 to 27, the
    // second 0.5 to 37, 0.01 to 0.8 % of a stone (docs/limits.md)
    check_below("pile deepest overlap / (slop + tolerance + arc of the step)", beyond, 40, 0.9);
    check_below("pile deepest overlap at a frame / stated slop", at_frame, 40, 0.9);
    check_below("pile kinetic energy at the end / energy of the fall",
                r.run.energy.kinetic / r.run.energy.gravity, 1e-6, 1e-9);
    check_below("pile energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
    for (const Vec2 d : r.state.displacement) run.push_back(d.x), run.push_back(d.y);
    run.insert(run.end(), r.state.angle.begin(), r.state.angle.end());
  }
  CHECK(bits[0] == bits[1]);
}

TEST_SUITE_END();

TEST_CASE("example shaken_wall: nothing slips in a wall that friction can carry") {
  const CaseResult r = run_example("shaken_wall");
  // rigid bricks would not move at all; what is left is elastic slip of joints that locked on the way, below
  // the sway of 0.2 mm that shear of the wall makes; asked for 1k bricks: 0.1 mm. Sweeps end at a tenth of
  // the tolerance
  check_below("shaken_wall drift of the top after 1 s at 0.3 g [m]",
              std::abs(r.column("top.displacement_x").back()), 1e-4, 5e-5);
  check_below("shaken_wall contact error / tolerance", r.run.worst_error / (1e-5 * 0.5), 1, 0.2);
  check_below("shaken_wall energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("example absorbing_bar: the wave leaves, and takes its energy along") {
  const CaseResult r = run_example("absorbing_bar");
  const auto &t = r.column("t [s]"), &v = r.column("middle.velocity_x");
  double left = 0;
  for (size_t i = 0; i < t.size(); ++i)
    if (t[i] > 11e-3) left = std::max(left, std::abs(v[i]));
  // the wave is 20 blocks long, its kinks shorter: some dispersion
  check_close("absorbing_bar velocity past the middle [m/s]", *std::max_element(v.begin(), v.end()), 1, 1e-2,
              1e-3);
  check_below("absorbing_bar velocity left in the middle [m/s]", left, 1e-2, 5e-3);
  check_close("absorbing_bar displacement left [m]", r.column("middle.displacement_x").back(),
              2 / 3.14159265358979 * 1.41421356e-3, 5e-3, 1e-3);
  check_close("absorbing_bar work of the push [J]", r.run.energy.work[Cause::kLoads], 1000, 1e-2, 1e-3);
  check_close("absorbing_bar work of the edge [J]", r.run.energy.work[Cause::kBoundary], -1000, 1e-2, 1e-3);
  check_below("absorbing_bar energy left over / largest term", r.run.closure(), 1e-2, 1e-9);
}

TEST_CASE("example soil_layer: surface motion of the wave series") {
  const CaseResult r = run_example("soil_layer");
  const auto largest = [&r](const char* column) {
    const auto& v = r.column(column);
    return *std::max_element(v.begin(), v.end());
  };
  check_close("soil_layer surface along x [m/s]", largest("surface.velocity_x"), 0.20520, 2e-2, 5e-3);
  check_close("soil_layer surface along y [m/s]", largest("surface.velocity_y"), 0.09571, 2e-2, 5e-3);
  check_below("soil_layer energy left over / largest term", r.run.closure(), 1e-2, 1e-6);
}

TEST_CASE("example hammer: the waves leave through the edges") {
  double most = 0, last = 0;
  const CaseResult r = run_example("hammer", [&](const Instant& i) {
    last = i.report.energy.kinetic;
    most = std::max(most, last);
  });
  check_below("hammer kinetic energy left / largest", last / most, 1e-2, 1e-3);
  check_close("hammer work of the edges / work of the blow",
              r.run.energy.work[Cause::kBoundary] / r.run.energy.work[Cause::kLoads], -1, 1e-2, 1e-3);
  check_below("hammer energy left over / largest term", r.run.closure(), 1e-2, 1e-6);
}

TEST_CASE("example hammer has the same bits for any number of threads") {
  const std::string text = read_text_file(source_file("examples/hammer/hammer.toml"));
  std::vector<State> end;
  for (const int threads : {1, 3}) {
    Findings findings("hammer.toml", text);
    PreparedRun run = prepare_run("hammer.toml", text, {"stage.blow.duration=30 ms"}, findings);
    end.push_back(start_state(run.scene));
    MemoryObserver observer(run.scene, nullptr);
    run_stages(run.scene, run.plans, end.back(), observer, Workers(threads));
  }
  bool same = end[0].boundaries == end[1].boundaries;
  for (size_t i = 0; i < end[0].displacement.size(); ++i)
    same = same && end[0].displacement[i] == end[1].displacement[i];
  CHECK(same);
}

TEST_CASE("example blast_hole: the rock keeps still until the blast, which leaves through the edges" *
          doctest::test_suite("optimised")) {
  double before = 0, most = 0, last = 0, near = 0, far = 0;
  const auto speed = [](const Instant& i, Vec2 at) {
    const int k = block_of_point(i.scene.layout, at);
    return velocity_at(rate_now(i.work, i.state, k), at - i.scene.blocks.centroid[k]).x;
  };
  const CaseResult r = run_example("blast_hole", [&](const Instant& i) {
    if (i.stage != 1) return;
    if (i.stage_start) before = i.report.energy.kinetic;
    last = i.report.energy.kinetic;
    most = std::max(most, last);
    near = std::max(near, speed(i, {4, 0})), far = std::max(far, speed(i, {12, 0}));
  });
  check_below("blast_hole kinetic energy before / largest", before / most, 1e-6, 1e-8);
  // what opened joints keep moving, most of it crumbs at the wall of the hole
  check_below("blast_hole kinetic energy left / largest", last / most, 3e-2, 2.8e-2);
  // no formula: what the example's README quotes
  check_close("blast_hole velocity past 4 m [m/s]", near, 0.2623, 1e-2, 1e-3);
  check_close("blast_hole velocity past 12 m [m/s]", far, 0.1258, 1e-2, 1e-3);
  check_close("blast_hole faces that lose their cohesion", r.run.broken_faces, 163, 2e-2, 1e-12);
  check_below("blast_hole energy left over / largest term", r.run.closure(), 1e-2, 1e-6);
}

TEST_SUITE_BEGIN("optimised");

TEST_CASE("example shaken_slope: the rock above the bedding slides out, the wedge at the crest farthest") {
  std::vector<Vec2> start;  // displacement of each block as shaking begins
  double base = 0, crest = 0, slip = 0;
  Vec2 base_start, crest_start, behind_start, base_end, crest_end, behind_end;
  const CaseResult r = run_example("shaken_slope", [&](const Instant& i) {
    if (i.stage != 1 || !(i.stage_start || i.last)) return;
    if (i.stage_start) start = i.state.displacement;
    const auto moved = [&](Vec2 point) {
      const int b = block_of_point(i.scene.layout, point);
      return displacement_at(i.state, b, point - i.scene.blocks.centroid[b]);
    };
    (i.last ? base_end : base_start) = moved({45, 0.1});
    (i.last ? crest_end : crest_start) = moved({54, 41.9});
    (i.last ? behind_end : behind_start) = moved({85, 41.9});
    if (!i.last) return;
    for (const ContactPair& p : i.state.pairs) {
      const int a = p.a, b = p.b;
      slip =
          std::max(slip, norm((i.state.displacement[a] - start[a]) - (i.state.displacement[b] - start[b])));
    }
  });
  CHECK(r.run.stages[0].at_rest);
  const auto &b = r.column("base.velocity_x"), &c = r.column("crest.velocity_x");
  for (size_t i = 0; i < b.size(); ++i) {
    base = std::max(base, std::abs(b[i]));
    crest = std::max(crest, std::abs(c[i] - b[i]));
  }
  // no formula: what the README quotes. Steps of 0.3 and 0.15 ms put the crest at -0.343 and -0.337 m, the slip left at 0.309 and
  // 0.319 m (theory 4.9)
  check_close("shaken_slope largest velocity of the base [m/s]", base, 0.347, 1e-2, 2e-3);
  check_close("shaken_slope largest velocity of the crest to the base [m/s]", crest, 0.429, 2e-2, 1e-2);
  check_close("shaken_slope crest to base at the end [m]",
              (crest_end - crest_start - base_end + base_start).x, -0.344, 4e-2, 1e-2);
  check_close("shaken_slope ground behind to base at the end [m]",
              (behind_end - behind_start - base_end + base_start).x, -0.075, 4e-2, 1e-2);
  check_close("shaken_slope largest slip between neighbours [m]", slip, 0.437, 5e-2, 1e-2);
  check_below("shaken_slope energy left over / largest term", r.run.closure(), 1e-2, 1e-5);
}

TEST_CASE("shaken slope: half the step is the same answer") {
  const std::string file = source_file("examples/shaken_slope/shaken_slope.toml"),
                    text = read_text_file(file);
  std::vector<double> crest;
  for (const char* step : {"1 ms", "0.5 ms"}) {
    const CaseResult r =
        run_case(text, {"stage.shake.duration=7 s", fmt::format("new:stage.shake.time_step={}", step)},
                 nullptr, nullptr, file);
    const double begin = r.run.stages.at(1).begin;
    const std::vector<double>& t = r.column("t [s]");
    const auto at = static_cast<size_t>(std::lower_bound(t.begin(), t.end(), begin - 1e-9) - t.begin());
    const auto way = [&](const char* axis) {
      const std::vector<double>& u = r.column(std::string("crest.displacement_") + axis);
      return u.back() - u.at(at);
    };
    crest.push_back(std::hypot(way("x"), way("y")));
  }
  // 0.23 m in 7 s of shaking, sliding and rocking. Where only alpha damps the blocks half the step makes it 15 to 20 % more
  // (theory 4.9)
  check_close("shaken slope, crest at half the step / crest", crest[1] / crest[0], 1, 0.05, 0.01);
}

TEST_SUITE_END();

TEST_CASE("example bolted_slope: the bolts hold what would slide") {
  const CaseResult r = run_example("bolted_slope");
  const auto& slip = r.column("head.displacement_x [m]");
  check_close("bolted_slope slip of the slab [m]", slip.back(), -0.490e-3, 5e-2, 5e-2);
  check_close("bolted_slope tension of the anchor [N]", r.column("toe.axial_force [N]").back(), 51.8e3, 2e-2,
              2e-2);
  check_close("bolted_slope tension of a grouted bar [N]", r.column("row.axial_force [N]").back(), 56.2e3,
              5e-2, 5e-2);
  CHECK(r.column("toe.ruptured").back() + r.column("row.ruptured").back() == 0);
  // the last half second is two periods of the shaking or more: no creep
  check_close("bolted_slope slip at half time / at the end", slip[slip.size() / 2], slip.back(), 0.3, 0.3);
  check_below("bolted_slope energy left over / largest term", r.run.closure(), 1e-2, 1e-6);
}

TEST_CASE("example bolted_tunnel comes to rest, no bolt yields") {
  const CaseResult r = run_example("bolted_tunnel", [](const Instant& i) {
    if (!i.last) return;
    int crossings = 0, pieces = 0;
    for (const BoltPart& p : bolt_parts(i.scene.blocks, i.state)) {
      CHECK(p.condition == BoltPart::kElastic);
      crossings += p.crossing, ++pieces;
    }
    CHECK(crossings == 14);
    CHECK(i.scene.model.bolts.size() == 12);
    // what the bar passes on at a crossing is what its statics say, once nothing moves
    const Bolt& bolt = i.state.bolts[0];
    const auto parts = bolt_parts(i.scene.blocks, i.state);
    size_t k = 0;
    while (k < bolt.segments.size() && !parts[k].crossing) ++k;
    REQUIRE(k < bolt.segments.size());
    check_close("bolted_tunnel row / statics", parts[k].axial, bolt.segments[k].force / bolt.share, 1e-3,
                1e-5);
  });
  check_below("bolted_tunnel energy left over / largest term", r.run.closure(), 1e-2, 1e-6);
}

TEST_CASE("example direct_shear: slips either way at its strength, sticks between") {
  const CaseResult r = run_example("direct_shear");
  const std::vector<double>&force = r.column("box.reaction_x [N]"),
        &way = r.column("upper.displacement_x [m]"), &clock = r.column("dynamic_time [s]");
  const double most = 200e3 * std::tan(std::numbers::pi / 6), stiffness = 4e9 * 0.2;
  check_close("direct_shear force that slips [N]", *std::max_element(force.begin(), force.end()), most, 1e-4,
              1e-5);
  check_close("direct_shear force that slips back [N]", *std::min_element(force.begin(), force.end()), -most,
              1e-4, 1e-5);
  CHECK(r.run.stages[1].balances == 101);
  // unloading from the first turn, where a balance stands: a row is off by a thousandth of the step's way at most
  for (size_t i = 0; i < clock.size(); ++i)
    if (clock[i] > 1.01 && clock[i] < 1.25)
      check_close(fmt::format("direct_shear unloading at {:g} s [N]", clock[i]), force[i],
                  most - stiffness * (1e-3 - way[i]), 1e-4, 1e-5, most);
}

TEST_CASE("example rough_joint: breaks, weakens, rides up") {
  const CaseResult r = run_example("rough_joint");
  const double t = M_PI / 180, n = 100e3 + 2500 * 0.2 * 9.81;
  const auto &push = r.column("push.reaction_x"), &y = r.column("upper.displacement_y");
  const double residual = 5e3 + n * std::tan(30 * t);
  // a step of 5 um and less is 5 kN of elastic shear; the limit is judged after it
  check_close("rough_joint force at which it breaks [N]", *std::max_element(push.begin(), push.end()),
              50e3 + n * std::tan(40 * t), 4e-2, 1e-2);
  check_close("rough_joint force at the end [N]", push.back(), residual, 1e-3, 1e-6);
  check_close("rough_joint rise over the closed joint [m]", y.back() + n / 10e9, 5e-3 * std::tan(5 * t), 1e-3,
              1e-6);
  for (const Patch& c : r.state.patches)
    check_close("rough_joint slip [m]", c.slip[0], 10e-3 - residual / 1e9, 1e-3, 1e-6);
  CHECK(r.run.broken_faces == 1);
  check_below("rough_joint energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

}  // namespace test_examples
