// Columns say themselves what they are called, how rows that are not written count, and what their value is.

#include "talus/output/columns.h"

#include <doctest/doctest.h>

#include "talus/output/contact_points.h"
#include "talus/output/text_table.h"

namespace test_columns {

using namespace talus;

TEST_CASE("columns: a title and its parts") {
  for (const char* title :
       {"t [s]", "iterations", "top.displacement_x [m]", "c.ruptured", "a.b.c [N/m2]", "k [kN/m.s]"}) {
    INFO(title);
    CHECK(parts_of_title(title).text() == title);
  }
  const ColumnTitle t = parts_of_title("top.displacement_x [m]");
  CHECK(t.monitor == "top");
  CHECK(t.quantity == "displacement_x");
  CHECK(t.unit == "m");
  CHECK(parts_of_title("k [kN/m.s]").monitor.empty());
}

TEST_CASE("columns: rows that are not written count as their columns say") {
  struct Row {
    double a, b, c;
  };
  const Columns<Row> columns{{"a", "m", [](const Row& r) { return r.a; }},
                             {"b", "m", [](const Row& r) { return r.b; }, Over::kWorst},
                             {"c", "", [](const Row& r) { return r.c; }, Over::kSum}};
  CHECK(csv_head(columns) == "a [m],b [m],c\n");
  std::vector<double> row = values_of(columns, Row{1, 2, 3});
  take_in(columns, {9, 9, 9}, row);
  CHECK(row == std::vector<double>{1, 9, 12});
  take_in(columns, {0, 1, 0}, row);
  CHECK(row == std::vector<double>{1, 9, 12});
}

TEST_CASE("columns: cells with commas, quotes and no text come back") {
  struct Row {};
  const Columns<Row, Cell> columns{{"first", "", [](const Row&) { return ""; }},
                                   {"second", "", [](const Row&) { return "wall[0,1] \"a\""; }},
                                   {"third", "m", [](const Row&) { return 0.1; }, Over::kLast, 9},
                                   {"fourth", "", [](const Row&) { return int64_t{1} << 60; }}};
  const TextTable table = parse_text_table("t", csv_head(columns) + csv_row(columns, Row{}));
  CHECK(table.columns == std::vector<std::string>{"first", "second", "third [m]", "fourth"});
  REQUIRE(table.rows.size() == 1);
  CHECK(table.rows[0] == std::vector<std::string>{"", "wall[0,1] \"a\"", "0.1", "1152921504606846976"});
}

TEST_CASE("columns: those of contact points have a name, an array and a place of their own") {
  std::vector<std::string> names, arrays;
  for (const ContactColumn& c : contact_columns()) {
    CHECK(std::find(names.begin(), names.end(), c.name) == names.end());
    names.push_back(c.name), arrays.push_back(c.array());
    CHECK((!c.shown || c.page == InPage::kHalf));
    CHECK(std::isfinite(c.of(FramePoint())));
  }
  CHECK(std::find(arrays.begin(), arrays.end(), "normal force [N]") != arrays.end());
  CHECK(std::find(arrays.begin(), arrays.end(), "block a") != arrays.end());
}

}  // namespace test_columns
