#include <doctest/doctest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/folder.h"
#include "talus/plot/figure.h"
#include "talus/plot/scale.h"

namespace test_figure {

namespace {

namespace fs = std::filesystem;
using namespace talus::plot;
using namespace talus::test;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A folder of its own that disappears with the test.

// Width and height of a PNG [pixels], four bytes each behind the signature and the head of the first chunk.
unsigned png_number(const std::string& png, std::size_t offset) {
  unsigned value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value * 256 + static_cast<unsigned char>(png.at(offset + i));
  return value;
}

Figure sine_figure() {
  Figure figure;
  figure.title = "Sine";
  figure.x_label = "t [s]";
  figure.y_label = "u [m]";
  Curve curve{"sine", {}, {}};
  for (int i = 0; i <= 100; ++i) {
    curve.x.push_back(0.1 * i);
    curve.y.push_back(std::sin(0.1 * i));
  }
  figure.curves.push_back(curve);
  return figure;
}

// How often `part` occurs in `text`.
int occurrences(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("write_figure writes an SVG and a PNG of twice the size and leaves nothing else") {
  const Folder folder;
  write_figure(sine_figure(), folder / "run.1");  // a dot in the name is not an extension

  const std::string svg = content(folder / "run.1.svg");
  CHECK(svg.find("<svg") != std::string::npos);
  CHECK(svg.find("width=\"760px\" height=\"460px\"") != std::string::npos);
  CHECK(svg.find("</svg>") != std::string::npos);

  const std::string png = content(folder / "run.1.png");
  REQUIRE(png.size() > 24);
  CHECK(png.substr(1, 3) == "PNG");
  CHECK(png_number(png, 16) == 1520);
  CHECK(png_number(png, 20) == 920);

  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 2);
}

TEST_CASE("write_figure replaces older files") {
  const Folder folder;
  std::ofstream(folder / "a.svg") << "old";
  write_figure(sine_figure(), folder / "a");
  CHECK(content(folder / "a.svg").find("<svg") != std::string::npos);
}

TEST_CASE("a figure that cannot be written is reported with file and cause") {
  const Folder folder;
  const auto message = [](const fs::path& stem) -> std::string {
    try {
      write_figure(sine_figure(), stem);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  SUBCASE("the folder does not exist") {
    const std::string text = message(folder / "missing" / "force");
    CHECK(text.find((folder / "missing" / "force.svg").string()) != std::string::npos);
    CHECK(text.find("No such file or directory") != std::string::npos);
  }
  SUBCASE("the name is taken by a folder; the temporary file is removed") {
    fs::create_directories(folder / "force.png" / "x");
    CHECK(message(folder / "force").find((folder / "force.png").string()) != std::string::npos);
    CHECK_FALSE(fs::exists(folder / "force.png.part"));
  }
}

TEST_CASE("curves without a usable range are drawn") {
  const Folder folder;
  Figure figure;
  figure.title = "not UTF-8: \xff";
  SUBCASE("no curves") {}
  SUBCASE("an empty curve") { figure.curves = {{"empty", {}, {}}}; }
  SUBCASE("one point") { figure.curves = {{"point", {1}, {2}}}; }
  SUBCASE("constant") { figure.curves = {{"constant", {0, 1, 2}, {7000, 7000, 7000}}}; }
  SUBCASE("constant zero") { figure.curves = {{"zero", {0, 1, 2}, {0, 0, 0}}}; }
  SUBCASE("nothing finite") { figure.curves = {{"none", {0, kNan, 2}, {kNan, 1, kInfinity}}}; }
  SUBCASE("the largest numbers") { figure.curves = {{"large", {-1e308, 0, 1e308}, {-1e308, 1e299, 1e308}}}; }
  SUBCASE("the smallest numbers") { figure.curves = {{"small", {0, 5e-324}, {0, 1e-310}}}; }
  SUBCASE("limits that make no sense") {
    figure.curves = {{"line", {0, 1}, {0, 1}}};
    figure.x_min = kNan;
    figure.y_min = figure.y_max = 5;
    figure.width = -1;
  }
  CHECK_NOTHROW(write_figure(figure, folder / "odd"));
  CHECK(fs::exists(folder / "odd.png"));
}

TEST_CASE("coordinates of different number are refused with the name of the curve") {
  const Folder folder;
  Figure figure;
  figure.curves = {{"gap 3", {0, 1, 2}, {0, 1}}};
  CHECK_THROWS_WITH_AS(write_figure(figure, folder / "a"), "curve 'gap 3': 3 values of x but 2 of y",
                       std::invalid_argument);
}

TEST_CASE("a curve hidden from the legend has no line sample there") {
  const Folder folder;
  const std::string color = "stroke:rgb(0%,44.7%,69.8%)";  // palette index 0, used for nothing else
  Figure figure = sine_figure();
  write_figure(figure, folder / "with");
  figure.curves[0].in_legend = false;
  write_figure(figure, folder / "without");
  const int with = occurrences(content(folder / "with.svg"), color);
  const int without = occurrences(content(folder / "without.svg"), color);
  CHECK(with == 2);
  CHECK(without == 1);
}

TEST_CASE("fourteen long legend entries leave half of the plot area") {
  const Folder folder;
  Figure figure = sine_figure();
  figure.curves[0].label = std::string(60, 'm');
  figure.curves.resize(14, figure.curves[0]);
  write_figure(figure, folder / "a");
  CHECK(png_number(content(folder / "a.png"), 20) > 920);  // grown
}

TEST_CASE("widened gives every range a length to compute with") {
  CHECK(widened({2, 3}).lo == 2);
  CHECK(widened({2, 3}).hi == 3);
  CHECK(widened({3, 2}).lo == 2);
  for (const Range r : {Range{7, 7}, Range{-7, -7}, Range{0, 0}, Range{0, 5e-324}, Range{1, 1 + 1e-15}}) {
    CAPTURE(r.lo);
    CHECK(widened(r).lo < r.lo);
    CHECK(widened(r).hi > r.hi);
    CHECK(nice_ticks(widened(r).lo, widened(r).hi, 5).values.size() >= 3);
  }
}

TEST_CASE("is_drawable refuses what is not finite or too large for differences") {
  CHECK(is_drawable(0));
  CHECK(is_drawable(-1e300));
  CHECK_FALSE(is_drawable(1.1e300));
  CHECK_FALSE(is_drawable(-kInfinity));
  CHECK_FALSE(is_drawable(kNan));
}

TEST_CASE("nice_ticks steps by 1, 2 or 5 times a power of ten") {
  CHECK(nice_ticks(0, 32, 7).values == std::vector<double>{0, 5, 10, 15, 20, 25, 30});
  CHECK(nice_ticks(-180, 7050, 8).values == std::vector<double>{0, 1000, 2000, 3000, 4000, 5000, 6000, 7000});
  CHECK(nice_ticks(-1, 1, 4).values == std::vector<double>{-1, -0.5, 0, 0.5, 1});
  CHECK(nice_ticks(0.05, 0.95, 5).values == std::vector<double>{0.2, 0.4, 0.6, 0.8});
  CHECK(nice_ticks(0, 3e-7, 3).values == std::vector<double>{0, 1e-7, 2e-7, 3e-7});
  CHECK(nice_ticks(0, 9.99999999, 5).values.back() == 10);  // an end missed by rounding only
  CHECK_FALSE(std::signbit(nice_ticks(-0.3, 5, 5).values.front()));
  CHECK(nice_ticks(1, 1, 5).values.empty());
  CHECK(nice_ticks(kNan, 1, 5).values.empty());
}

TEST_CASE("tick_labels writes the ticks of an axis in one format") {
  const auto labels = [](double lo, double hi, int target) {
    return tick_labels(nice_ticks(lo, hi, target));
  };
  using Texts = std::vector<std::string>;
  CHECK(labels(0, 3000, 3) == Texts{"0", "1000", "2000", "3000"});
  CHECK(labels(-1, 1, 4) == Texts{"\u22121.0", "\u22120.5", "0.0", "0.5", "1.0"});
  CHECK(labels(0, 20000, 2) == Texts{"0", "10\u2009000", "20\u2009000"});
  CHECK(labels(0, 0.002, 2) == Texts{"0.000", "0.001", "0.002"});
  CHECK(labels(-1e-7, 1e-7, 4) == Texts{"\u22121.0\u00d710\u207b\u2077", "\u22120.5\u00d710\u207b\u2077", "0",
                                        "0.5\u00d710\u207b\u2077", "1.0\u00d710\u207b\u2077"});
  CHECK(labels(0, 2e6, 2) == Texts{"0", "1\u00d710\u2076", "2\u00d710\u2076"});
}

TEST_CASE("reduce_by_column keeps every spike of a long curve") {
  constexpr int kPoints = 100000, kColumns = 700;
  std::vector<double> x(kPoints), y(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    x[static_cast<std::size_t>(i)] = i;
    y[static_cast<std::size_t>(i)] = std::sin(0.1 * i);
  }
  y[12345] = 50;
  y[12350] = -60;  // in the same column
  y[99999] = 70;
  const auto pieces = reduce_by_column(x, y, 0, kPoints, kColumns);
  REQUIRE(pieces.size() == 1);
  CHECK(pieces[0].size() <= 4 * kColumns);
  for (const double spike : {50.0, -60.0, 70.0}) {
    CHECK(std::any_of(pieces[0].begin(), pieces[0].end(), [&](Point p) { return p.y == spike; }));
  }
  CHECK(pieces[0].front().x == 0);
  CHECK(pieces[0].back().x == kPoints - 1);
  CHECK(std::is_sorted(pieces[0].begin(), pieces[0].end(), [](Point a, Point b) { return a.x < b.x; }));
}

TEST_CASE("reduce_by_column splits at gaps and keeps short curves as they are") {
  const auto pieces = reduce_by_column({0, 1, 2, 3, 4, 5}, {0, 1, kNan, 3, kInfinity, 5}, 0, 5, 100);
  REQUIRE(pieces.size() == 3);
  REQUIRE(pieces[0].size() == 2);
  CHECK(pieces[0][1].y == 1);
  REQUIRE(pieces[1].size() == 1);
  CHECK(pieces[1][0].y == 3);
  CHECK(pieces[2].size() == 1);
  CHECK_THROWS_AS(reduce_by_column({0, 1}, {0}, 0, 1, 10), std::invalid_argument);
}

TEST_CASE("reduce_by_column keeps the way of a curve that runs back") {
  const auto pieces = reduce_by_column({0, 1, 2, 1, 0}, {0, 1, 2, 3, 4}, 0, 2, 2);
  REQUIRE(pieces.size() == 1);
  std::vector<double> y;
  for (const Point p : pieces[0]) y.push_back(p.y);
  CHECK(y == std::vector<double>{0, 1, 2, 3, 4});
  CHECK(reduce_by_column({0, 1, 2}, {0, 1, 2}, 1, 1, 10).size() == 1);  // no columns: still ends
}

}  // namespace test_figure
