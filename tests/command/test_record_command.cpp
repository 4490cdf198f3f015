// talus record as a user meets it.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/command.h"
#include "support/record_text.h"
#include "support/relative.h"
#include "talus/base/text_file.h"
#include "talus/output/csv.h"
#include "talus/output/files.h"

namespace test_record_command {

using namespace talus;
using namespace talus::test;
namespace fs = std::filesystem;

namespace {

// 12 s at 100 Hz: a burst in the middle, and a drift that the processing has to take off.
void write_record(const fs::path& path) {
  std::vector<double> a;
  for (int i = 0; i <= 1200; ++i) {
    const double t = 0.01 * i;
    a.push_back(0.2 * std::exp(-(t - 5) * (t - 5)) * std::sin(12 * t) + 0.002);
  }
  std::ofstream(path) << peer_text("ACCELERATION TIME SERIES IN UNITS OF G", "NPTS= 1201, DT= .0100 SEC", a);
}

}  // namespace

TEST_CASE("command: record reads, processes, draws and writes a motion that a model can use") {
  const Folder f;
  write_record(f / "a.AT2");
  const Outcome o = shell(f, "$talus record a.AT2 --duration 10 --out out");
  INFO(o.text);
  REQUIRE(o.code == 0);
  for (const char* part :
       {"a.AT2: PEER, \"NOWHERE 01/17/95 20:46, TEST, 000\", 1201 values in g, dt = 0.01 s, 12 s", "as read",
        "processed", "PGA [m/s2]", "99.9 % of |V(f)|^2 below [Hz]", "written to out: motion.csv"})
    has(o.text, part);
  for (const char* name : {"acceleration", "velocity", "displacement", "spectrum"})
    for (const char* ending : {".svg", ".png"})
      CHECK(fs::file_size(f / ("out/" + std::string(name) + ending)) > 1000);

  const CsvTable motion = read_csv(f / "out/motion.csv");
  CHECK(motion.columns ==
        std::vector<std::string>{"time [s]", "acceleration [m/s2]", "velocity [m/s]", "displacement [m]"});
  CHECK(motion.rows() == 1001);
  CHECK(std::abs(motion.values[2].back()) < 1e-13);
  CHECK(std::abs(motion.values[3].back()) < 1e-13);

  const auto json = nlohmann::json::parse(read_text_file(f / "out/record.json"));
  CHECK(json["source"] == "a.AT2");
  CHECK(json["unit"] == "g");
  CHECK(json["samples"] == 1001);
  CHECK(json["steps"].size() == 6);
  CHECK(json["steps"][0]["mean [m/s2]"].get<double>() == approx(0.002 * 9.80665).epsilon(1e-2));
  CHECK(json["steps"][2]["high-pass corner [Hz]"] == 0.1);
  CHECK(json["before"]["end_velocity [m/s]"].get<double>() == approx(0.002 * 9.80665 * 12).epsilon(1e-2));
  CHECK(std::abs(json["after"]["end_displacement [m]"].get<double>()) < 1e-13);

  // and the motion drives a table
  std::ofstream(f / "m.toml") << R"(talus = 1
[material.stone]
density = "2600 kg/m3"
[history.ground]
file = "out/motion.csv"
column = "velocity"
[[block]]
name = "table"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "stone"
kind = "driven"
motion_x = { velocity = "ground" }
[[stage]]
name = "shake"
kind = "dynamic"
duration = "10 s"
time_step = "10 ms"
[[monitor]]
name = "table"
point = [0.5, 0.5]
)";
  CHECK(shell(f, "$talus run m.toml -o run -q").code == 0);
  const CsvTable run = read_csv(f / "run/histories.csv");
  double worst = 0;
  for (size_t i = 0; i < motion.rows(); ++i)
    worst = std::max(worst, std::abs(run.column("table.displacement_x")[i] - motion.values[3][i]));
  CHECK(worst < 2e-5);  // straight lines between velocities: dt^2 / 12 of the acceleration, 2 m/s2
}

