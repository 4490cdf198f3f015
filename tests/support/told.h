#pragma once
// What the program says to a model file.

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "talus/talus.h"

namespace talus::test {

/// A block on a floor under gravity, shaken: nothing is wrong with it, and tests replace one piece of it.
inline const std::string kShakenBlock = R"~(talus = 1
[model]
gravity = [0, -9.81]
[material.rock]
density = 2700
young = "20 GPa"
poisson = 0.25
[joint.face]
friction_angle = "35 deg"
normal_stiffness = "10 GPa/m"
shear_stiffness = "5 GPa/m"
[contact]
joint = "face"
[history.motion]
expression = "0.1*sin(2*_pi*2*t)"
duration = "2 s"
[[block]]
name = "floor"
polygon = [[-5, -1], [5, -1], [5, 0], [-5, 0]]
material = "rock"
kind = "driven"
motion_x = { velocity = "motion" }
[[block]]
name = "stone"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "rock"
[[stage]]
name = "shake"
kind = "dynamic"
duration = "2 s"
elasticity = "implicit"
)~";

/// `text` with one piece of it, which must be there, replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  INFO("to be replaced: ", from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// Errors of reading, cutting and checking `text` as model.toml; "" when it is taken, with warnings or
/// without.
inline std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Findings findings("model.toml", text);
  try {
    prepare_run("model.toml", text, overrides, findings);
  } catch (const InputError& e) {
    CHECK(e.code() == kExitInput);
    return e.what();
  }
  return "";
}

/// All that is said of it: errors, or else warnings.
inline std::string told(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Findings findings("model.toml", text);
  try {
    prepare_run("model.toml", text, overrides, findings);
  } catch (const Error& e) {
    return e.what();
  }
  return findings.render();
}

/// Checks that what is told of `text` names the file and holds all pieces.
inline void check_told(const std::string& text, const std::vector<std::string>& pieces,
                       const std::vector<std::string>& overrides = {}) {
  const std::string said = told(text, overrides);
  INFO(said);
  CHECK(said.find("model.toml:") != std::string::npos);
  for (const std::string& piece : pieces) {
    INFO(piece);
    CHECK(said.find(piece) != std::string::npos);
  }
}

}  // namespace talus::test
