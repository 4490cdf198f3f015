// Frames are read back as they were written, and anything else is refused with the file's name.

#include "talus/output/read_vtk.h"

#include <doctest/doctest.h>

#include "talus/base/error.h"
#include "talus/output/bolt_lines.h"
#include "talus/output/contact_points.h"
#include "talus/output/text_table.h"
#include "talus/output/vtk.h"
#include "talus/output/vtk_arrays.h"

namespace test_read_vtk {

using namespace talus;

namespace {

std::string two_contacts() {
  FramePoint a, b;
  a.point = {1.5, -2.25}, a.force = {1e6, 0.1}, a.normal_force = 3, a.state = 1, a.slip = 1e-17;
  a.block_a = 7, a.block_b = 123456, a.corner = 3, a.edge = 2;
  b.kind = 3, b.gap = -1e300;
  return contacts_vtp({a, b}, 0.1 + 0.2);
}

}  // namespace

TEST_CASE("output: a frame of contacts comes back to the last bit") {
  const VtkFrame f = parse_vtk("frame", two_contacts());
  CHECK(f.time == 0.1 + 0.2);
  CHECK(f.at("Points", 3, 2).values == std::vector<double>{1.5, -2.25, 0, 0, 0, 0});
  CHECK(f.at("force [N]", 3, 2).values == std::vector<double>{1e6, 0.1, 0, 0, 0, 0});
  CHECK(f.at("accumulated slip [m]", 1, 2).values == std::vector<double>{1e-17, 0});
  CHECK(f.at("gap [m]", 1, 2).values == std::vector<double>{0, -1e300});
  CHECK(f.at("state", 1, 2).values == std::vector<double>{1, -1});
  CHECK(f.at("block b", 1, 2).values == std::vector<double>{123456, -1});
  CHECK(f.at("corner", 1, 2).values == std::vector<double>{3, 0});
}

TEST_CASE("output: base64 of every length comes back") {
  for (size_t n = 0; n < 9; ++n) {
    std::vector<uint8_t> bytes(n);
    for (size_t i = 0; i < n; ++i) bytes[i] = static_cast<uint8_t>(251 * (i + 1));
    const std::string text = file_begin("PolyData") + data_array("UInt8", "bytes", 1, bytes) + "</VTKFile>";
    const VtkFrame f = parse_vtk("frame", text);
    REQUIRE(f.at("bytes", 1).tuples() == n);
    for (size_t i = 0; i < n; ++i) CHECK(f.at("bytes", 1).values[i] == bytes[i]);
  }
}

TEST_CASE("output: frames that are cut off or foreign are refused by name") {
  const std::string whole = two_contacts();
  for (const size_t size : {size_t{0}, size_t{10}, whole.size() / 3, whole.size() / 2, whole.size() - 12}) {
    CHECK_THROWS_WITH_AS(parse_vtk("frame.vtp", whole.substr(0, size)), doctest::Contains("frame.vtp: "),
                         FileError);
  }
  std::string other = whole;
  other.replace(other.find("Float64\" Name=\"Points"), 7, "Float99");
  CHECK_THROWS_WITH_AS(parse_vtk("f", other), doctest::Contains("type \"Float99\""), FileError);
  other = whole;
  other[other.find("binary\">") + 12] = '!';
  CHECK_THROWS_WITH_AS(parse_vtk("f", other), doctest::Contains("no base64"), FileError);
  const VtkFrame f = parse_vtk("f", whole);
  CHECK_THROWS_WITH_AS(f.at("stress", 3), doctest::Contains("no array \"stress\""), FileError);
  CHECK_THROWS_WITH_AS(f.at("Points", 3, 5), doctest::Contains("2 tuples"), FileError);
}

TEST_CASE("output: tables with names that hold commas and quotes come back") {
  const TextTable t = parse_text_table(
      "t.csv", "name,x\n" + table_cell("wall[0,1]") + ",1\n" + table_cell("the \"old\" one") + ",2\r\n");
  REQUIRE(t.rows.size() == 2);
  CHECK(t.rows[0][0] == "wall[0,1]");
  CHECK(t.rows[1] == std::vector<std::string>{"the \"old\" one", "2"});
  CHECK(t.find("x") == 1);
  CHECK(t.find("y") == -1);
  CHECK_THROWS_WITH_AS(parse_text_table("t.csv", "a,b\n1\n"), doctest::Contains("t.csv:2: has 1 cells"),
                       FileError);
  CHECK_THROWS_WITH_AS(parse_text_table("t.csv", "a,b\n\"1,2\n"), doctest::Contains("no end"), FileError);
  CHECK_THROWS_AS(parse_text_table("t.csv", ""), FileError);
}

}  // namespace test_read_vtk
