#include "talus/run/resolution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "talus/record/measures.h"

namespace talus {

namespace {

constexpr double kNearZero = 1e-3;  // of the largest value: a curve that ends below it ends at rest

// Samples at the smallest distance of the history's points, or at a part of it where it has few.
record::Motion sampled(const History& h) {
  constexpr double kFewest = 256, kMost = 1 << 17;
  const double span = h.time.back() - h.time.front();
  double step = span;
  for (size_t i = 1; i < h.time.size(); ++i) step = std::min(step, h.time[i] - h.time[i - 1]);
  double count = std::round(span / step);
  if (count < kFewest) count *= std::ceil(kFewest / count);
  count = std::min(count, kMost);
  record::Motion m;
  m.dt = span / count;
  for (int i = 0; i <= static_cast<int>(count); ++i)
    m.velocity.push_back(h.value_at(h.time.front() + m.dt * i));
  return m;
}

double largest(const std::vector<double>& values) {
  double out = 0;
  for (const double v : values) out = std::max(out, std::abs(v));
  return out;
}

// Held for its own length at both ends, less the straight line between its ends.
std::vector<double> without_jump(const std::vector<double>& v) {
  std::vector<double> out(v.size(), v.front());
  out.insert(out.end(), v.begin(), v.end());
  out.insert(out.end(), v.size(), v.back());
  const double slope = (v.back() - v.front()) / static_cast<double>(out.size() - 1);
  for (size_t i = 0; i < out.size(); ++i) out[i] -= v.front() + slope * static_cast<double>(i);
  return out;
}

using Inputs = std::map<int, std::vector<InputKind>>;  // of each history

void add(int history, InputKind kind, Inputs& inputs) {
  if (history >= 0) inputs[history].push_back(kind);
}

void add(const Motion& motion, Inputs& inputs) {
  if (motion.kind == Motion::kVelocity) add(motion.history, InputKind::kVelocity, inputs);
  if (motion.kind == Motion::kDisplacement) add(motion.history, InputKind::kDisplacement, inputs);
}

Inputs inputs_of(const Model& model) {
  Inputs inputs;
  for (const BlockInput& b : model.blocks)
    for (const Motion* m : {&b.motion_x, &b.motion_y, &b.motion_rotation}) add(*m, inputs);
  for (const SupportInput& s : model.supports)
    for (const Motion* m : {&s.x, &s.y}) add(*m, inputs);
  for (const BoundaryInput& b : model.boundaries)
    for (const int h : {b.history_x, b.history_y}) add(h, InputKind::kVelocity, inputs);
  for (const LoadInput& l : model.loads) {
    const InputKind kind = l.kind == LoadKind::kAcceleration ? InputKind::kAcceleration : InputKind::kForce;
    for (const Signal& s : {l.x, l.y, l.pressure}) add(s.history, kind, inputs);
  }
  return inputs;
}

// The block with the longest transit of the slowest wave; block -1 when none deforms.
Resolution worst_block(const Scene& scene) {
  Resolution worst;
  const BlockSet& blocks = scene.blocks;
  std::map<std::pair<int, int>, std::pair<double, std::string>> known;  // group, material: speed, trouble
  for (int i = 0; i < blocks.count; ++i) {
    if (blocks.kind[i] != BlockKind::kDeformable) continue;
    const std::pair<int, int> key{blocks.group[i], blocks.material[i]};
    if (!known.count(key)) {
      std::string trouble;
      const Ground ground =
          ground_at(scene.model, scene.layout, scene.layout.blocks[i], blocks.material[i], trouble);
      known[key] = {slowest_wave(ground), trouble};
    }
    const auto& [speed, trouble] = known[key];
    if (worst.block < 0 || blocks.size[i] / speed > worst.size / worst.speed) {
      worst.block = i, worst.size = blocks.size[i], worst.speed = speed;
      worst.left_out = trouble;
    }
  }
  return worst;
}

}  // namespace

double highest_frequency(const History& history, InputKind kind) {
  if (history.time.size() < 2) return 0;
  record::Motion m = sampled(history);
  if (kind == InputKind::kAcceleration) m = record::integrate(std::move(m.velocity), m.dt);
  if (kind == InputKind::kDisplacement) m.velocity = record::differentiate(m.velocity, m.dt);
  const double most = largest(m.velocity);
  if (std::max(std::abs(m.velocity.front()), std::abs(m.velocity.back())) > kNearZero * most)
    m.velocity = without_jump(m.velocity);
  // what a constant or a straight line leaves is rounding
  if (largest(m.velocity) <= 1e-9 * most) return 0;
  return record::highest_frequency(m);
}

double largest_input(const Model& model) {
  double most = 0;
  Inputs inputs = inputs_of(model);
  for (const BlockInput& b : model.blocks)  // not in metres
    if (const auto turns = inputs.find(b.motion_rotation.history); turns != inputs.end()) {
      std::vector<InputKind>& kinds = turns->second;
      const InputKind kind =
          b.motion_rotation.kind == Motion::kVelocity ? InputKind::kVelocity : InputKind::kDisplacement;
      if (const auto k = std::find(kinds.begin(), kinds.end(), kind); k != kinds.end()) kinds.erase(k);
    }
  for (const auto& [history, kinds] : inputs) {
    const History& h = model.histories[history];
    if (h.time.size() < 2) continue;
    record::Motion m = sampled(h);
    for (const InputKind kind : kinds) {
      std::vector<double> a = m.velocity;  // as it is called: the values of the history
      const int orders = kind == InputKind::kVelocity ? 1 : kind == InputKind::kDisplacement ? 2 : 0;
      for (int n = 0; n < orders; ++n) a = record::differentiate(a, m.dt);
      if (kind != InputKind::kForce) most = std::max(most, largest(a));
    }
  }
  return most;
}

double slowest_wave(const Ground& ground) {
  constexpr int kDirections = 180;  // of a half turn
  const Stiffness& c = ground.stiffness;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    const double angle = std::numbers::pi * i / kDirections, x = std::cos(angle), y = std::sin(angle);
    // Christoffel's matrix N C N^T, N from stress to traction; its eigenvalues are density x speed^2
    const double n[2][3] = {{x, 0, y}, {0, y, x}};
    double g[2][2] = {};
    for (size_t a = 0; a < 2; ++a)
      for (size_t b = 0; b < 2; ++b)
        for (size_t p = 0; p < 3; ++p)
          for (size_t q = 0; q < 3; ++q) g[a][b] += n[a][p] * c[p][q] * n[b][q];
    least = std::min(least, 0.5 * (g[0][0] + g[1][1]) - std::hypot(0.5 * (g[0][0] - g[1][1]), g[0][1]));
  }
  return std::sqrt(least / ground.density);
}

