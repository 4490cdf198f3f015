// A frame of blocks becomes, for each block, how it has moved: exactly, whatever the motion, and from the
// state in which displacements were set to zero.

#include "support/relative.h"
#include "talus/output/read_frames.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "talus/base/error.h"
#include "talus/geometry/polygon.h"
#include "talus/output/files.h"
#include "talus/output/vtk.h"
#include "talus/output/vtk_arrays.h"

namespace test_read_frames {

using namespace talus;

namespace {

struct Moved {
  int id;
  Polygon zero;   // where it lies at zero displacement
  Vec2 shift;     // of the origin
  Mat2 gradient;  // of the displacement
  Vec2 velocity;
};

enum class Written { kNow, kBefore };  // by the present talus, with fields over blocks, or by an older one

// A frame as the recorder writes it.
std::filesystem::path frame_of(const std::vector<Moved>& blocks, Written written = Written::kBefore) {
  std::vector<double> points, moved, velocity, stress, centroid, gradient, rate;
  std::array<std::vector<double>, 3> parts;
  std::vector<int64_t> offsets, id;
  for (const Moved& b : blocks) {
    for (const Vec2 X : b.zero) {
      const Vec2 u = b.shift + b.gradient * X;
      push3(points, X + u), push3(moved, u), push3(velocity, b.velocity);
    }
    offsets.push_back(static_cast<int64_t>(points.size() / 3)), id.push_back(b.id);
    const std::array<double, 3> s{1e6 * b.id, 2e6, -3e5};
    stress.insert(stress.end(), s.begin(), s.end());
    for (size_t c = 0; c < 3; ++c) parts[c].push_back(s[c]);
    const Vec2 u = b.shift + b.gradient * polygon_moments(b.zero).centroid;
    centroid.insert(centroid.end(), {u.x, u.y}), rate.insert(rate.end(), {b.velocity.x, b.velocity.y});
    gradient.insert(gradient.end(), {b.gradient.xx, b.gradient.xy, b.gradient.yx, b.gradient.yy});
  }
  std::string fields = doubles("stress xx yy xy [Pa]", 3, stress);
  if (written == Written::kNow) {
    fields.clear();
    for (size_t c = 0; c < 3; ++c) fields += doubles(kStressArrays[c], 1, parts[c]);
    fields += doubles(kCentroidArray, 2, centroid) + doubles(kGradientArray, 4, gradient) +
              doubles(kVelocityArray, 2, rate);
  }
  const std::string text = file_begin("UnstructuredGrid") + time_field(1) + doubles("Points", 3, points) +
                           integers("offsets", offsets) + doubles("displacement [m]", 3, moved) +
                           doubles("velocity [m s-1]", 3, velocity) + fields + integers("block", id) +
                           "</UnstructuredGrid>\n</VTKFile>\n";
  static int count = 0;
  const auto path = std::filesystem::temp_directory_path() /
                    ("talus_frame_" + std::to_string(getpid()) + "_" + std::to_string(++count) + ".vtu");
  write_file(path, text);
  return path;
}

const Polygon kSquare{{10, 5}, {12, 5}, {12, 7}, {10, 7}};
const Polygon kTriangle{{0, 0}, {3, 0}, {0, 3}};

}  // namespace

TEST_CASE("frames: displacement and its gradient of a turned and sheared block, written or fitted") {
  const Mat2 H{-0.5, -0.8, 0.9, -0.4};
  FrameReader reader;
  Written written = Written::kNow;
  SUBCASE("written") {}
  SUBCASE("fitted") { written = Written::kBefore; }
  const BlockFrame f =
      reader.read(frame_of({{4, kSquare, {1e-3, -2}, H, {3, 4}}, {9, kTriangle, {}, {}, {}}}, written));
  REQUIRE(f.present == std::vector<uint8_t>{1, 1});
  REQUIRE(reader.shapes().size() == 1);
  const Vec2 u = Vec2{1e-3, -2} + H * Vec2{11, 6};  // at the centroid
  CHECK(norm(f.displacement[0] - u) < 1e-13);
  for (const double d :
       {f.gradient[0].xx - H.xx, f.gradient[0].xy - H.xy, f.gradient[0].yx - H.yx, f.gradient[0].yy - H.yy})
    CHECK(std::abs(d) < 1e-13);
  CHECK(norm(f.velocity[0] - Vec2{3, 4}) < 1e-13);
  CHECK(f.stress[0].xx == 4e6);
  CHECK(f.stress[0].xy == -3e5);
  CHECK(f.stress[0].yy == 2e6);
  CHECK(norm(reader.shapes()[0].centre[1] - Vec2{1, 1}) < 1e-15);
  const std::vector<Span> spans = f.spans();
  CHECK(spans[0].most == test::approx(norm(u)));
  CHECK(spans[0].least == 0);
}

TEST_CASE("frames: the displacement of a point that moves with a block") {
  const Mat2 H{-0.5, -0.8, 0.9, -0.4};
  FrameReader reader;
  const BlockFrame f = reader.read(frame_of({{4, kSquare, {1e-3, -2}, H, {}}}, Written::kNow));
  const Vec2 zero{10.5, 6.75}, u = Vec2{1e-3, -2} + H * zero;
  CHECK(norm(displacement_of(reader.shapes()[0], f, 4, zero + u) - u) < 1e-14);
  CHECK(displacement_of(reader.shapes()[0], f, 5, zero) == Vec2{});
}

TEST_CASE("frames: contacts keep what says something, with the other end, and are read under older names") {
  std::vector<FramePoint> points(4);
  points[0].state = 0, points[0].partner = 2;  // says nothing, but its other end does
  points[1].state = 0;
  points[2].state = 1, points[2].partner = 0, points[2].slip = 3e-3, points[2].slip_signed = -1e-3;
  points[3].force = {0, 5}, points[3].normal_force = 5, points[3].kind = 2;
  const auto path =
      std::filesystem::temp_directory_path() / ("talus_points_" + std::to_string(getpid()) + ".vtp");
  std::string text = contacts_vtp(points, 1);
  write_file(path, text);
  ContactPoints read = read_contacts(path);
  REQUIRE(read.size() == 3);
  CHECK(read.at("partner") == std::vector<double>{1, 0, -1});
  CHECK(read.at("residual_slip") == std::vector<double>{0, -1e-3, 0});
  CHECK(read.at("accumulated_slip") == std::vector<double>{0, 3e-3, 0});
  CHECK(read.at("state") == std::vector<double>{0, 1, -1});
  CHECK(read.at("kind") == std::vector<double>{0, 0, 2});

  const auto rename = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find("\"" + from + "\""), from.size() + 2, "\"" + to + "\"");
  };
  rename("accumulated slip [m]", "slip [m]"), rename("residual slip [m]", "unknown"),
      rename("corner", "none");
  write_file(path, text);
  read = read_contacts(path);
  CHECK(read.at("accumulated_slip") == std::vector<double>{0, 3e-3, 0});
  CHECK_FALSE(read.has("residual_slip"));
  CHECK_THROWS_WITH_AS(read.at("residual_slip"), doctest::Contains("older"), FileError);
  CHECK(read.at("corner") == std::vector<double>{-1, -1, -1});
  std::filesystem::remove(path);
}