TEST_CASE("command: record converts without a step, and makes motions from a seed") {
  const Folder f;
  write_record(f / "a.AT2");
  CHECK(shell(f, "$talus record a.AT2 --raw --out raw").code == 0);
  const CsvTable raw = read_csv(f / "raw/motion.csv");
  CHECK(raw.rows() == 1201);
  CHECK(raw.values[1][0] == approx(0.002 * 9.80665).epsilon(1e-6));

  const std::string make =
      "$talus record --synthetic --seed 5 --pga 2 --duration 10 --dt 0.02 --rise 1 --strong 3 --decay 4";
  const Outcome o = shell(f, make + " --out a");
  CHECK(o.code == 0);
  for (const char* part :
       {"synthetic motion, seed 5: 10 s in steps of 0.02 s, rms of ln(Sa / target)", "PGA [m/s2]"})
    has(o.text, part);
  CHECK(shell(f, make + " --out b").code == 0);
  for (const char* name : {"motion.csv", "record.json", "spectrum.svg"})
    CHECK(read_text_file(f / "a" / name) == read_text_file(f / "b" / name));
  CHECK(read_csv(f / "a/motion.csv").rows() == 501);
}

TEST_CASE("command: record and its exit codes") {
  const Folder f;
  write_record(f / "a.AT2");
  const auto refused = [&](const std::string& line, int code, const std::string& part) {
    const Outcome o = shell(f, "$talus record " + line);
    INFO(line);
    CHECK(o.code == code);
    has(o.text, part);
  };
  refused("--help", 0, "Example: talus record");
  refused("--out o", 2, "talus record: give FILE, or --synthetic with --seed and --pga");
  refused("a.AT2 --synthetic --out o", 2, "talus record: give FILE or --synthetic, not both");
  refused("a.AT2", 2, "--out is required");
  refused("a.AT2 --seed 3 --out o", 2, "--seed requires --synthetic");
  refused("--synthetic --pga 1 --order 2 --out o", 2, "--synthetic excludes --order");
  refused("a.AT2 --raw --order 2 --out o", 2, "--raw excludes --order");
  refused("none.AT2 --out o", 4,
          "none.AT2: cannot be read: No such file or directory\n      = check the path");
  refused("a.AT2 --low-pass 60 --out o", 3, "a.AT2: error: the low-pass corner of 60 Hz is not below");
  refused("--synthetic --out o", 3, "synthetic motion: error: there is no target spectrum");
  CHECK_FALSE(fs::exists(f / "o"));

  CHECK(shell(f, "$talus record a.AT2 --out out").code == 0);
  refused("a.AT2 --out out", 4, "out: exists already; nothing was run");
  CHECK(shell(f, "$talus record a.AT2 --out out --force").code == 0);
  CHECK(shell(f, "mkdir mine && echo x > mine/x").code == 0);
  refused("a.AT2 --out mine --force", 4, "holds no results of talus");
}

TEST_CASE(
    "command: record makes the motion along a section of two components, and refuses what does not fit") {
  const Folder f;
  std::string north = "t [s],a [m/s2]\n", east = north;
  for (int i = 0; i < 400; ++i) {
    const double v = std::sin(0.2 * i);
    north += fmt::format("{},{}\n", 0.01 * i, 0.6 * v), east += fmt::format("{},{}\n", 0.01 * i, 0.8 * v);
  }
  write_file(f / "n.csv", north), write_file(f / "e.csv", east);
  // ground that moves along atan(0.8 / 0.6) = 53.1301 deg
  const Outcome o =
      shell(f, "$talus record n.csv --second e.csv --azimuths 0 90 --section 53.130102354 --raw --out out");
  CHECK(o.code == 0);
  const CsvTable motion = read_csv(f / "out/motion.csv");
  for (size_t i = 0; i < 400; i += 37)
    CHECK(motion.column("acceleration")[i] == approx(std::sin(0.2 * static_cast<double>(i))).epsilon(1e-9));
  has(read_text_file(f / "out/spectrum.csv"), "period [s],sa [m/s2]\n0.02,");
  CHECK(shell(f, "$talus record n.csv --second e.csv --section 40 --raw --out x").code == 2);
  CHECK(shell(f, "$talus record n.csv --second e.csv --azimuths 0 60 --section 40 --raw --out x").code == 3);
  write_file(f / "slow.csv", "t [s],a [m/s2]\n0,1\n0.5,2\n1,1\n");
  const Outcome steps =
      shell(f, "$talus record n.csv --second slow.csv --azimuths 0 90 --section 40 --raw --out x");
  CHECK(steps.code == 3);
  has(steps.text, "the two components must have the same");
  CHECK(!fs::exists(f / "x"));
}

}  // namespace test_record_command
