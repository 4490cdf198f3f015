#pragma once
// What the program says to a model file.

#include <doctest/doctest.h>

#include <string>

#include "talus/talus.h"

namespace talus::test {

/// `text` with one piece of it, which must be there, replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  INFO("to be replaced: ", from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// All that reading, cutting and checking `text` as model.toml has to say: errors, or else warnings.
inline std::string told(const std::string& text) {
  Findings findings("model.toml", text);
  try {
    prepare_run("model.toml", text, {}, findings);
  } catch (const Error& e) {
    return e.what();
  }
  return findings.render();
}

}  // namespace talus::test
