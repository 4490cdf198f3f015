#pragma once
// A model text with maps turned into one without.

#include <string>
#include <vector>

#include "talus/maps/sections.h"

namespace talus::maps {

struct ExpandedModel {
  bool has_maps = false;
  std::string text;                    // without [[map]]; the text as it was when it has none
  std::vector<std::string> overrides;  // those left to apply to it
  std::filesystem::path folder;        // that its relative paths count from
  MapReport report;
};

/// Replaces every [[map]] of the model text by the sections that come of it. Overrides of maps
/// (`map.NAME.key`, `maps.key`) are used here. Everything wrong goes to `findings`, which belong to the text
/// as it was.
/// @param file  path of the model; files of maps count from its folder
ExpandedModel expand_model(const std::string& file, const std::string& text,
                           const std::vector<std::string>& overrides, const DrawingReader& reader,
                           Findings& findings);

}  // namespace talus::maps
