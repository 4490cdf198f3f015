#pragma once
// Models whose limit is known from statics: masonry arches between fixed springings, and the columns of
// Goodman and Bray on a stepped slope. Blocks are rigid and joints hard, with friction alone. The tests
// bracket the limits, studies/limit_states finds them. A model is complete with stage_text() at its end.

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "support/model_text.h"

namespace talus::test::limit {

inline constexpr double kG = 9.81;     // [m/s2]
inline constexpr double kRadius = 10;  // of the centre line of all arches [m]
inline constexpr int kColumns = 16;    // on the slope of columns_text()

inline double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// One [[block]] of the material "m".
/// @param polygon  corners [m]
/// What comes before the blocks: gravity [m/s2], the material "m" [kg/m3], one joint for all contacts.
inline std::string head_text(Vec2 gravity, double friction_degrees, double density) {
  return fmt::format(
      "talus = 1\n[model]\ngravity = [{:.17g}, {:.17g}]\n[material.m]\ndensity = {:.17g}\n[joint.face]\n"
      "friction_angle = \"{:.17g} deg\"\n[contact]\njoint = \"face\"\n",
      gravity.x, gravity.y, density, friction_degrees);
}

/// The one stage of a run: dynamic, `duration` long in steps of `step`, both [s].
inline std::string stage_text(double duration, double step) {
  return fmt::format("[[stage]]\nname = \"run\"\nkind = \"dynamic\"\nduration = {}\ntime_step = {}\n",
                     duration, step);
}

/// A horizontal acceleration of all blocks that grows evenly from nothing to `last` x g at time `end` [s].
inline std::string ramp_text(double end, double last) {
  return fmt::format(
      "[history.push]\ntime = [0, {}]\nvalue = [0, {:.17g}]\n[[load]]\nname = \"push\"\n"
      "acceleration_x = \"push\"\n",
      end, last * kG);
}

struct Arch {
  double embrace;    // [deg]
  double thickness;  // over the radius of the centre line
  int voussoirs;
};

/// Voussoirs with straight faces between two fixed springings that are wider than they.
/// @param push  horizontal over vertical acceleration, > 0 to the right
inline std::string arch_text(const Arch& arch, double push, double friction_degrees) {
  const double t = arch.thickness * kRadius, from = radians(90 - arch.embrace / 2);
  const auto at = [&](double radius, int joint) {
    const double angle = from + radians(arch.embrace) * joint / arch.voussoirs;
    return radius * Vec2{std::cos(angle), std::sin(angle)};
  };
  const double inner = kRadius - t / 2, outer = kRadius + t / 2;
  std::string text = head_text({push * kG, -kG}, friction_degrees, 2400);
  for (const int joint : {0, arch.voussoirs}) {
    const Vec2 a = at(inner - t, joint), b = at(outer + t, joint);
    const Vec2 away = (joint == 0 ? -1 : 1) * t / norm(b - a) * turn_left(b - a);
    text += block_text(fmt::format("springing_{}", joint), {a, b, b + away, a + away}, "fixed");
  }
  for (int i = 0; i < arch.voussoirs; ++i)
    text += block_text(fmt::format("v{}", i),
                       {at(inner, i), at(outer, i), at(outer, i + 1), at(inner, i + 1)}, "rigid");
  return text;
}

/// The classic slope of Goodman and Bray: 16 columns 10 m wide on steps of 1 m, dipping 30 deg out of the
/// slope, 4 m to 40 m high up to the crest (column 10), then lower by 6.2 m each; 25 kN/m3. Block 0 is the
/// base, block n column n counted from the toe.
inline std::string columns_text(double friction_degrees) {
  const Vec2 up_slope{std::cos(radians(30)), std::sin(radians(30))};
  const auto at = [&](double along, double height) {
    return along * up_slope + height * turn_left(up_slope);
  };
  Polygon base{at(-60, 0), at(-60, -30), at(10 * kColumns, -30)};
  for (int n = kColumns - 1; n >= 0; --n) {
    base.push_back(at(10 * (n + 1), n));
    if (n > 0) base.push_back(at(10 * n, n));
  }
  std::string text = head_text({0, -kG}, friction_degrees, 25000 / kG) + block_text("base", base, "fixed");
  for (int n = 0; n < kColumns; ++n) {
    const double height = n < 10 ? 4 * (n + 1) : 40 - 6.2 * (n - 9);
    text += block_text(
        fmt::format("c{}", n + 1),
        {at(10 * n, n), at(10 * (n + 1), n), at(10 * (n + 1), n + height), at(10 * n, n + height)}, "rigid");
  }
  return text;
}

}  // namespace talus::test::limit
