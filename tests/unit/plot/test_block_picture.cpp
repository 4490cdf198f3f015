// Pictures of blocks: what is drawn where, against what displacements are told, and moving ones.

#include "support/relative.h"
#include "talus/plot/block_picture.h"

#include <doctest/doctest.h>
#include <zlib.h>

#include <cmath>

#include "talus/base/error.h"
#include "talus/plot/animated_png.h"
#include "talus/plot/block_scenery.h"
#include "talus/plot/canvas.h"

namespace test_block_picture {

using namespace talus;
using namespace talus::plot;

namespace {

// Two squares of 1 m side by side; the left one (id 3) stays, the right one (id 7) has gone up by `up` and is sheared.
BlockPicture two_blocks(double up) {
  BlockPicture p;
  p.title = "a < b & c";
  p.time = 0.25;
  p.shapes.id = {3, 7};
  p.shapes.begin = {0, 4, 8};
  p.shapes.corner = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 0}, {2, 0}, {2, 1}, {1, 1}};
  p.shapes.centre = {{0.5, 0.5}, {1.5, 0.5}};
  p.shapes.place = {{3, 0}, {7, 1}};
  p.blocks.present = {1, 1}, p.blocks.kind = {2, 1};
  p.blocks.displacement = {{}, {0, up}};
  p.blocks.gradient = {{}, {0, 0, 0, 0}};
  p.blocks.velocity = {{}, {0, 2}};
  p.blocks.stress = {{-3, 0, 0, -1}, {}};
  p.blocks.grounds = {{"level", {0, 1}, {{0, 0}, {0, 1}}, {{}, {}}}, {"base", {}, {{0.5, 0}}, {{}}}};
  ContactPoints c;
  c.point = {{1, up}, {1, 1}, {1, 0.5}};
  c.force = {{}, {}, {-4, 3}};
  for (const ContactColumn& column : contact_columns()) c.columns[column.name].assign(3, 0);
  c.columns["block_a"] = {7, 7, 7}, c.columns["block_b"] = {3, 3, 3};
  c.columns["partner"] = {1, 0, -1};
  c.columns["state"] = {1, 1, 1};
  c.columns["residual_slip"] = {up, -up, 0.5 * up}, c.columns["accumulated_slip"] = {3 * up, up, up};
  c.columns["normal_force"] = {0, 0, 4}, c.columns["shear_force"] = {0, 0, 3};
  p.contacts = c;
  return p;
}

struct Chunk {
  std::string kind, content;
};

uint32_t number(const std::string& text, size_t at) {
  uint32_t v = 0;
  for (size_t k = 0; k < 4; ++k) v = v << 8 | static_cast<unsigned char>(text[at + k]);
  return v;
}

std::vector<Chunk> chunks_of(const std::string& png) {
  std::vector<Chunk> out;
  for (size_t at = 8; at + 12 <= png.size();) {
    const uint32_t size = number(png, at);
    const std::string body = png.substr(at + 4, 4 + size);
    CHECK(number(png, at + 8 + size) ==
          crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
    out.push_back({body.substr(0, 4), body.substr(4)});
    at += 12 + size;
  }
  return out;
}

}  // namespace

TEST_CASE(
    "pictures: displacements drawn several times take bolts along, also where they end on a face or in an open joint") {
  BlockPicture p = two_blocks(0.1);
  p.deformation = 5;
  BoltPieces b;
  // through the left block from its face to the joint, across it, and through the right block, which has gone up by 0.1
  b.from = {{0, 0.5}, {1, 0.5}, {1, 0.6}}, b.to = {{1, 0.5}, {1, 0.6}, {2, 0.6}};
  b.axial_force = {1, 2, 3}, b.shear_force = {0, 0, 0}, b.elongation = {0, 0, 0};
  b.condition = {0, 1, 2}, b.crossing = {0, 1, 0};
  p.bolts = b;
  const Scenery s = scenery_of(p);
  REQUIRE(s.bolts.size() == 3);
  CHECK(norm(s.bolts[0].from - Vec2{0, 0.5}) < 1e-15);
  CHECK(norm(s.bolts[0].to - Vec2{1, 0.5}) < 1e-15);
  CHECK(norm(s.bolts[1].from - Vec2{1, 0.5}) < 1e-15);  // with the left block
  CHECK(norm(s.bolts[1].to - Vec2{1, 1.0}) < 1e-15);    // with the right one, which is drawn 0.5 up
  CHECK(norm(s.bolts[2].from - Vec2{1, 1.0}) < 1e-15);
  CHECK(norm(s.bolts[2].to - Vec2{2, 1.0}) < 1e-15);
  CHECK(s.ruptured);
}

TEST_CASE("pictures: displacements drawn several times take joints along") {
  BlockPicture p = two_blocks(0.1);
  p.deformation = 5;
  const Scenery s = scenery_of(p);
  REQUIRE(s.shapes.size() == 2);
  CHECK(s.shapes[0].polygon[2] == Vec2{1, 1});
  CHECK(norm(s.shapes[1].polygon[0] - Vec2{1, 0.5}) < 1e-15);
  // the corner of the right block at (1, 0.1) is drawn where its polygon is
  REQUIRE(s.joints.size() == 2);
  CHECK(norm(s.joints[0].from - Vec2{1, 0.5}) < 1e-15);
  CHECK(norm(s.joints[0].to - Vec2{1, 1.4}) < 1e-15);
  CHECK(s.residual);
  CHECK(s.joints[0].slip == 0.1);
  CHECK(norm(s.joints[0].moved - Vec2{0, 0.1}) < 1e-15);
  // a point that has no other end is a joint of its own
  CHECK(s.joints[1].from == s.joints[1].to);
  CHECK(s.joints[1].slip == 0.05);
}

