#include "scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "talus/base/random.h"
#include "talus/geometry/polygon.h"

namespace talus::bench {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<Vec2> rectangle(double x_0, double y_0, double x_1, double y_1) {
  return {{x_0, y_0}, {x_1, y_0}, {x_1, y_1}, {x_0, y_1}};
}

// The part of a convex polygon where dot(normal, x) <= offset.
std::vector<Vec2> half_plane_part(const std::vector<Vec2>& corners, Vec2 normal, double offset) {
  std::vector<Vec2> kept;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec2 from = corners[i], to = corners[(i + 1) % corners.size()];
    const double d_from = dot(normal, from) - offset, d_to = dot(normal, to) - offset;
    if (d_from <= 0) kept.push_back(from);
    if ((d_from < 0 && d_to > 0) || (d_from > 0 && d_to < 0))
      kept.push_back(from + d_from / (d_from - d_to) * (to - from));
  }
  return kept;
}

// A line through a corner of the box leaves corners that differ by round-off only; one of each is enough.
std::vector<Vec2> without_twins(const std::vector<Vec2>& corners, double distance) {
  std::vector<Vec2> kept;
  for (const Vec2 p : corners)
    if (kept.empty() || norm(p - kept.back()) > distance) kept.push_back(p);
  while (kept.size() > 1 && norm(kept.front() - kept.back()) <= distance) kept.pop_back();
  return kept;
}

struct JointLines {
  Vec2 normal;
  double spacing;
  int first, last;  // numbers of the lines that bound every strip reaching into the box
};

JointLines lines_through_box(double degrees, double spacing, double width, double height) {
  const double angle = degrees * kPi / 180;
  const Vec2 normal{-std::sin(angle), std::cos(angle)};
  double low = 0, high = 0;  // the origin is a corner of the box
  for (const Vec2 corner : {Vec2{width, 0}, Vec2{0, height}, Vec2{width, height}}) {
    low = std::min(low, dot(normal, corner));
    high = std::max(high, dot(normal, corner));
  }
  return {normal, spacing, static_cast<int>(std::floor(low / spacing)) - 1,
          static_cast<int>(std::ceil(high / spacing)) + 1};
}

// The part of a polygon between line `k` and the next one.
std::vector<Vec2> strip_part(const std::vector<Vec2>& corners, const JointLines& lines, int k) {
  const std::vector<Vec2> below = half_plane_part(corners, lines.normal, (k + 1) * lines.spacing);
  return half_plane_part(below, -lines.normal, -k * lines.spacing);
}

struct NamedScene {
  const char* name;
  std::function<BenchScene()> build;
};

const std::vector<NamedScene>& catalogue() {
  static const std::vector<NamedScene> scenes = {
      {"wall_400", [] { return wall_scene(20, 20); }},
      {"wall_1k", [] { return wall_scene(50, 20); }},
      {"wall_7k", [] { return wall_scene(140, 50); }},
      {"wall_50k", [] { return wall_scene(400, 125); }},
      {"wall_500k", [] { return wall_scene(1250, 400); }},
      {"joint_1k", [] { return joint_scene(88, 133); }},
      {"joint_paper", [] { return joint_scene(200, 300); }},
      {"joint_7k", [] { return joint_scene(234, 352); }},
      {"joint_50k", [] { return joint_scene(626, 939); }},
      {"pile_1k", [] { return pile_scene(1000); }},
      {"pile_7k", [] { return pile_scene(7000); }},
      {"pile_50k", [] { return pile_scene(50000); }},
  };
  return scenes;
}

}  // namespace

int BenchScene::moving() const {
  return static_cast<int>(
      std::count_if(blocks.begin(), blocks.end(), [](const BenchBlock& block) { return !block.fixed; }));
}

