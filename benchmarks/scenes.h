#pragma once
// The scenes on which talus and other programs are timed side by side: a shaken wall of bricks, jointed rock
// in a box, a pile of random stones. Plain polygons, so that every engine builds exactly the same blocks.

#include <string>
#include <string_view>
#include <vector>

#include "talus/base/vec2.h"

namespace talus::bench {

struct BenchBlock {
  bool fixed = false;
  std::vector<Vec2> corners;  // [m] world, counter-clockwise, convex
};

struct BenchScene {
  std::string name;  // "wall", "joint" or "pile"
  double friction = 0;
  double density = 0;  // [kg/m^2] per metre of thickness
  std::vector<BenchBlock> blocks;

  int moving() const;  // blocks that are not fixed
};

/// Running-bond wall of bricks 1 x 0.5 m on a floor: `ny` courses, the even ones of `nx` full bricks, the odd
/// ones shifted by half a brick and closed by half bricks. Density 2000, friction 0.6, gaps exactly zero.
BenchScene wall_scene(int nx, int ny);

/// Box of `width` x `height` [m] cut by two joint sets at 75 and 125 degrees from +x, 3 m apart, each with a
/// line through the origin; floor and two side walls, free top. Cells below 5 % of a whole one are left out.
/// Density 2850, friction 0.7.
BenchScene joint_scene(double width, double height);

/// `n` convex polygons of five to eight corners on a grid of 1.5 m, about to fall into a box as wide as the
/// grid. Density 2000, friction 0.5; the same stones on every machine.
BenchScene pile_scene(int n);

/// The scenes by the names used on command lines and in results, as "wall_7k".
/// @throws std::invalid_argument listing the names, when `name` is not one of them
BenchScene named_scene(std::string_view name);

/// All names that named_scene() knows, in order of kind and size.
std::vector<std::string> scene_names();

}  // namespace talus::bench
