#include "talus/results/problem_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/json_depth.h"
#include "talus/base/json_number.h"
#include "talus/base/text_file.h"

namespace talus {

namespace {

using nlohmann::ordered_json;

constexpr int kFormat = 4;

// JSON knows no infinity: an open bound is null.
ordered_json bound(double v) { return std::isfinite(v) ? ordered_json(v) : ordered_json(nullptr); }
double bound(const ordered_json& j, double open) { return j.is_null() ? open : j.get<double>(); }

ordered_json vec(Vec2 v) { return {v.x, v.y}; }
Vec2 vec(const ordered_json& j) { return {j.at(0), j.at(1)}; }
ordered_json mat(const Mat2& m) { return {m.xx, m.xy, m.yx, m.yy}; }
Mat2 mat(const ordered_json& j) { return {j.at(0), j.at(1), j.at(2), j.at(3)}; }

ordered_json point_json(const PointRows& p, const Impulse& guess) {
  ordered_json rows = ordered_json::array();
  for (int k = 0; k < 2; ++k) {
    rows.push_back({{"bias", p.row[k].bias}, {"compliance", p.row[k].compliance}});
  }
  return {{"a", p.block_a},          {"b", p.block_b},
          {"arm_a", vec(p.arm_a)},   {"arm_b", vec(p.arm_b)},
          {"normal", vec(p.normal)}, {"rows", rows},
          {"lower", bound(p.lower)}, {"upper", bound(p.upper)},
          {"friction", p.friction},  {"cohesion", bound(p.cohesion)},
          {"partner", p.partner},    {"guess", {guess[0], guess[1]}}};
}

PointRows read_point(const ordered_json& j) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  PointRows p;
  p.block_a = whole_number(j.at("a")), p.block_b = whole_number(j.at("b"));
  p.arm_a = vec(j.at("arm_a")), p.arm_b = vec(j.at("arm_b")), p.normal = vec(j.at("normal"));
  for (size_t k = 0; k < 2; ++k) {
    const ordered_json& r = j.at("rows").at(k);
    p.row[k] = {r.at("bias"), r.at("compliance")};
  }
  p.lower = bound(j.at("lower"), -infinity), p.upper = bound(j.at("upper"), infinity);
  p.friction = j.at("friction"), p.cohesion = bound(j.at("cohesion"), infinity);
  p.partner = whole_number(j.at("partner"));
  return p;
}

ordered_json mobility_json(const Mobility& m) {
  return {{"mass", m.mass},
          {"stretch", m.stretch},
          {"shear", m.shear},
          {"left", vec(m.left)},
          {"right", vec(m.right)}};
}

Mobility read_mobility(const ordered_json& j) {
  Mobility m;
  m.mass = j.at("mass");
  for (size_t k = 0; k < 3; ++k) m.stretch[k] = j.at("stretch").at(k), m.shear[k] = j.at("shear").at(k);
  m.left = vec(j.at("left")), m.right = vec(j.at("right"));
  return m;
}

}  // namespace

std::string problem_text(const Instant& i) {
  const BlockSet& b = i.scene.blocks;
  ordered_json j = {{"talus_problem", kFormat},
                    {"title", i.scene.model.title},
                    {"t [s]", i.state.time},
                    {"step", i.state.step},
                    {"dt [s]", i.work.clock.dt}};
  j["blocks"] = ordered_json::array();
  for (int k = 0; k < b.count; ++k) {
    j["blocks"].push_back({{"name", b.name[k]},
                           {"mobility", mobility_json(i.work.mobility[k])},
                           {"velocity", vec(i.work.rate_given()[k].a)},
                           {"gradient_rate", mat(i.work.rate_given()[k].G)}});
    if (!b.tile.empty()) j["blocks"].back()["tile"] = b.tile[k];
  }
  const RowKinds kinds = row_kinds(i.scene, i.work);
  j["hard_ties"] = kinds.hard_ties;
  j["give"] = kinds.give;
  j["at_rest"] = kinds.at_rest;
  j["points"] = ordered_json::array();
  for (size_t r = 0; r < i.work.rows.points.size(); ++r)
    j["points"].push_back(point_json(i.work.rows.points[r], i.work.guess[r]));
  return j.dump(1) + "\n";
}

Replay replay_problem(const std::filesystem::path& file, const SolverInput& options, double tolerance) {
  const std::string text = read_text_file(file);
  Replay replay;
  try {
    const ordered_json j = ordered_json::parse(checked_json("it", text));
    if (j.at("talus_problem") != kFormat)
      throw std::runtime_error(fmt::format("its format is not {}", kFormat));
    std::vector<BlockRate> rate;
    std::vector<Mobility> mobility;
    std::vector<int> tile;
    for (const ordered_json& b : j.at("blocks")) {
      if (b.contains("tile")) tile.push_back(whole_number(b.at("tile")));
      mobility.push_back(read_mobility(b.at("mobility")));
      rate.push_back({vec(b.at("velocity")), mat(b.at("gradient_rate"))});
    }
    const auto blocks = count_of(mobility);
    const auto known = [blocks](int t) { return t >= 0 && t < blocks; };
    if (!tile.empty() && (tile.size() != mobility.size() || !std::all_of(tile.begin(), tile.end(), known)))
      throw std::runtime_error("the tiles of its blocks are not one of each, from 0 up");
    for (const ordered_json& p : j.at("points"))
      replay.rows.add(read_point(p), {p.at("guess").at(0), p.at("guess").at(1)});
    const auto points = count_of(replay.rows.points);
    for (const PointRows& p : replay.rows.points)
      if (p.block_a < 0 || p.block_a >= blocks || p.block_b >= blocks || p.partner >= points)
        throw std::runtime_error("a point names a block or partner that is not there");
    for (int i = 0; i < points; ++i) {
      const int partner = replay.rows.points[i].partner;
      if (partner >= 0 && replay.rows.points[partner].partner != i)
        throw std::runtime_error(fmt::format("point {} is not the partner of its partner", i));
    }
    const double dt = j.at("dt [s]");
    if (!(dt > 0)) throw std::runtime_error("its time step is not positive");
    const int hard_ties = whole_number(j.at("hard_ties"));
    if (hard_ties < 0) throw std::runtime_error("it has fewer than no hard ties");
    const RowKinds kinds{static_cast<size_t>(hard_ties), j.value("give", false), j.value("at_rest", false)};
    replay.points = points, replay.blocks = blocks;
    Model model;
    model.solver = options;
    std::vector<BlockRate> after = rate;
    std::vector<Impulse> guess;
    SolverSet solvers;
    Profile profile;
    const StepProblem problem{mobility, rate, dt, {}, replay.rows, after, profile, tile};
    replay.solved = solve_step(model, kinds, tolerance, 0, 1, false, Workers(), solvers, problem, guess);
  } catch (const std::exception& e) {
    throw FileError(
        fmt::format("{}: is no step written by talus run --dump-step: {}", file.string(), e.what()));
  }
  return replay;
}

}  // namespace talus
