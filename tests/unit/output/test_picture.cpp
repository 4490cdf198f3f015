#include "talus/output/picture.h"

#include <doctest/doctest.h>

namespace test_picture {

using namespace talus;

TEST_CASE("the picture holds every block in true proportion, with names, time and escaped title") {
  Model model;
  model.materials.push_back({"m", 2000, 1e9, 0.2});
  Layout layout;
  for (int i = 0; i < 2; ++i) {
    BlockShape b;
    b.name = i == 0 ? "low" : "high";
    b.group = i;
    b.polygon = {{0, 2.0 * i}, {4, 2.0 * i}, {4, 2.0 * i + 1}, {0, 2.0 * i + 1}};
    b.kind = i == 0 ? BlockKind::kFixed : BlockKind::kRigid;
    layout.blocks.push_back(b);
    layout.groups.push_back(b.name);
  }
  const BlockSet blocks = build_blocks(model, layout);
  State state = initial_state(blocks, layout);
  state.time = 0.25;
  const std::string svg = blocks_svg(blocks, state, "a < b & c");
  // 4 x 3 m on 860 px: 215 px a metre; the first block's lower left corner is 3 m below the top
  CHECK(svg.find("points=\"20.00,685.00 880.00,685.00 880.00,470.00 20.00,470.00 \"") != std::string::npos);
  CHECK(svg.find("<title>high</title>") != std::string::npos);
  CHECK(svg.find("a &lt; b &amp; c") != std::string::npos);
  CHECK(svg.find("t = 0.25 s") != std::string::npos);
  CHECK(svg.find(">0.5 m</text>") != std::string::npos);
}

}  // namespace test_picture