std::vector<Resolution> resolutions(const Scene& scene) {
  const Model& model = scene.model;
  const bool shakes = std::any_of(model.stages.begin(), model.stages.end(),
                                  [](const StageInput& s) { return s.kind == StageKind::kDynamic; });
  const Resolution worst = worst_block(scene);
  if (!shakes || worst.block < 0) return {};
  std::vector<Resolution> out;
  for (const auto& [history, kinds] : inputs_of(model)) {
    Resolution r = worst;
    r.history = history;
    for (const InputKind kind : kinds)
      r.frequency = std::max(r.frequency, highest_frequency(model.histories[history], kind));
    if (r.frequency == 0) continue;
    r.per_wavelength = r.speed / (r.frequency * r.size);
    out.push_back(r);
  }
  return out;
}

std::string resolution_report(const Scene& scene) {
  std::string text;
  for (const Resolution& r : resolutions(scene)) {
    const int block = r.block;
    text += fmt::format(
        "  waves      \"{}\": {:g} % of its |V(f)|^2 below {:.3g} Hz; slowest wave {:.4g} m/s through "
        "blocks of {:.3g} m ({}{}): {:.3g} blocks per wavelength\n",
        scene.model.histories[r.history].name, 100 * record::kVelocityShare, r.frequency, r.speed, r.size,
        scene.blocks.name[block], r.left_out.empty() ? "" : ", without the joint stiffness of " + r.left_out,
        r.per_wavelength);
  }
  return text;
}

void check_resolution(const Scene& scene, Findings& findings) {
  for (const Resolution& r : resolutions(scene)) {
    if (r.per_wavelength >= kFewestPerWavelength) continue;
    const History& h = scene.model.histories[r.history];
    findings.warning(
        h.where, "history." + h.name,
        fmt::format(
            "its waves are cut short: {:.3g} blocks per wavelength at {:.3g} Hz ({:g} % of |V(f)|^2 lies "
            "below), wanted are {:g}; the slowest wave runs at {:.4g} m/s through block \"{}\" of {:.3g} m",
            r.per_wavelength, r.frequency, 100 * record::kVelocityShare, kFewestPerWavelength, r.speed,
            scene.blocks.name[r.block], r.size),
        fmt::format(
            "use blocks of at most {:.3g} m there, or take out what lies above {:.3g} Hz (of a record: talus record "
            "--low-pass; of an expression: a lower frequency)",
            r.size * r.per_wavelength / kFewestPerWavelength,
            r.frequency * r.per_wavelength / kFewestPerWavelength));
  }
}

}  // namespace talus
