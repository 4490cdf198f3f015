// Warnings of what is legal and almost surely wrong, and models that are unusual and right.

#include "talus/run/plausible.h"

#include <doctest/doctest.h>

#include "support/told.h"

namespace test_plausible {

using namespace talus;
using namespace talus::test;

TEST_CASE("plausible mistakes are told at their line") {
  REQUIRE(told(kShakenBlock) == "");
  struct Mistake {
    std::string from, to, line, says;
    bool is_error = false;
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
      // units, decimals, signs
      {"poisson = 0.25", "poisson = 25", "7:11", "material.rock.poisson", true},
      {"poisson = 0.25", "poisson = 0.5", "7:11", "material.rock.poisson", true},
      {"\"35 deg\"", "35", "9:18", "joint.face.friction_angle: an angle needs its unit", true},
      {"\"35 deg\"", "\"0.7 deg\"", "9:18", "joint.face.friction_angle: 0.7 deg is unusual"},
      {"\"35 deg\"", "\"35 deg\"\ncohesion = 2", "10:12", "joint.face.cohesion: 2 Pa is unusual"},
      {"\"35 deg\"", "\"35 deg\"\ntensile_strength = \"3 GPa\"", "10:20", "joint.face.tensile_strength"},
      {"\"35 deg\"", "\"35 degrees\"", "9:18", "joint.face.friction_angle: unknown unit", true},
      {"\"20 GPa\"", "\"-20 GPa\"", "6:9", "material.rock.young", true},
      {"\"20 GPa\"", "\"20 kN\"", "6:9", "material.rock.young: \"20 kN\" is a force", true},
      {"[0, -9.81]", "[-9.81, 0]", "3:1", "model.gravity: -9.81 m/s2 along x alone: things fall sideways"},
      {"[0, -9.81]", "[0, -981]", "3:1", "model.gravity: 981 m/s2"},
      {"duration = \"2 s\"\nelasticity", "duration = 2000000\nelasticity", "30:12", "stage.shake.duration"},
      // paths
      {"kind = \"dynamic\"\nduration = \"2 s\"\nelasticity = \"implicit\"",
       "kind = \"static\"\nduration = \"2 s\"\nincrements = 3", "31:1",
       "stage.shake.increments: are parts of a path", true},
      {"elasticity = \"implicit\"", "path = 1", "31:1", "stage.shake.path: is only for static stages", true},
      {"kind = \"dynamic\"\nduration = \"2 s\"\nelasticity = \"implicit\"",
       "kind = \"static\"\nduration = \"2 s\"\npath = 1\nintegration = \"dynamic\"", "31:1",
       "stage.shake.path: goes from", true},
      {"kind = \"dynamic\"\nduration = \"2 s\"\nelasticity = \"implicit\"",
       "kind = \"static\"\nduration = \"2 s\"\npath = 1\ndamping_local = 0.5", "32:1",
       "stage.shake.damping_local: has nothing", true},
      {"kind = \"dynamic\"\nduration = \"2 s\"\nelasticity = \"implicit\"",
       "kind = \"static\"\nduration = \"2 s\"\npath = 1\nelasticity = \"explicit\"", "32:1",
       "stage.shake.elasticity: is", true},
      {"kind = \"dynamic\"\nduration = \"2 s\"\nelasticity = \"implicit\"",
       "kind = \"static\"\nduration = \"2 s\"\npath = 1\nexcavate = [\"stone\"]", "32:1",
       "stage.shake.excavate: is no part", true},
      {"kind = \"dynamic\"\nduration = \"2 s\"\nelasticity = \"implicit\"",
       "kind = \"static\"\nduration = \"2 s\"\npath = 1\n[[stage]]\nname = \"later\"\nkind = \"dynamic\"\nduration = 1\n"
       "[[load]]\nname = \"q\"\nstages = [\"later\"]\nacceleration_x = \"motion\"",
       "36:1", "load.q: acts in stage \"later\" from 1 s of history \"motion\" on"},
      // names and keys
      {"density = 2700", "densty = 2700", "5:1", "did you mean \"density\"", true},
      {"material = \"rock\"\nkind", "material = \"rokc\"\nkind", "20:1", "did you mean \"rock\"", true},
      {"velocity = \"motion\"", "velocity = \"moton\"", "22:1", "did you mean \"motion\"", true},
      {"joint = \"face\"", "joint = \"fase\"", "13:1", "did you mean \"face\"", true},
      {"[[stage]]", "[[stages]]", "27:3", "did you mean", true},
      {"kind = \"dynamic\"", "kind = \"dynamik\"", "29:8", "stage.shake.kind", true},
      {"name = \"stone\"", "name = \"floor\"", "24:1", "a second block or grid is called \"floor\"", true},
      {"[joint.face]",
       "[bolt_type.bar]\nkind = \"grouted\"\ndiameter = 0.02\nyoung = \"200 GPa\"\nspacing = 1\n"
       "grout_stiffness = 1e9\n[joint.face]",
       "8:12", "bolt_type.bar: is used by no bolt"},
      // places
      {"[[0, 0], [1, 0], [1, 1], [0, 1]]", "[[0, -0.1], [1, -0.1], [1, 1], [0, 1]]", "25:1", "overlaps",
       true},
      {"[[0, 0], [1, 0], [1, 1], [0, 1]]", "[[0, 0], [1, 1], [1, 0], [0, 1]]", "25:1", "crosses", true},
      {"[[0, 0], [1, 0], [1, 1], [0, 1]]", "[[0, 0], [1, 0]]", "25:1", "has 2 corners", true},
      {"[[stage]]", "[[monitor]]\nname = \"top\"\npoint = [0.5, 3]\n[[stage]]", "29:1",
       "monitor.top: (0.5, 3) lies outside every block", true},
      {"[[stage]]", "[[monitor]]\nname = \"top\"\nblock = \"stoen\"\n[[stage]]", "29:1",
       "did you mean \"stone\"", true},
      {"[[stage]]", "[[support]]\nname = \"base\"\nedge = [[2, 3], [4, 3]]\n[[stage]]", "27:1",
       "support.base: no block edge lies on the segment", true},
      {"[[stage]]", "[[load]]\nname = \"p\"\npressure = 1e5\nedge = [[2, 3], [4, 3]]\n[[stage]]", "27:1",
       "load.p: no block edge lies on the segment", true},
      {"[[stage]]",
       "[[contact_pair]]\nbetween = [\"floor\", \"stone\"]\njoint = \"mortar\"\n[joint.mortar]\nkind = "
       "\"bonded\"\n[[block]]\nname = \"x\"\npolygon = [[2,1],[3,1],[3,2],[2,2]]\nmaterial = \"rock\"\n"
       "[[contact_pair]]\nbetween = [\"x\", \"stone\"]\njoint = \"mortar\"\n[[stage]]",
       "37:1", "shall hold \"x\" and \"stone\" together, which share no face: they lie 1 m apart"},
      {"[0, 1]]\nmaterial = \"rock\"\n",
       "[0, 1]]\nmaterial = \"rock\"\n[[support]]\nname = \"pin\"\npoint = [0, 0]\n[[support]]\nname = "
       "\"pin2\"\npoint = [0.01, 0.01]\n",
       "30:1", "support.pin2: holds block \"stone\" over 0.0141 m of its 1 m"},
      // time
      {"elasticity = \"implicit\"", "elasticity = \"explicit\"\ntime_step = 0.01", "32:1",
       "stage.shake.time_step", true},
      {"duration = \"2 s\"\nelasticity", "duration = \"0.1 s\"\nelasticity", "14:10",
       "history.motion: lasts 2 s, and histories run for 0.1 s"},
      {"0.1*sin(2*_pi*2*t)", "0.1*cos(2*_pi*2*t)", "14:10", "history.motion: begins with 0.1"},
      {"duration = \"2 s\"\n[[block]]", "duration = \"1.9 s\"\n[[block]]", "14:10",
       "history.motion: ends at 1.9 s with -0.0951"},
      {"duration = \"2 s\"\n[[block]]\nname = \"floor\"",
       "duration = \"2 s\"\n[[load]]\nname = \"q\"\nacceleration_x = \"gal\"\n[history.gal]\n"
       "expression = \"300*sin(2*_pi*2*t)\"\nduration = \"2 s\"\n[[block]]\nname = \"floor\"",
       "20:10", "history.gal: shakes with 300 m/s2, 31 times gravity"},
      {"[[stage]]", "[output]\nhistory_interval = \"10 s\"\n[[stage]]", "28:1",
       "output.history_interval: 10 s is longer than any stage"},
      {"[[stage]]", "[output]\nfield_interval = 20\n[[stage]]", "28:1", "output.field_interval"},
  };
  for (const Mistake& m : mistakes) {
    const std::string message = told(replaced(kShakenBlock, m.from, m.to));
    INFO(message);
    CHECK(message.find(m.says) != std::string::npos);
    CHECK(message.find("model.toml:" + m.line) != std::string::npos);
    CHECK((message.find(": error:") != std::string::npos) == m.is_error);
  }
}

TEST_CASE("a path that nothing follows is refused, and one that something follows is not warned of") {
  const std::string on_path = "kind = \"static\"\nduration = \"2 s\"\npath = \"2 s\"",
                    dynamic = "kind = \"dynamic\"\nduration = \"2 s\"\nelasticity = \"implicit\"";
  CHECK(told(replaced(kShakenBlock, dynamic, on_path)) == "");
  std::string still = replaced(kShakenBlock, dynamic, on_path);
  still = replaced(still, "kind = \"driven\"", "kind = \"fixed\"");
  const size_t motion = still.find("motion_x = ");
  REQUIRE(motion != std::string::npos);
  still.erase(motion, still.find('\n', motion) - motion + 1);
  const std::string message = told(still);
  INFO(message);
  CHECK(message.find("stage.shake.path: leads nowhere") != std::string::npos);
}

TEST_CASE("what begins behind a path in the midst of its history is warned of, whatever it is") {
  const std::string dynamic = "kind = \"dynamic\"\nduration = \"2 s\"\nelasticity = \"implicit\"",
                    path = "kind = \"static\"\nduration = \"2 s\"\npath = 1\n[[stage]]\nname = \"later\"\n" +
                           dynamic;
  const auto with = [&](const std::string& acting) {
    return told(replaced(kShakenBlock, dynamic, path + "\n" + acting));
  };
  CHECK(with("") == "");  // the floor goes on along the path
  const std::string support = with(
      "[[support]]\nname = \"top\"\nedge = [[0, 1], [1, 1]]\nx = { velocity = \"motion\" }\ny = \"free\"\nstages = [\"later\"]\n");
  INFO(support);
  CHECK(support.find("support.top: acts in stage \"later\" from 1 s of history \"motion\" on") !=
        std::string::npos);
  const std::string also = with("[[load]]\nname = \"q\"\nacceleration_x = \"motion\"\n");  // on the path, too
  CHECK(also.find("load.q: acts") == std::string::npos);
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

TEST_CASE("strength between blocks that do not touch, and stages in which nothing holds, are warned of") {
  const std::string strong = replaced(kShakenBlock, "\"35 deg\"", "\"35 deg\"\ncohesion = \"1 MPa\"");
  CHECK(told(strong) == "");
  CHECK(told(replaced(strong, "[[0, 0], [1, 0], [1, 1], [0, 1]]", "[[0, 0.1], [1, 0.1], [1, 1], [0, 1]]"))
            .find("contact.joint: \"face\" shall hold blocks together, and no two of them share a face") !=
        std::string::npos);
  const std::string free =
      replaced(kShakenBlock, "kind = \"driven\"\nmotion_x = { velocity = \"motion\" }\n", "");
  const std::string base = "[[support]]\nname = \"base\"\nedge = [[-5, -1], [5, -1]]\n";
  CHECK(told(free + base).find("is named by nothing") != std::string::npos);  // the motion, and no more
  CHECK(told(free + base).find("nothing holds") == std::string::npos);
  CHECK(told(free + base + "y = \"free\"\n").find("stage.shake: nothing holds the model along y") !=
        std::string::npos);
  const std::string rest = "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 9\n[[stage]]";
  CHECK(told(replaced(free, "[[stage]]", rest) + base + "stages = [\"rest\"]\n")
            .find("stage.shake: nothing holds the model along y") != std::string::npos);
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
           {"density = 2700", "density = 11340"},             // lead
           {"density = 2700", "density = 450"},               // timber
           {"\"20 GPa\"", "\"0.4 GPa\""},                     // across its grain
           {"\"20 GPa\"", "\"35 MPa\""},                      // clay
           {"poisson = 0.25", "poisson = 0.49"},              // saturated clay
           {"poisson = 0.25", "poisson = 0"},                 // cork
           {"[0, -9.81]", "[0, -490]"},                       // a centrifuge at 50 g
           {"[0, -9.81]", "[-5, -8.44]"},                     // a tilted table
           {"[0, -9.81]", "[0, 0]"},                          // none: the floor drives it
           {"\"35 deg\"", "\"8 deg\""},                       // a clay seam
           {"\"35 deg\"", "0"},                               // a lubricated one
           {"\"35 deg\"", "\"35 deg\"\ncohesion = \"30 MPa\"\ntensile_strength = \"12 MPa\""},  // intact rock
           {"\"35 deg\"", "\"35 deg\"\ncohesion = \"5 kPa\""},                                  // clay
           {"\"10 GPa/m\"", "\"500 GPa/m\""},                                                   // tight
           {"normal_stiffness = \"10 GPa/m\"\nshear_stiffness = \"5 GPa/m\"\n", ""},            // hard
           {"0.1*sin(2*_pi*2*t)", "0.1*sin(2*_pi*0.25*t)"},  // a far earthquake
           {"0.1*sin(2*_pi*2*t)", "2*t"},                    // pushed away
           {"0.1*sin(2*_pi*2*t)", "0.3"},                    // at one speed
           {"[1, 1], [0, 1]]\nmaterial = \"rock\"",
            "[1, 1], [0, 1]]\nmaterial = \"rock\"\nvelocity = [0, -300]"},  // a shell
           {"[1, 1], [0, 1]]\nmaterial = \"rock\"",
            "[1, 1], [0, 1]]\nmaterial = \"rock\"\nkind = \"rigid\"\nspin = \"600 rad/s\""},  // a flywheel
           {"[1, 1], [0, 1]]", "[1, 6], [0, 6]]"},                                            // a column
           {"[1, 1], [0, 1]]\nmaterial = \"rock\"",
            "[1, 30], [0, 30]]\nmaterial = \"rock\"\nkind = \"rigid\""},
           {"[[-5, -1], [5, -1], [5, 0], [-5, 0]]",
            "[[-500, -1], [500, -1], [500, 0], [-500, 0]]"},  // a wide floor
           {"[[0, 0], [1, 0], [1, 1], [0, 1]]",
            "[[0, 0.3], [1, 0.3], [1, 1.3], [0, 1.3]]"},  // it falls first
           {"duration = \"2 s\"\nelasticity", "duration = \"2 s\"\ndamping_mass = \"1 1/s\"\nelasticity"},
           // a deep mine
           {"[[stage]]",
            "[in_situ]\nstress_xx = \"-60 MPa\"\nstress_yy = \"-60 MPa\"\nstress_xy = 0\n[[stage]]"},
           {"[[stage]]",
            "[[load]]\nname = \"blast\"\npressure = \"bang\"\nedge = [[0, 1], [1, 1]]\n[history.bang]\n"
            "time = [0, 0.1, 0.3]\nvalue = [0, 5e8, 0]\n[[stage]]"},  // a blast
           // suction of wind
           {"[[stage]]", "[[load]]\nname = \"pull\"\npressure = -1e4\nedge = [[0, 1], [1, 1]]\n[[stage]]"},
           {"[[stage]]", "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = \"10 s\"\n[[stage]]"},
           // said for the pair alone
           {"[contact]\njoint = \"face\"",
            "[[contact_pair]]\nbetween = [\"stone\", \"floor\"]\njoint = \"face\""},
       }) {
    INFO(c.to);
    CHECK(told(replaced(kShakenBlock, c.from, c.to)) == "");
  }
}

}  // namespace test_plausible