BenchScene wall_scene(int nx, int ny) {
  BenchScene scene{"wall", 0.6, 2000, {}};
  scene.blocks.push_back({true, rectangle(-5, -1, nx + 5, 0)});
  for (int course = 0; course < ny; ++course) {
    const double bottom = 0.5 * course, top = bottom + 0.5;
    const auto lay = [&](double left, double right) {
      scene.blocks.push_back({false, rectangle(left, bottom, right, top)});
    };
    if (course % 2 == 0) {
      for (int i = 0; i < nx; ++i) lay(i, i + 1);
    } else {
      lay(0, 0.5);
      for (int i = 0; i + 1 < nx; ++i) lay(i + 0.5, i + 1.5);
      lay(nx - 0.5, nx);
    }
  }
  return scene;
}

BenchScene joint_scene(double width, double height) {
  constexpr double kSpacing = 3, kWallThickness = 10, kTwinDistance = 1e-6, kSmallest = 0.05;
  BenchScene scene{"joint", 0.7, 2850, {}};
  const double t = kWallThickness;
  scene.blocks.push_back({true, rectangle(-t, -t, width + t, 0)});
  scene.blocks.push_back({true, rectangle(-t, 0, 0, height + t)});
  scene.blocks.push_back({true, rectangle(width, 0, width + t, height + t)});
  const JointLines steep = lines_through_box(75, kSpacing, width, height);
  const JointLines flat = lines_through_box(125, kSpacing, width, height);
  const double whole = kSpacing * kSpacing / std::abs(cross(steep.normal, flat.normal));
  for (int i = steep.first; i < steep.last; ++i) {
    const std::vector<Vec2> strip = strip_part(rectangle(0, 0, width, height), steep, i);
    if (strip.size() < 3) continue;
    for (int j = flat.first; j < flat.last; ++j) {
      const std::vector<Vec2> cell = without_twins(strip_part(strip, flat, j), kTwinDistance);
      if (cell.size() >= 3 && signed_area(cell) >= kSmallest * whole) scene.blocks.push_back({false, cell});
    }
  }
  return scene;
}

BenchScene pile_scene(int n) {
  constexpr double kGrid = 1.5, kLift = 0.2, kThickness = 5;
  constexpr uint64_t kSeed = 12345;
  BenchScene scene{"pile", 0.5, 2000, {}};
  const int columns = static_cast<int>(std::ceil(std::sqrt(n)));
  const int rows = (n + columns - 1) / columns;
  const double width = columns * kGrid, top = rows * kGrid + kThickness, t = kThickness;
  scene.blocks.push_back({true, rectangle(-t, -t, width + t, 0)});
  scene.blocks.push_back({true, rectangle(-t, 0, 0, top)});
  scene.blocks.push_back({true, rectangle(width, 0, width + t, top)});
  // the order of the draws is part of the scene: corners, radius, phase, then one draw per corner
  Random random(kSeed);
  for (int k = 0; k < n; ++k) {
    const Vec2 center{(k % columns + 0.5) * kGrid, (k / columns + 0.5) * kGrid + kLift};
    const int corners = 5 + static_cast<int>(4 * random.uniform());
    const double radius = 0.35 + 0.3 * random.uniform();
    const double phase = 2 * kPi * random.uniform();
    BenchBlock stone;
    for (int i = 0; i < corners; ++i) {
      const double angle = phase + 2 * kPi * (i + 0.6 * (random.uniform() - 0.5)) / corners;
      stone.corners.push_back(center + radius * Vec2{std::cos(angle), std::sin(angle)});
    }
    scene.blocks.push_back(stone);
  }
  return scene;
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const NamedScene& scene : catalogue()) names.push_back(scene.name);
  return names;
}

BenchScene named_scene(std::string_view name) {
  for (const NamedScene& scene : catalogue())
    if (name == scene.name) return scene.build();
  std::string message = "no scene is called '" + std::string(name) + "'; known are";
  for (const std::string& known : scene_names()) message += " " + known;
  throw std::invalid_argument(message);
}

}  // namespace talus::bench
