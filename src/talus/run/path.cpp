#include "talus/run/path.h"

#include <algorithm>

#include "talus/base/error.h"

namespace talus {

namespace {

// Distance of two goals below which they are one, as share of an increment: what is nearer is round-off.
constexpr double kSameGoal = 1e-9;

int sign_of(double x) { return (x > 0) - (x < 0); }

struct Followed {
  int history = -1;
  bool is_rate = false;  // what follows it goes by its integral
};

std::vector<Followed> followed_in(const Scene& scene, int stage) {
  std::vector<Followed> list;
  const auto add = [&list](int history, bool is_rate) {
    if (history >= 0) list.push_back({history, is_rate});
  };
  const auto add_motion = [&add](const Motion& m) { add(m.history, m.kind == Motion::kVelocity); };
  for (const SupportInput& s : scene.model.supports)
    if (s.acts_in(stage)) add_motion(s.x), add_motion(s.y);
  for (const LoadInput& l : scene.model.loads)
    if (l.acts_in(stage)) add(l.x.history, false), add(l.y.history, false), add(l.pressure.history, false);
  for (const BlockShape& b : scene.layout.blocks)
    if (b.kind == BlockKind::kDriven)
      add_motion(b.motion_x), add_motion(b.motion_y), add_motion(b.motion_rotation);
  return list;
}

// Times at which what follows the history begins to go another way, or stops.
void add_turns(const History& h, bool is_rate, std::vector<double>& times) {
  for (size_t i = 1; i < h.time.size(); ++i) {
    const double before = h.value[i - 1], here = h.value[i];
    if (is_rate) {
      if (before * here < 0)
        times.push_back(h.time[i - 1] + before / (before - here) * (h.time[i] - h.time[i - 1]));
      else if ((before == 0) != (here == 0))
        times.push_back(here == 0 ? h.time[i] : h.time[i - 1]);
    } else if (i + 1 < h.time.size() && sign_of(here - before) != sign_of(h.value[i + 1] - here)) {
      times.push_back(h.time[i]);
    }
  }
  // held beyond both ends
  times.push_back(h.time.front()), times.push_back(h.time.back());
}

}  // namespace

std::vector<double> path_goals(const Scene& scene, int stage) {
  const StageInput& input = scene.model.stages[stage];
  if (!(input.path > 0)) return {};
  TALUS_ASSERT(input.increments > 0);
  const double begin = scene.model.history_time_at(stage), end = begin + input.path;
  std::vector<double> times;
  for (const Followed& f : followed_in(scene, stage))
    add_turns(scene.model.histories[f.history], f.is_rate, times);
  for (int i = 0; i <= input.increments; ++i)
    times.push_back(begin + input.path * (static_cast<double>(i) / input.increments));
  std::sort(times.begin(), times.end());
  const double same = kSameGoal * input.path / input.increments;
  std::vector<double> goals{begin};
  for (const double t : times)
    if (t > goals.back() + same && t < end - same) goals.push_back(t);
  goals.push_back(end);
  return goals;
}

bool follows_history(const Scene& scene, int stage) { return !followed_in(scene, stage).empty(); }

double prescribed_way(const Scene& scene, double from, double to) {
  if (from == to) return 0;
  double most = 0;
  const auto way = [&](const Motion& m) {
    if (m.history < 0) return 0.0;
    return m.displacement_at(to, scene.model.histories) - m.displacement_at(from, scene.model.histories);
  };
  for (const SupportedPoint& p : scene.supported) {
    const SupportInput& s = scene.model.supports[p.support];
    if (p.active) most = std::max(most, norm(Vec2{way(s.x), way(s.y)}));
  }
  for (size_t k = 0; k < scene.layout.blocks.size(); ++k) {
    const BlockShape& b = scene.layout.blocks[k];
    if (scene.blocks.kind[k] == BlockKind::kDriven)
      most = std::max(most, norm(Vec2{way(b.motion_x), way(b.motion_y)}) +
                                std::abs(way(b.motion_rotation)) * scene.blocks.size[k]);
  }
  return most;
}

}  // namespace talus