TEST_CASE("pictures: displacements told against a block, a support, a free field at the same height") {
  BlockPicture p = two_blocks(0.1);
  p.quantity = "displacement_y";
  p.against_name = "right";
  p.against = Against{{{7, 1.0}}, ""};
  CHECK(scenery_of(p).shapes[0].value == test::approx(-0.1).epsilon(1e-15));
  CHECK(scenery_of(p).shapes[1].value == 0);
  p.deformation = 10;  // what is told against moves with it: the right block lies where it is
  CHECK(norm(scenery_of(p).shapes[1].polygon[0] - Vec2{1, 0.1}) < 1e-15);
  CHECK(norm(scenery_of(p).shapes[0].polygon[0] - Vec2{0, -0.9}) < 1e-15);
  p.deformation = 1;
  p.against = Against{{}, "level"};  // half a metre up it has moved by half of the metre at the top
  CHECK(scenery_of(p).shapes[0].value == test::approx(-0.5).epsilon(1e-15));
  p.quantity = "displacement_x";
  p.against = Against{{}, "base"};
  CHECK(scenery_of(p).shapes[1].value == -0.5);
  p.quantity = "velocity_y";
  p.against = Against{{{3, 1.0}, {7, 3.0}}, ""};  // the mean by weight
  CHECK(scenery_of(p).shapes[0].value == -1.5);
  p.against = Against{{}, "nowhere"};
  CHECK_THROWS_AS(scenery_of(p), FileError);
}

TEST_CASE("pictures: crosses of principal stresses and chains of forces") {
  BlockPicture p = two_blocks(0.1);
  p.blocks.stress[1] = {1, 2, 2, 1};  // 3 along (1, 1), -1 across
  p.overlays = {Overlay::kPrincipal, Overlay::kForces};
  const Scenery s = scenery_of(p);
  REQUIRE(s.crosses.size() == 2);
  CHECK(s.crosses[1].first == test::approx(3));
  CHECK(s.crosses[1].second == test::approx(-1));
  CHECK(std::abs(s.crosses[1].axis.x) == test::approx(std::sqrt(0.5)));
  CHECK(s.crosses[1].axis.x * s.crosses[1].axis.y > 0);
  CHECK(s.crosses[0].first == -1);  // along y
  CHECK(std::abs(s.crosses[0].axis.x) < 1e-15);
  CHECK(s.stress == test::approx(3));
  REQUIRE(s.chains.size() == 1);
  CHECK(s.force == 5);
  REQUIRE(s.chains[0].places.size() == 3);
  CHECK(norm(s.chains[0].places[0] - Vec2{1.5, 0.6}) < 1e-15);
  CHECK(s.chains[0].places[1] == Vec2{1, 0.5});
  CHECK(s.chains[0].places[2] == Vec2{0.5, 0.5});
}

TEST_CASE("pictures: an SVG of blocks by kind, and no block in the window") {
  BlockPicture p = two_blocks(0.1);
  p.quantity.clear();
  const std::string svg = block_picture_svg(p);
  CHECK(svg.find("</svg>") != std::string::npos);
  p.window = Box{{50, 50}, {60, 60}};
  CHECK_THROWS_WITH_AS(block_picture_svg(p), doctest::Contains("no block lies in the window"), Error);
}

TEST_CASE("pictures: a moving PNG holds every frame once, in order, with sums that are right") {
  const auto frame = [](double grey) {
    return picture_png(20, 10, 1, [grey](cairo_t* cr) {
      cairo_set_source_rgb(cr, grey, grey, grey);
      cairo_paint(cr);
    });
  };
  const std::vector<std::string> frames{frame(0), frame(0.5), frame(1)};
  const std::vector<Chunk> chunks = chunks_of(animated_png(frames, 0.25));
  std::string kinds;
  for (const Chunk& c : chunks) kinds += c.kind + " ";
  CHECK(kinds == "IHDR acTL fcTL IDAT fcTL fdAT fcTL fdAT IEND ");
  CHECK(number(chunks[1].content, 0) == 3);
  for (size_t k = 0; k < 3; ++k) {
    const Chunk& control = chunks[2 + 2 * k];
    const std::string& data = chunks[3 + 2 * k].content;
    CHECK(number(control.content, 0) == (k == 0 ? 0 : 2 * k - 1));
    CHECK(number(control.content, 4) == 20);
    CHECK(number(control.content, 8) == 10);
    CHECK(static_cast<unsigned char>(control.content[21]) == (k == 2 ? 1000 % 256 : 250));
    std::string own;
    for (const Chunk& c : chunks_of(frames[k]))
      if (c.kind == "IDAT") own += c.content;
    CHECK((k == 0 ? data : data.substr(4)) == own);
  }
  CHECK_THROWS_AS(animated_png({frames[0], "no PNG"}, 1), FileError);
}

TEST_CASE("pictures: a film without ffmpeg is refused with what to do") {
  const char* path = std::getenv("PATH");
  const std::string kept = path ? path : "";
  setenv("PATH", "/nowhere", 1);
  CHECK_THROWS_WITH_AS(write_animation([](size_t) { return two_blocks(0.1); }, 2, 0.1, "film.mp4"),
                       doctest::Contains("ffmpeg"), FileError);
  setenv("PATH", kept.c_str(), 1);
}

}  // namespace test_block_picture
