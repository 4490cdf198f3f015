// Time and memory of cutting against the number of blocks: two joint sets at 75 and 125 degrees through 200 x 300 m
// with a 9.8 m tunnel, at spacings that halve the blocks' area several times. One process per size, so that the
// memory is that of one cut.
// Usage: cut_time SPACING [REPEATS]    prints: spacing [m], blocks, median seconds, peak memory [MB]

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "talus/cut/cut.h"
#include "talus/model/read_model.h"

namespace {

std::string model_text(double spacing) {
  return fmt::format(R"(talus = 1
[material.rock]
density = 2850
young = 5e9
poisson = 0.29
[[region]]
name = "rock"
polygon = [[0, 0], [200, 0], [200, 300], [0, 300]]
material = "rock"
[[joint_set]]
name = "steep"
angle = "75 deg"
spacing = {0}
[[joint_set]]
name = "flat"
angle = "125 deg"
spacing = {0}
[[opening]]
name = "tunnel"
shape = "circle"
center = [100, 200]
diameter = 9.8
)",
                     spacing);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: cut_time SPACING [REPEATS]\n");
    return 2;
  }
  const double spacing = std::atof(argv[1]);
  const int repeats = argc > 2 ? std::atoi(argv[2]) : 5;
  const std::string text = model_text(spacing);
  std::vector<double> seconds;
  size_t blocks = 0;
  for (int i = 0; i < repeats; ++i) {
    talus::Findings findings("cut_time", text);
    const talus::Model model = talus::read_model("cut_time", text, {}, findings);
    findings.throw_if_errors();
    const auto begin = std::chrono::steady_clock::now();
    blocks = talus::cut_model(model, findings).blocks.size();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  std::sort(seconds.begin(), seconds.end());
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print("{},{},{:.4g},{:.4g}\n", spacing, blocks, seconds[seconds.size() / 2],
             static_cast<double>(usage.ru_maxrss) / 1024);
}
