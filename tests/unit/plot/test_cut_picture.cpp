#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/folder.h"
#include "support/relative.h"
#include "talus/cut/check_places.h"
#include "talus/cut/cut.h"
#include "talus/model/read_model.h"
#include "talus/plot/cut_picture.h"

namespace test_cut_picture {

namespace {

namespace fs = std::filesystem;
using namespace talus;
using namespace talus::test;

// A folder of its own that disappears with the test.

const std::string kRock = "[material.rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.25\n";

std::string region(const std::string& polygon) {
  return kRock + "[[region]]\nname = \"rock\"\nmaterial = \"rock\"\npolygon = " + polygon + "\n";
}

std::string joint_set(const std::string& name, int angle, double spacing, const std::string& more = "") {
  return "[[joint_set]]\nname = \"" + name + "\"\nangle = \"" + std::to_string(angle) +
         " deg\"\nspacing = " + std::to_string(spacing) + "\n" + more;
}

std::string monitor(const std::string& name, double x, double y) {
  return "[[monitor]]\nname = \"" + name + "\"\npoint = [" + std::to_string(x) + ", " + std::to_string(y) +
         "]\n";
}

// Without the number that cairo gives to each surface, so that equal pictures compare equal.
std::string without_number(std::string svg) {
  const std::string name = "id=\"surface";
  const std::size_t from = svg.find(name) + name.size();
  return svg.erase(from, svg.find('"', from) - from);
}

// The SVG of the model in `text`, written and read back; the PNG must be there as well.
std::string svg_of(const std::string& text) {
  const Folder folder;
  const std::string whole = "talus = 1\n" + text;
  Findings findings("model.toml", whole);
  const Model model = read_model("model.toml", whole, {}, findings);
  const Cut cut = cut_model(model, findings);
  INFO(findings.render());
  CHECK(model.shapes_readable);
  const Layout layout = checked_layout(model, cut, findings);
  plot::write_cut_picture(model, cut, layout, folder / "cut");
  CHECK(content(folder / "cut.png").substr(0, 8) == "\x89PNG\r\n\x1a\n");
  const std::string svg = content(folder / "cut.svg");
  CHECK(svg.substr(0, 5) == "<?xml");
  CHECK(svg.find("</svg>", svg.size() - 8) != std::string::npos);
  return without_number(svg);
}

// What a path element draws.
struct Drawn {
  std::string style, data;
  std::vector<double> x, y;  // of all its points [px]
};

std::string attribute(const std::string& element, const std::string& name) {
  const std::size_t start = element.find(name + "=\"");
  if (start == std::string::npos) return "";
  const std::size_t from = start + name.size() + 2;
  return element.substr(from, element.find('"', from) - from);
}

// Paths whose style holds `style`, e.g. a colour; glyphs have none.
std::vector<Drawn> paths(const std::string& svg, const std::string& style) {
  std::vector<Drawn> list;
  for (std::size_t at = svg.find("<path"); at != std::string::npos; at = svg.find("<path", at + 1)) {
    const std::string element = svg.substr(at, svg.find('>', at) - at);
    Drawn drawn{attribute(element, "style"), attribute(element, " d"), {}, {}};
    if (drawn.style.find(style) == std::string::npos) continue;
    std::istringstream words(drawn.data);
    for (std::string word; words >> word;) {
      if (word != "M" && word != "L") continue;
      double x = 0, y = 0;
      words >> x >> y;
      drawn.x.push_back(x);
      drawn.y.push_back(y);
    }
    list.push_back(drawn);
  }
  return list;
}

double span(const std::vector<double>& v) {
  return *std::max_element(v.begin(), v.end()) - *std::min_element(v.begin(), v.end());
}

const std::string kBlue = "stroke:rgb(0%,44.7", kVermilion = "stroke:rgb(83.5", kGrey = "stroke:rgb(60%,60%";
const std::string kBlack = "stroke:rgb(0%,0%,0%)", kSand = "fill:rgb(97.5%,95.5",
                  kYellow = "fill:rgb(100%,92.5";
const std::string kBox = "[[0, 0], [20, 0], [20, 10], [0, 10]]";

}  // namespace

TEST_CASE("write_cut_picture draws a joint where it is, in true proportion") {
  const std::string svg = svg_of(region(kBox) + joint_set("steep", 90, 30, "origin = [5, 0]\n"));
  const auto outline = paths(svg, kBlack);
  const auto joint = paths(svg, kBlue);
  REQUIRE(outline.size() == 2);  // the drawing and the sample in the legend
  REQUIRE(joint.size() == 2);
  const double width = span(outline[0].x), height = span(outline[0].y);
  CHECK(width > 1000);
  CHECK(height / width == approx(0.5).epsilon(1e-3));  // coordinates are multiples of 1/256 px
  REQUIRE(joint[0].x.size() == 2);                     // shared by two blocks, drawn once
  const double left = *std::min_element(outline[0].x.begin(), outline[0].x.end());
  CHECK((joint[0].x[0] - left) / width == approx(0.25).epsilon(1e-3));
  CHECK(span(joint[0].x) == doctest::Approx(0).epsilon(0.01));
  CHECK(span(joint[0].y) == approx(height).epsilon(1e-3));
}

TEST_CASE("write_cut_picture draws every trace as one line and every origin as one path") {
  const std::string svg =
      svg_of(region(kBox) + "[cut]\nslivers = \"keep\"\n" + joint_set("flat", 0, 1, "origin = [0, 0.5]\n") +
             joint_set("steep", 90, 1, "origin = [0.5, 0]\n"));
  const auto flat = paths(svg, kBlue), steep = paths(svg, kVermilion);
  REQUIRE(flat.size() == 2);
  REQUIRE(steep.size() == 2);
  CHECK(flat[0].x.size() == 2 * 10);
  CHECK(steep[0].x.size() == 2 * 20);
  const auto fill = paths(svg, kSand);  // 231 blocks, but only their common outline
  REQUIRE(fill.size() == 2);            // and its sample
  CHECK(std::count(fill[0].data.begin(), fill[0].data.end(), 'Z') == 1);
}

TEST_CASE("write_cut_picture leaves openings blank and shows kept rock in a tint of its own") {
  const auto model = [](const std::string& rock) {
    return region(kBox) +
           "[[opening]]\nname = \"adit\"\nshape = \"circle\"\ncenter = [10, 5]\ndiameter = 4\nrock = \"" +
           rock + "\"\n";
  };
  const std::string removed = svg_of(model("removed")), kept = svg_of(model("kept"));
  REQUIRE(paths(removed, kSand).size() == 2);  // and its sample
  CHECK(paths(removed, kYellow).empty());
  CHECK(paths(kept, kYellow).size() == 2);  // and its sample
  const auto circle = paths(removed, kBlack);
  REQUIRE(circle.size() == 4);  // outline, opening, two samples
  CHECK(span(circle[1].x) == approx(span(circle[0].x) * 4 / 20).epsilon(0.01));
  const std::string fill = paths(removed, kSand)[0].data;
  CHECK(std::count(fill.begin(), fill.end(), 'Z') == 2);  // around and around the hole
  CHECK(paths(removed, "stroke-dasharray").size() == 2);  // the cut that opens the ring
}

TEST_CASE("write_cut_picture draws dead ends in grey") {
  const std::string through = joint_set("steep", 90, 5);
  const std::string dead = "[[fault]]\nname = \"F\"\npoints = [[7, 3], [7, 6]]\n";
  CHECK(paths(svg_of(region(kBox) + through), kGrey).empty());
  const auto grey = paths(svg_of(region(kBox) + through + dead), kGrey);
  REQUIRE(grey.size() == 2);  // and its sample
  CHECK(grey[0].x.size() == 2);
  CHECK(span(grey[0].y) == approx(1080 * 3.0 / 20).epsilon(1e-3));  // px per m as the width gives
  // not in an empty opening
  const std::string pit =
      "[[opening]]\nname = \"pit\"\nshape = \"polygon\"\npolygon = [[6, 2], [8, 2], [8, 8], [6, 8]]\n";
  const auto hidden = paths(svg_of(region(kBox) + through + pit + dead), kGrey);
  for (const Drawn& path : hidden) CHECK(path.x.size() == (path.data.empty() ? 0 : 2));
  CHECK(hidden.size() <= 1);  // the sample alone
}

TEST_CASE("write_cut_picture draws no edge that merging has taken away") {
  const std::string sliver = joint_set("steep", 90, 100, "origin = [0.01, 0]\n");
  CHECK(paths(svg_of(region(kBox) + "[cut]\nslivers = \"keep\"\n" + sliver), kBlue).size() == 2);
  // a strip of 0.1 m: of its four blocks two lie inside, 2.5 m high each
  const std::string lines = joint_set("flat", 0, 2.5) + joint_set("other", 90, 4) +
                            joint_set("strip", 90, 100, "origin = [4.1, 0]\n");
  const auto length = [](const std::vector<Drawn>& drawn) {  // of straight pieces, two points each
    double sum = 0;
    for (const Drawn& path : drawn)
      for (size_t k = 0; k + 1 < path.y.size(); k += 2) sum += std::abs(path.y[k + 1] - path.y[k]);
    return sum;
  };
  const std::string third = "stroke:rgb(0%,62", red = "stroke:rgb(86%";
  const std::string kept = svg_of(region(kBox) + lines);
  const std::string merged =
      svg_of(region(kBox) + "[cut]\nslivers = \"merge\"\nmerge_along = [\"strip\"]\n" + lines);
  CHECK(paths(kept, red).empty());
  CHECK(length(paths(merged, third)) < 0.51 * length(paths(kept, third)));
  CHECK(length(paths(merged, red)) == approx(length(paths(merged, third))));
}

TEST_CASE("write_cut_picture marks monitored points in sight") {
  const std::string plain = region(kBox) + joint_set("steep", 90, 5);
  const std::string none = svg_of(plain), one = svg_of(plain + monitor("M", 5, 5));
  const auto differ = [](const std::string& a, const std::string& b) { return a != b; };  // prints no SVG
  CHECK(paths(none, "fill:rgb(10%").empty());
  CHECK(paths(one, "fill:rgb(10%").size() == 2);  // the marker and its sample
  CHECK(differ(one, none));
  CHECK(differ(one, svg_of(plain + monitor("N", 5, 5))));
  CHECK(differ(one, svg_of(plain + monitor("M", 6, 5))));
  CHECK(!differ(none, svg_of(plain + monitor("M", 50, 5))));
}

TEST_CASE("write_cut_picture fits every shape onto the sheet") {
  const auto size = [](const std::string& svg, const std::string& name) {
    return std::stod(attribute(svg, " " + name));
  };
  const std::vector<std::string> boxes{
      "[[0, 0], [0.1, 0], [0.1, 0.005], [0, 0.005]]",                    // 20:1, small
      "[[0, 0], [500, 0], [500, 10000], [0, 10000]]",                    // 1:20, large
      "[[5000000, -300], [5000200, -300], [5000200, 0], [5000000, 0]]",  // far away
      "[[-3, -3], [3, -3], [3, 3], [-3, 3]]",                            // one block
      "[[0, 0], [1000, 0], [1000, 1], [0, 1]]",
      "[[0, 0], [1, 0], [1, 1000], [0, 1000]]"};
  for (const std::string& box : boxes) {
    CAPTURE(box);
    const std::string svg = svg_of(region(box));
    CHECK(size(svg, "width") >= 480);
    CHECK(size(svg, "width") <= 1100 + 500);
    CHECK(size(svg, "height") >= 100);
    CHECK(size(svg, "height") <= 1200 + 200);
    const auto outline = paths(svg, kBlack);
    REQUIRE(!outline.empty());
    CHECK(std::max(span(outline[0].x), span(outline[0].y)) >= 1000);
  }
}

TEST_CASE("write_cut_picture copes with odd models") {
  CHECK(paths(svg_of(kRock), kBlack).empty());  // nothing to cut: axes and title
  CHECK(!svg_of("title = \"" + std::string(5000, 'w') + "\"\n" + region(kBox)).empty());
  CHECK(!svg_of("title = \"Böschung 日本語 \\u0007\"\n" + region(kBox)).empty());

  std::string crowded = region(kBox);
  for (int i = 0; i < 500; ++i) {
    const std::string name = "π" + std::string(static_cast<std::size_t>(i % 90), 'x') + std::to_string(i);
    crowded += monitor(name, 3 + 0.001 * i, 4);
  }
  for (int i = 0; i < 90; ++i)
    crowded += "[[fault]]\nname = \"Störung " + std::string(static_cast<std::size_t>(i), 'y') +
               std::to_string(i) + "\"\npoints = [[" + std::to_string(0.1 + 0.2 * i) + ", 0], [10, 10]]\n";
  CHECK(!svg_of(crowded).empty());
}

TEST_CASE("write_cut_picture throws when a file cannot be written") {
  const Folder folder;
  const fs::path stem = folder / "missing" / "cut";
  CHECK_THROWS_WITH_AS(plot::write_cut_picture({}, {}, {}, stem), doctest::Contains("missing/cut.svg"),
                       std::runtime_error);
  CHECK(fs::is_empty(folder.path()));
}

}  // namespace test_cut_picture
