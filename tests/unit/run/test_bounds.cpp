// Bounds that are judged before memory is taken, just within and just beyond.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>
#include <vector>

#include "talus/base/error.h"
#include "talus/base/text_file.h"
#include "talus/run/run.h"

namespace test_bounds {

using namespace talus;

namespace {

// What the model of an example with these overrides is refused for; "" where it is not.
std::string refusal(const std::string& example, const std::vector<std::string>& overrides) {
  const std::string file = fmt::format("{0}/examples/{1}/{1}.toml", TALUS_SOURCE_DIR, example),
                    text = read_text_file(file);
  Findings findings(file, text);
  try {
    prepare_run(file, text, overrides, findings);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("bounds: a shape wants coordinates of a millionth of it") {
  // the bar has cells of 0.05 m: rounded to 1e-6 of them at 2.25e8 m
  const auto at = [](double x) { return refusal("impact_bar", {fmt::format("grid.bar.move=[{}, 0]", x)}); };
  CHECK(!holds(at(1.6e8), "no digits left"));
  CHECK(holds(at(3.2e8), "no digits left"));
}

TEST_CASE("bounds: a grouted bolt has ten thousand segments at most") {
  // bars of 3 m
  const auto of = [](double length) {
    return refusal("bolted_slope", {fmt::format("bolt_type.bar.segment_length={}", length)});
  };
  CHECK(of(3.0 / 7000) == "");
  CHECK(holds(of(3.0 / 14000), "more than 10000 segments"));
}

TEST_CASE("bounds: a step has a hundred thousand rows at most") {
  // steps of 1 ms
  const auto of = [](double interval) {
    return refusal("pile", {fmt::format("output.history_interval={}", interval)});
  };
  CHECK(of(1e-3 / 7e4) == "");
  CHECK(holds(of(1e-3 / 14e4), "more than 100000 rows of a step"));
}

TEST_CASE("bounds: a grid of two cells across a model is the coarsest") {
  // 30 m across; cells are rounded down to a power of two
  const auto of = [](double grid) { return refusal("staged_tunnel", {fmt::format("cut.grid={}", grid)}); };
  CHECK(!holds(of(1), "coarser than a model"));
  CHECK(holds(of(1e3), "coarser than a model"));
}

}  // namespace test_bounds
