#include "talus/output/bolt_lines.h"
#include "talus/output/contact_points.h"
#include "talus/output/frame_series.h"
#include "talus/output/paraview_view.h"
#include "talus/output/vtk.h"

#include <doctest/doctest.h>

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>
#include "support/relative.h"

namespace test_vtk {

using namespace talus;
using namespace talus::test;

namespace {

namespace fs = std::filesystem;

std::vector<unsigned char> decode(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  REQUIRE(text.size() % 4 == 0);
  std::vector<unsigned char> bytes;
  uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    const size_t digit = digits.find(c);
    REQUIRE(digit != std::string::npos);
    bits = bits << 6 | static_cast<uint32_t>(digit);
    held += 6;
    if (held >= 8) held -= 8, bytes.push_back(static_cast<unsigned char>(bits >> held & 255));
  }
  return bytes;
}

// Values of the DataArray `name`; the byte count in front of them must be right.
template <class T>
std::vector<T> values(const std::string& xml, const std::string& name, const std::string& type,
                      int components) {
  const size_t at = xml.find("type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                             std::to_string(components) + "\" format=\"binary\">");
  INFO(name);
  REQUIRE(at != std::string::npos);
  const size_t begin = xml.find('>', at) + 1, end = xml.find('<', begin);
  const auto bytes = decode(xml.substr(begin, end - begin));
  REQUIRE(bytes.size() >= 8);
  uint64_t count = 0;
  std::memcpy(&count, bytes.data(), 8);
  REQUIRE(count == bytes.size() - 8);
  std::vector<T> out(count / sizeof(T));
  if (count > 0) std::memcpy(out.data(), bytes.data() + 8, count);
  return out;
}

std::vector<double> doubles(const std::string& xml, const std::string& name, int components) {
  return values<double>(xml, name, "Float64", components);
}

std::vector<int64_t> integers(const std::string& xml, const std::string& name) {
  const auto list = values<int32_t>(xml, name, "Int32", 1);
  return {list.begin(), list.end()};
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

struct Setup {
  Model model;
  Layout layout;
  BlockSet blocks;
  State state;

  Setup() {
    model.materials = {{"soft", 2, 10, 0}, {"hard", 3, 1000, 0.2}};
    BlockInput a, b;
    a.name = "a", b.name = "b";
    a.polygon = {{0, 0}, {2, 0}, {2, 1}, {0, 1}};
    b.polygon = {{3, 0}, {4, 0}, {3, 1}};
    a.material = 0, b.material = 1;
    b.kind = BlockKind::kRigid;
    model.blocks = {a, b};
    Findings findings("case.toml", "");
    layout = make_layout(model, findings);
    REQUIRE_FALSE(findings.has_errors());
    blocks = build_blocks(model, layout);
    state = initial_state(blocks, layout);
    state.time = 0.1;
    state.displacement = {{0.5, -0.25}, {0, 1}};
    state.strain_part[0] = {0.5, 0, 0, 0};              // half as long again along x
    state.strain_part[1] = rotation_minus_identity(1);  // turned
  }
};

}  // namespace

TEST_CASE("a frame of blocks holds place, displacement, velocity and stress") {
  const Setup s;
  const std::vector<BlockRate> rate{{{1, 2}, {4, 0, 0, 0}}, {{0, 0}, spin_matrix(2)}};
  const std::string xml = blocks_vtu(s.blocks, s.state, rate);
  CHECK(has(xml, "<Piece NumberOfPoints=\"7\" NumberOfCells=\"2\">"));
  CHECK(has(xml, ">0.10000000000000001</DataArray>"));

  // block a: centroid (1, .5), arms (-+1, -+.5); all numbers are exact in binary
  const auto points = doubles(xml, "Points", 3), shift = doubles(xml, "displacement [m]", 3),
             velocity = doubles(xml, "velocity [m s-1]", 3);
  REQUIRE(points.size() == 21);
  REQUIRE(shift.size() == 21);
  REQUIRE(velocity.size() == 21);
  const std::vector<double> place{0, -0.25, 0, 3, -0.25, 0, 3, 0.75, 0, 0, 0.75, 0};
  const std::vector<double> moved{0, -0.25, 0, 1, -0.25, 0, 1, -0.25, 0, 0, -0.25, 0};
  const std::vector<double> moving{-3, 2, 0, 5, 2, 0, 5, 2, 0, -3, 2, 0};
  for (size_t i = 0; i < 12; ++i) {
    CAPTURE(i);
    CHECK(points[i] == place[i]);
    CHECK(shift[i] == moved[i]);
    CHECK(velocity[i] == moving[i]);
  }

  // block b spins about its centroid: each corner moves at right angles to its arm as it lies now
  const Vec2 middle = s.blocks.centroid[1] + Vec2{0, 1};
  for (int v = 0; v < 3; ++v) {
    const size_t i = 12 + 3 * v;
    const Vec2 arm = Vec2{points[i], points[i + 1]} - middle, first = s.blocks.corner({1, v});
    // roundings of numbers of order 1
    CHECK(norm(arm) == relative(norm(first), 1e-14));
    CHECK(cross(first, arm) == relative(dot(first, first) * std::sin(1.0), 1e-13));
    CHECK(norm(Vec2{velocity[i], velocity[i + 1]} - 2 * turn_left(arm)) <= 1e-14);
  }

  // poisson 0: c11 = young, stress = young x strain along x, and nothing else
  CHECK(doubles(xml, "stress xx [Pa]", 1)[0] == relative(5, 1e-14));
  CHECK(doubles(xml, "stress xx [Pa]", 1)[1] == 0);
  for (const char* name : {"stress yy [Pa]", "stress xy [Pa]"})
    CHECK(doubles(xml, name, 1) == std::vector<double>{0, 0});
}

TEST_CASE("a frame of blocks holds F - I and the rates of each block") {
  Setup s;
  const std::vector<BlockRate> rate{{{1, 2}, {4, 0, 8, 0}}, {{0, 0}, spin_matrix(2)}};
  std::string xml = blocks_vtu(s.blocks, s.state, rate);
  CHECK(doubles(xml, "centroid displacement [m]", 2) == std::vector<double>{0.5, -0.25, 0, 1});
  CHECK(doubles(xml, "centroid velocity [m s-1]", 2) == std::vector<double>{1, 2, 0, 0});
  std::vector<double> h = doubles(xml, "displacement gradient", 4),
                      l = doubles(xml, "velocity gradient [s-1]", 4);
  REQUIRE(h.size() == 8);
  CHECK(std::vector<double>(h.begin(), h.begin() + 4) == std::vector<double>{0.5, 0, 0, 0});
  CHECK(h[4] == relative(std::cos(1.0) - 1, 1e-15));
  CHECK(h[6] == relative(std::sin(1.0), 1e-15));
  // against places now: block a is half as long again; a rigid block's rate is against them already
  const std::vector<double> expected{4 / 1.5, 0, 8 / 1.5, 0, 0, -2, 2, 0};
  for (size_t i = 0; i < l.size(); ++i) CHECK(l[i] == approx(expected[i]).epsilon(1e-15));

  // displacements counted from a state in between: F F0^-1 - I
  s.state.displacement_start = {{0.5, 0}, {0, 1}};
  s.state.strain_part_start = {Mat2{0.25, 0, 0, 0}, s.state.strain_part[1]};
  xml = blocks_vtu(s.blocks, s.state, rate);
  h = doubles(xml, "displacement gradient", 4);
  CHECK(doubles(xml, "centroid displacement [m]", 2) == std::vector<double>{0, -0.25, 0, 0});
  CHECK(h[0] == relative(1.5 / 1.25 - 1, 1e-15));
  for (size_t i = 1; i < h.size(); ++i) CHECK(std::abs(h[i]) < 1e-16);
}

TEST_CASE("cells of a frame name corners, block, kind, material and group") {
  const Setup s;
  const std::string xml = blocks_vtu(s.blocks, s.state, s.state.rate);
  using Integers = std::vector<int64_t>;
  CHECK(integers(xml, "connectivity") == Integers{0, 1, 2, 3, 4, 5, 6});
  CHECK(integers(xml, "offsets") == Integers{4, 7});
  CHECK(integers(xml, "block") == Integers{0, 1});
  CHECK(integers(xml, "kind") == Integers{0, 1});
  CHECK(integers(xml, "material") == Integers{0, 1});
  CHECK(integers(xml, "group") == Integers{0, 1});
  CHECK(values<uint8_t>(xml, "types", "UInt8", 1) == std::vector<uint8_t>{7, 7});
}

TEST_CASE("a frame of contacts") {
  std::vector<FramePoint> contacts(2);
  contacts[0].point = {1, 2}, contacts[0].force = {3, 4}, contacts[0].gap = 0.25;
  contacts[0].normal_force = 5, contacts[0].shear_force = -6;
  contacts[1].point = {7, 8}, contacts[1].force = {9, 10}, contacts[1].kind = 2;
  contacts[1].normal_force = 11, contacts[1].shear_force = 12;
  const std::string xml = contacts_vtp(contacts, 2);
  using Doubles = std::vector<double>;
  CHECK(doubles(xml, "Points", 3) == Doubles{1, 2, 0, 7, 8, 0});
  CHECK(doubles(xml, "force [N]", 3) == Doubles{3, 4, 0, 9, 10, 0});
  CHECK(doubles(xml, "normal force [N]", 1) == Doubles{5, 11});
  CHECK(doubles(xml, "shear force [N]", 1) == Doubles{-6, 12});
  CHECK(doubles(xml, "gap [m]", 1) == Doubles{0.25, 0});
  CHECK(integers(xml, "kind") == std::vector<int64_t>{0, 2});
  CHECK(integers(xml, "offsets") == std::vector<int64_t>{1, 2});
  CHECK(has(xml, "NumberOfPoints=\"2\" NumberOfVerts=\"2\""));
  CHECK(doubles(contacts_vtp({}, 0), "Points", 3).empty());
}

TEST_CASE("the state file for ParaView asks for arrays that frames have") {
  const Setup s;
  const std::string frames =
      blocks_vtu(s.blocks, s.state, s.state.rate) + contacts_vtp({}, 0) + bolts_vtp({}, 0);
  const std::string script = paraview_view();
  CHECK_FALSE(has(script, "@"));
  for (const std::string name : {"displacement [m]", "force [N]", "state", "axial force [N]"}) {
    INFO(name);
    CHECK(has(script, "\"" + name + "\""));
    CHECK(has(frames, "Name=\"" + name + "\""));
  }
}

TEST_CASE("the collection lists every frame written so far") {
  const fs::path folder = fs::temp_directory_path() / ("talus_vtk_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const auto content = [&](const std::string& name) -> std::string {
    std::ifstream file(folder / "fields" / name);
    return {std::istreambuf_iterator<char>(file), {}};
  };
  ResultFolder results(folder, true);
  results.make_folder("fields");
  FrameSeries series(results, "blocks", "vtu");
  series.add(0, "first");
  CHECK(has(content("blocks.pvd"), "timestep=\"0\" group=\"\" part=\"0\" file=\"blocks_000000.vtu\""));
  CHECK_FALSE(has(content("blocks.pvd"), "blocks_000001"));
  series.add(0.1, "second");
  CHECK(series.count() == 2);
  CHECK(content("blocks_000000.vtu") == "first");
  CHECK(content("blocks_000001.vtu") == "second");
  CHECK(has(content("blocks.pvd"), "timestep=\"0\" group=\"\" part=\"0\" file=\"blocks_000000.vtu\""));
  CHECK(has(content("blocks.pvd"),
            "timestep=\"0.10000000000000001\" group=\"\" part=\"0\" file=\"blocks_000001.vtu\""));
  CHECK(has(content("blocks.pvd"), "</Collection>"));
  CHECK(std::distance(fs::directory_iterator(folder / "fields"), fs::directory_iterator()) == 3);
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

}  // namespace test_vtk
