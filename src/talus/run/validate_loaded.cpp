#include "talus/run/validate_loaded.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "talus/base/index.h"
#include "talus/blocks/state_fields.h"
#include "talus/step/change.h"

namespace talus {

namespace {

void promise_loaded(bool kept, const std::string& what) {
  if (!kept) throw std::logic_error(what);
}

template <size_t N>
bool is_one_of(std::string_view name, const std::array<std::string_view, N>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Fields of a State by their names in each_field().
constexpr std::array<std::string_view, 9> kMayBeEndless{
    "limit", "yield", "most", "shear_yield", "rupture_strain", "skin", "reach", "reuse", "margin"};
constexpr std::array<std::string_view, 1> kMayBeNoNumber{"anchor"};
constexpr std::array<std::string_view, 19> kNotNegative{
    "time",    "history_time", "dt_before",       "allowed",     "length",         "margin", "skin",
    "reach",   "stiffness",    "limit",           "gauge",       "yield",          "most",   "row_stiffness",
    "relaxed", "share",        "shear_stiffness", "shear_yield", "largest_kinetic"};

// Far more than any run counts, and room for counting on.
constexpr int64_t kMostInt = 1 << 30, kMostCount = int64_t{1} << 60;

// Whoever squares a larger number may get an endless one.
constexpr double kMostNumber = 1e100;

// One number of a field: whether it may be what it is.
void judge_number(const std::string& field, double v) {
  if (is_one_of(field, kMayBeNoNumber) && std::isnan(v)) return;
  const bool endless = is_one_of(field, kMayBeEndless);
  promise_loaded(std::abs(v) <= kMostNumber || (endless && std::isinf(v)),
                 fmt::format("\"{}\" is {}", field, v));
  promise_loaded(v >= 0 || !is_one_of(field, kNotNegative), fmt::format("\"{}\" is {}", field, v));
}

template <class T>
concept Fielded = requires(T& value) {
  each_field(value, [](const char*, auto&) {});
};

template <class T>
inline constexpr bool kIsVector = false;
template <class T>
inline constexpr bool kIsVector<std::vector<T>> = true;

void judge_field(const std::string& field, const auto& value) {
  using T = std::remove_cvref_t<decltype(value)>;
  if constexpr (Fielded<const T>) {
    each_field(value, [](const char* name, auto& member) { judge_field(name, member); });
  } else if constexpr (kIsVector<T>) {
    for (const auto& element : value) judge_field(field, element);
  } else if constexpr (std::is_floating_point_v<T>) {
    judge_number(field, value);
  } else if constexpr (std::is_same_v<T, int> || std::is_same_v<T, int64_t>) {
    const int64_t most = std::is_same_v<T, int> ? kMostInt : kMostCount;
    promise_loaded(value >= -most && value <= most, fmt::format("\"{}\" is {}", field, value));
  } else if constexpr (!std::is_arithmetic_v<T> && !std::is_enum_v<T>) {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);
    std::array<double, sizeof(T) / sizeof(double)> parts;
    std::copy_n(reinterpret_cast<const double*>(&value), parts.size(), parts.begin());
    for (const double v : parts) judge_number(field, v);
  }
}

bool is_below(int i, size_t count) { return i >= 0 && std::cmp_less(i, count); }

void judge_contacts(const State& s, const Scene& scene) {
  const auto is_side = [&scene](int block, int edge) {
    return edge >= -1 && edge < scene.blocks.vertex_count(block);
  };
  for (const Contact& c : s.contacts) {
    promise_loaded(c.joint < count_of(scene.model.joints),
                   fmt::format("a contact is of joint {}, which there is not", c.joint));
    const auto [lo, hi] = std::minmax(c.key.block_a, c.key.block_b);
    promise_loaded(
        is_side(lo, c.face.side_lo) && is_side(hi, c.face.side_hi) && (c.face.end == 0 || c.face.end == 1),
        "a contact lies on a side that its blocks do not have");
  }
}

void judge_patches(const State& s, const Scene& scene) {
  promise_loaded(s.patches.empty() || scene.by_patches(), "it has patches, and its formulation has none");
  for (const Patch& p : s.patches) {
    const auto joints = count_of(scene.model.joints);
    promise_loaded(
        p.joint < joints && p.other_joint < joints,
        fmt::format("a patch is of joint {}, which there is not", std::max(p.joint, p.other_joint)));
    const auto is_part = [&](int part, int block) {
      return part >= scene.outlines.part_begin[block] && part < scene.outlines.part_begin[block + 1];
    };
    promise_loaded(is_part(p.part_a, p.block_a) && is_part(p.part_b, p.block_b),
                   "a patch lies on a part that its blocks do not have");
    promise_loaded(std::abs(norm(p.normal) - 1) < 1e-6, "the normal of a patch is no unit vector");
  }
}

void judge_bolts(const State& s, const Scene& scene) {
  for (const Bolt& bolt : s.bolts) {
    promise_loaded(is_below(bolt.input, scene.model.bolts.size()),
                   fmt::format("bolt {} is none of the model's", bolt.input));
    for (int k = 0; k < count_of(bolt.crossings); ++k) {
      const int j = bolt.crossings[k].segment;
      promise_loaded(bolt.nodes[j].block != bolt.nodes[j + 1].block, "a bolt crosses the inside of a block");
      promise_loaded(bolt.segments[j].crossing == k, "a segment of a bolt does not know its crossing");
      for (const Vec2 d : bolt.crossings[k].direction)
        promise_loaded(std::abs(norm(d) - 1) < 1e-6, "the direction of a bolt is no unit vector");
      promise_loaded(bolt.crossings[k].row_stiffness > 0, "a bolt crosses a joint without stiffness");
    }
  }
}

// A list of pairs that counts as good still is not made anew: it names no block that has been taken out.
void judge_pairs(const Standing& standing, const State& state, const Scene& scene) {
  if (state.candidates.reach.empty()) return;
  std::vector<char> gone(scene.blocks.count, 0);
  for (int s = 0; s < count_of(standing.result.stages); ++s) {
    const std::vector<char> out = excavated_blocks(scene, s);
    for (size_t k = 0; k < gone.size(); ++k) gone[k] = static_cast<char>(gone[k] | out[k]);
  }
  for (const ContactPair& pair : state.pairs)
    for (const int k : {pair.a, pair.b})
      promise_loaded(gone[k] == 0, fmt::format("block {} touches something, and is excavated by then", k));
}

void judge_clock(const StageInput& stage, const StagePlan& plan, const StageResult& now, const State& state,
                 bool between) {
  if (now.followed()) {
    promise_loaded(stage.may_follow, "it is followed by damped motion in a stage that is not");
    const double dt = plan.dt_follow,
                 time = now.followed_from + dt * static_cast<double>(now.steps - now.steps_from_rest);
    promise_loaded(
        std::abs(state.time - time) <= 1e-3 * dt,
        fmt::format("it stands at {} s, and its stage, followed by motion, at {} s", state.time, time));
    return;
  }
  if (stage.from_rest) {
    promise_loaded(state.rest.length >= 0.99 * plan.dt / kMostShortened &&
                       state.rest.length <= 1.01 * plan.dt * kMostLengthened,
                   fmt::format("\"length\" of its next step is {}", state.rest.length));
    promise_loaded(state.dt_before == 0, "it moves in a stage whose steps begin at rest");
    const int found = state.rest.balances;
    promise_loaded(found == now.balances && found >= 0 && found <= plan.balances &&
                       (between || plan.balances == 0 || found < plan.balances),
                   fmt::format("it has found {} of {} balances", found, plan.balances));
    promise_loaded(state.rest.begin_steps >= 0 && state.rest.begin_steps <= now.steps,
                   "its balance begins after the steps of its stage");
    return;
  }
  // as drift() counts time
  const double time = now.begin + plan.dt * static_cast<double>(now.steps);
  promise_loaded(
      std::abs(state.time - time) <= 1e-3 * plan.dt,
      fmt::format("it stands at {} s, and {} steps of its stage end at {} s", state.time, now.steps, time));
}

void judge_standing(const Standing& standing, const State& state, const PreparedRun& prepared) {
  const Scene& scene = prepared.scene;
  const std::vector<StageResult>& stages = standing.result.stages;
  promise_loaded(!stages.empty() && stages.size() <= scene.model.stages.size(),
                 "it stands in no stage of the model");
  for (size_t i = 0; i < stages.size(); ++i) {
    const StageInput& stage = scene.model.stages[i];
    promise_loaded(stages[i].name == stage.name && stages[i].kind == stage.kind,
                   "its stages are not the model's");
    promise_loaded(stages[i].plan == prepared.plans[i], "the plan of a stage is not the model's");
    promise_loaded(stages[i].steps >= 0, "a stage has taken less than no step");
    promise_loaded(
        std::isfinite(stages[i].begin) && std::isfinite(stages[i].end) && stages[i].begin <= state.time,
        "a stage begins after the state");
  }
  const StagePlan& plan = prepared.plans[stages.size() - 1];
  const StageResult& now = stages.back();
  promise_loaded(now.steps_from_rest >= 0 && now.steps_from_rest <= now.steps &&
                     now.steps - now.steps_from_rest <= (now.followed() ? plan.steps_follow : plan.steps),
                 "its steps are not those of the model");
  judge_clock(scene.model.stages[stages.size() - 1], plan, now, state, standing.between);
  const RunResult& r = standing.result;
  for (const int64_t count :
       {r.steps, r.failed_steps, r.loose_steps, r.ringing_steps, r.second_solver_steps, r.iterations})
    promise_loaded(count >= 0 && count <= kMostCount, "it has counted less than nothing, or endlessly");
  for (const int count : {r.most_contacts, r.most_iterations, r.candidate_rebuilds})
    promise_loaded(count >= 0 && count <= kMostInt, "it has counted less than nothing, or endlessly");
  for (const double most :
       {r.worst_error, r.deepest_drift, r.closed_share, r.largest_left_over, r.largest_energy})
    promise_loaded(most >= 0, "one of its largest values is negative");
}

}  // namespace

void validate_loaded(const Standing& standing, const State& state, const PreparedRun& prepared) {
  judge_field("state", state);
  promise_loaded(state.relaxed <= 1, fmt::format("\"relaxed\" is {}", state.relaxed));
  promise_loaded(state.rest.sharper > 0 && state.rest.sharper <= 1,
                 fmt::format("\"sharper\" is {}", state.rest.sharper));
  for (size_t i = 0; i < state.left_out.size(); ++i)
    promise_loaded(state.left_out[i] >= 0 && state.left_out[i] < prepared.scene.blocks.count &&
                       (i == 0 || state.left_out[i] > state.left_out[i - 1]),
                   fmt::format("\"left_out\" has {}", state.left_out[i]));
  judge_contacts(state, prepared.scene);
  judge_patches(state, prepared.scene);
  judge_bolts(state, prepared.scene);
  judge_standing(standing, state, prepared);
  judge_pairs(standing, state, prepared.scene);
}

}  // namespace talus
