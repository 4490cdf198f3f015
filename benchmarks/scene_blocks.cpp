// Prints the blocks of a scene as JSON, for drivers that are not written in C++ (rivals/ntdda.py): kind, friction,
// density, and of each block whether it is fixed and its corners [m], to the last bit.
// Usage: scene-blocks SCENE

#include <fmt/format.h>

#include <stdexcept>

#include "command_line.h"
#include "scenes.h"

namespace {

using namespace talus::bench;

int run(int argc, char** argv) {
  if (argc != 2) throw std::invalid_argument("usage: SCENE");
  const BenchScene scene = named_scene(argv[1]);
  fmt::print("{{\"kind\": \"{}\", \"friction\": {}, \"density\": {}, \"blocks\": [", scene.name,
             scene.friction, scene.density);
  const char* between = "\n";
  for (const BenchBlock& block : scene.blocks) {
    fmt::print("{}{{\"fixed\": {}, \"corners\": [", between, block.fixed);
    for (size_t i = 0; i < block.corners.size(); ++i)
      fmt::print("{}[{}, {}]", i == 0 ? "" : ", ", block.corners[i].x, block.corners[i].y);
    fmt::print("]}}");
    between = ",\n";
  }
  fmt::print("\n]}}\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_program("scene-blocks", run, argc, argv); }
