// The example of talus.h: what it says compiles, runs, and is what the header shows.

#include "talus/talus.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "support/tolerance.h"
#include "talus/base/text_file.h"

// the words of the header, begin
struct Fastest : talus::Observer {
  void at(const talus::Instant& now) override {
    for (size_t i = 0; i < now.state.rate.size(); ++i)
      speed = std::max(speed, talus::norm(talus::rate_now(now.work, now.state, i).a));  // [m/s]
  }
  double speed = 0;
};
// the words of the header, end

namespace test_talus_h {

using namespace talus;
using namespace talus::test;

namespace {

// A block that falls for a second, thrown upwards at 3 m/s.
const std::string text = R"(talus = 1
[model]
gravity = [0, -10]
[material.rock]
density = 2000
[joint.face]
friction_angle = "30 deg"
[contact]
joint = "face"
[[block]]
name = "stone"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "rock"
kind = "rigid"
velocity = [0, 3]
[[stage]]
name = "fall"
kind = "dynamic"
duration = 1
time_step = 1e-3
)";

// Lines of code without indentation: of the header those in its comment, which stand three blanks after the
// slashes, of this file those between two marks.
std::vector<std::string> shown(const std::string& header) {
  std::vector<std::string> lines;
  std::istringstream in(header);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("//   ")) lines.push_back(line.substr(line.find_first_not_of(" /")));
  return lines;
}
std::vector<std::string> compiled(const std::string& source) {
  std::vector<std::string> lines;
  std::istringstream in(source);
  bool within = false;
  for (std::string line; std::getline(in, line);) {
    const size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    line = line.substr(begin);
    const bool mark = line.starts_with("// the words of the header, ");
    if (mark) within = line.ends_with("begin");
    if (within && !mark) lines.push_back(line);
  }
  return lines;
}

}  // namespace

TEST_CASE("talus.h: its example compiles and runs") {
  // the words of the header, begin
  talus::Findings findings("model.toml", text);
  talus::PreparedRun run = talus::prepare_run("model.toml", text, {}, findings);  // or InputError
  talus::State state = talus::start_state(run.scene);
  Fastest observer;  // or a talus::Recorder, which writes a folder of results
  talus::RunResult result = talus::run_stages(run.scene, run.plans, state, observer);
  // the words of the header, end
  CHECK(result.failure == "");
  // at the last instant the mean of the velocities before and after the kick: 3 - 10 x 1
  check_close("fastest [m/s]", observer.speed, 7, 1e-12, 1e-13);
}

TEST_CASE("talus.h: its example is the one above, word by word") {
  const std::vector<std::string> example = shown(read_text_file(TALUS_SOURCE_DIR "/src/talus/talus.h"));
  CHECK(!example.empty());
  CHECK(compiled(read_text_file(TALUS_SOURCE_DIR "/tests/unit/test_talus_h.cpp")) == example);
}

}  // namespace test_talus_h
