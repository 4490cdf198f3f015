// Units, defaults, histories, and that the published tables are those of the program.

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/relative.h"
#include "talus/base/text_file.h"
#include "talus/model/model_schema.h"
#include "talus/model/read_model.h"

namespace test_model_file {

using namespace talus;

TEST_CASE("units: numbers with units become SI") {
  const auto value = [](const char* text, Dimension d) {
    const Quantity q = parse_quantity(text, d);
    CHECK(q.error == "");
    return q.value;
  };
  CHECK(value("5 GPa", Dimension::kStress) == 5e9);
  CHECK(value("5GPa", Dimension::kStress) == 5e9);
  CHECK(value(" 0.4 g ", Dimension::kAcceleration) == test::approx(0.4 * 9.80665));
  CHECK(value("180 deg", Dimension::kAngle) == test::approx(M_PI).epsilon(1e-15));
  CHECK(value("-3e2 mm", Dimension::kLength) == test::approx(-0.3));
  CHECK(value("2.7 t/m3", Dimension::kDensity) == test::approx(2700));
  CHECK(value("26 kN/m3", Dimension::kDensity) == test::approx(26e3 / 9.80665).epsilon(1e-15));
  CHECK(value("40 kPa/m", Dimension::kStiffness) == 4e4);
  CHECK(value("10 ft", Dimension::kLength) == test::approx(3.048).epsilon(1e-15));
  CHECK(value("1000 psi", Dimension::kStress) == test::approx(6.894757293168361e6).epsilon(1e-15));
  CHECK(value("7", Dimension::kTime) == 7);
  CHECK(value("0", Dimension::kAngle) == 0);
  CHECK(parse_quantity("1.5", Dimension::kAngle).error != "");
  CHECK(parse_quantity("", Dimension::kLength).error != "");
  CHECK(parse_quantity("3,0 m", Dimension::kLength).error.find("write \"3.0 m\"") != std::string::npos);
  CHECK(parse_quantity("1,5", Dimension::kLength).error.find("write \"1.5\"") != std::string::npos);
  CHECK(parse_quantity("3, m", Dimension::kLength).error.find("unknown unit") != std::string::npos);
}

TEST_CASE("histories: linear between points, held outside, integral exact") {
  History h;
  h.time = {0, 1, 3};
  h.value = {0, 2, -2};
  h.integral = {0, 1, 1};
  CHECK(h.value_at(-1) == 0);
  CHECK(h.value_at(0.25) == 0.5);
  CHECK(h.value_at(2) == 0);
  CHECK(h.value_at(5) == -2);
  CHECK(h.integral_at(0) == 0);
  CHECK(h.integral_at(0.5) == test::approx(0.25));
  CHECK(h.integral_at(2) == test::approx(2));
  CHECK(h.integral_at(4) == test::approx(1 - 2));  // held at -2 after t = 3

  // a table that begins later: held before, and the integral still counts from t = 0
  History late;
  late.time = {2, 4};
  late.value = {3, 3};
  late.integral = {0, 6};
  CHECK(late.integral_at(0) == 0);
  CHECK(late.integral_at(5) == test::approx(15));
}

TEST_CASE("defaults are those the schema publishes") {
  Findings findings("m", "");
  const Model m =
      read_model("m", "talus = 1\n[[stage]]\nname='s'\nkind='static'\nduration=1\n", {}, findings);
  CHECK(findings.list().empty());
  CHECK(m.thickness == 1);
  CHECK(m.plane == Plane::kStrain);
  CHECK(m.gravity == Vec2{0, 0});
  CHECK(m.solver.tolerance == 1e-8);
  CHECK(m.solver.limit == 1e-5);
  CHECK(m.stages[0].damping_local == 0.8);
  CHECK(std::isnan(m.stages[0].time_step));
  CHECK(m.stages[0].safety == 0.8);
}

TEST_CASE("docs/file_format.md holds the tables of the program") {
  const std::string page = read_text_file(std::string(TALUS_SOURCE_DIR) + "/docs/file_format.md");
  CHECK(page.find(model_markdown()) != std::string::npos);  // else: talus schema, and paste
}

TEST_CASE("docs/talus.schema.json is the program's schema, and is JSON") {
  const std::string text = model_json();
  CHECK(read_text_file(std::string(TALUS_SOURCE_DIR) + "/docs/talus.schema.json") == text);
  const auto json = nlohmann::json::parse(text);
  CHECK(json["properties"]["material"]["additionalProperties"]["properties"]["density"]["exclusiveMinimum"] ==
        0);
  for (const SectionSpec& s : model_schema())
    if (s.shape != SectionShape::kTop) CHECK(json["properties"].contains(std::string(s.name)));
}

TEST_CASE("every key of the schema is used by an example or a test model of the documentation") {
  // keys that no shipped model shows would rot unseen
  std::string all;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::string(TALUS_SOURCE_DIR) + "/examples"))
    if (entry.path().extension() == ".toml" || entry.path().extension() == ".md")
      all += read_text_file(entry.path());
  for (const SectionSpec& s : model_schema()) {
    for (const KeySpec& k : s.keys) {
      INFO(s.name, ".", k.name);
      const std::string key(k.name);
      CHECK((all.find("\n" + key + " =") != std::string::npos || all.rfind(key + " =", 0) == 0 ||
             all.find("{ " + key + " =") != std::string::npos ||
             all.find("--set '" + std::string(s.name) + "." + key + "=") != std::string::npos));
    }
  }
}

}  // namespace test_model_file
