#pragma once
// Layouts of models in memory that must be right.

#include <doctest/doctest.h>

#include <string>

#include "talus/cut/check_places.h"

namespace talus::test {

/// A [[block]] of the first material.
/// @param polygon  corners [m], in either direction
inline BlockInput block_input(const std::string& name, const Polygon& polygon) {
  BlockInput b;
  b.name = name;
  b.polygon = polygon;
  b.material = 0;
  return b;
}

/// The layout of a model in which nothing is wrong: a finding that is an error ends the test.
inline Layout layout_of(const Model& model) {
  Findings findings("case.toml", "");
  const Layout layout = checked_layout(model, findings);
  INFO(findings.render());
  REQUIRE_FALSE(findings.has_errors());
  return layout;
}

}  // namespace talus::test