TEST_CASE("frames: a block that is dug out keeps its place, displacements set to zero make new shapes") {
  FrameReader reader;
  reader.read(frame_of({{4, kSquare, {}, {}, {}}, {9, kTriangle, {}, {}, {}}}));
  const BlockFrame moved =
      reader.read(frame_of({{4, kSquare, {0.5, 0}, {}, {}}, {9, kTriangle, {}, {}, {}}}));
  CHECK(moved.shapes == 0);
  const BlockFrame dug = reader.read(frame_of({{4, kSquare, {0.5, 0}, {}, {}}}));
  CHECK(dug.shapes == 0);
  CHECK(dug.present == std::vector<uint8_t>{1, 0});
  // the same place, counted from there
  Polygon there = kSquare;
  for (Vec2& p : there) p += Vec2{0.5, 0};
  const BlockFrame reset = reader.read(frame_of({{4, there, {}, {}, {}}}));
  CHECK(reset.shapes == 1);
  REQUIRE(reader.shapes()[1].id.size() == 2);
  const size_t at = reader.shapes()[1].id[0] == 4 ? 0 : 1;
  CHECK(reset.present[at] == 1);
  CHECK(reset.present[1 - at] == 0);
  CHECK(norm(reset.displacement[at]) < 1e-15);
}

TEST_CASE("frames: frames that do not fit are refused") {
  FrameReader reader;
  reader.read(frame_of({{4, kSquare, {}, {}, {}}}));
  CHECK_THROWS_WITH_AS(reader.read(frame_of({{4, kTriangle, {}, {}, {}}})),
                       doctest::Contains("other corners"), FileError);
  CHECK_THROWS_AS(reader.read("/nowhere/frame.vtu"), FileError);
}

}  // namespace test_read_frames
