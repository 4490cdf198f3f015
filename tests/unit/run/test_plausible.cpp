// Warnings of what is legal and almost surely wrong, and models that are unusual and right.

#include "talus/run/plausible.h"

#include <doctest/doctest.h>

#include "support/told.h"

using namespace talus;
using namespace talus::test;

namespace {

// A block on a floor under gravity, shaken; tests replace one piece of it.
const std::string kSound = R"~(talus = 1
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

}  // namespace

TEST_CASE("plausible mistakes are warned of at their line") {
  REQUIRE(told(kSound) == "");
  struct Mistake {
    std::string from, to, line, says;
  };
  const std::vector<Mistake> mistakes = {
      {"density = 2700", "density = 2.7", "5:11", "material.rock.density: 2.7 kg/m3 is unusual"},
      {"density = 2700", "density = 27000", "5:11", "material.rock.density"},
      {"\"20 GPa\"", "20", "6:9", "material.rock.young: 20 Pa is unusual"},
      {"\"20 GPa\"", "20e3", "6:9", "material.rock.young"},
      {"\"20 GPa\"", "\"20000 GPa\"", "6:9", "material.rock.young"},
      {"\"10 GPa/m\"", "10", "10:20", "joint.face.normal_stiffness: 10 Pa/m is unusual"},
      {"\"10 GPa/m\"", "\"1e7 GPa/m\"", "10:20", "joint.face.normal_stiffness"},
      {"\"5 GPa/m\"", "5", "11:19", "joint.face.shear_stiffness"},
      {"[contact]", "[joint.faec]\nfriction_angle = \"20 deg\"\n[contact]", "12:1",
       "joint.faec: is named by nothing"},
      {"[joint.face]", "[material.rokc]\ndensity = 2700\n[joint.face]", "8:1",
       "material.rokc: is named by nothing"},
      {"[[block]]\nname = \"floor\"",
       "[history.motoin]\nexpression = \"t\"\nduration = \"1 s\"\n[[block]]\nname = \"floor\"", "17:1",
       "history.motoin: is named by nothing"},
      {"[0, -9.81]", "[0, 9.81]", "3:1", "model.gravity: 9.81 m/s2 along y: things fall upwards"},
      {"[0, -9.81]", "[0, -9810]", "3:1", "model.gravity: 9.81e+03 m/s2"},
      {"elasticity = \"implicit\"", "elasticity = \"implicit\"\ntime_step = \"0.1 s\"", "32:1",
       "stage.shake.time_step: 0.1 s is long for history \"motion\""},
      {"[[stage]]", "[in_situ]\nstress_xx = \"1 MPa\"\nstress_yy = \"1 MPa\"\nstress_xy = 0\n[[stage]]", "",
       "in_situ: pulls"},
      {"[[0, 0], [1, 0], [1, 1], [0, 1]]", "[[0, 0], [4.9, 0], [4.9, 0.5], [0, 0.5]]", "25:1",
       "stone: is 9.8 times as long as wide"},
      {"kind = \"dynamic\"", "kind = \"static\"", "19:1", "block.floor: acts in static stages only"},
      {"\"10 GPa/m\"", "\"0.1 MPa/m\"", "8:8", "joint.face.normal_stiffness: 1e+05 Pa/m is soft"},
      {"[1, 1], [0, 1]]\nmaterial = \"rock\"\n",
       "[1, 1], [0.02, 1], [0, 0.99]]\nmaterial = \"rock\"\n[[support]]\nname = \"tip\"\n"
       "edge = [[0.02, 1], [0, 0.99]]\n",
       "27:1", "support.tip: holds block \"stone\" over 0.0224 m of its 1 m"},
      {"[[stage]]",
       "[[load]]\nname = \"push\"\nstages = [\"rest\"]\nacceleration_x = \"motion\"\n[[stage]]\n"
       "name = \"rest\"\nkind = \"static\"\nduration = 1\n[[stage]]",
       "27:1", "load.push: acts in static stages only"},
  };
  for (const Mistake& m : mistakes) {
    const std::string message = told(replaced(kSound, m.from, m.to));
    INFO(message);
    CHECK(message.find(m.says) != std::string::npos);
    CHECK(message.find("model.toml:" + m.line) != std::string::npos);
    CHECK(message.find("error") == std::string::npos);
  }
}

TEST_CASE("a model that nothing drives, holds or gives friction is warned of") {
  const std::string still = R"(talus = 1
[material.m]
density = 2000
[[block]]
name = "a"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "m"
kind = "rigid"
[[block]]
name = "b"
polygon = [[0, 1], [1, 1], [1, 2], [0, 2]]
material = "m"
kind = "rigid"
[[stage]]
name = "s"
kind = "dynamic"
duration = "1 s"
time_step = "1 ms"
)";
  CHECK(told(still).find("model.gravity: is none, and nothing else drives the model") != std::string::npos);
  const std::string falls = told(still + "[model]\ngravity = [0, -9.81]\n");
  CHECK(falls.find("support: nothing holds the model") != std::string::npos);
  CHECK(falls.find("contact.joint: is not given: all contacts are hard and without friction") !=
        std::string::npos);
}

TEST_CASE("unusual and right: no warning") {
  struct Case {
    std::string from, to;
  };
  for (const Case& c : std::vector<Case>{
           {"density = 2700", "density = 7850"},           // steel
           {"\"20 GPa\"", "\"210 GPa\""},                  // of it
           {"density = 2700", "density = 917"},            // ice
           {"\"20 GPa\"", "\"9 GPa\""},                    //
           {"\"20 GPa\"", "\"50 MPa\""},                   // soft soil
           {"density = 2700", "density = 100"},            // foam that stands for a light wall
           {"[0, -9.81]", "[0, -1.62]"},                   // the moon
           {"\"10 GPa/m\"", "\"1 MPa/m\""},                // a rubber pad
           {"\"35 deg\"", "\"80 deg\""},                   // rough
           {"0.1*sin(2*_pi*2*t)", "0.1*sin(2*_pi*20*t)"},  // a shaking table of 1:10
           {"[[0, 0], [1, 0], [1, 1], [0, 1]]",
            "[[0, 0], [0.02, 0], [0.02, 0.05], [0, 0.05]]"},  // a brick of one
       }) {
    INFO(c.to);
    CHECK(told(replaced(kSound, c.from, c.to)) == "");
  }
}
