#include "tell.h"

#include <cstdio>

#include "talus/base/name.h"

namespace talus::app {

namespace {

constexpr std::string_view kKept = "\n\t";

}  // namespace

void tell(const std::string& text) {
  const std::string shown = shown_name(text, kKept);
  (void)std::fwrite(shown.data(), 1, shown.size(), stderr);
}

void show(const std::string& text) {
  const std::string shown = shown_name(text, kKept);
  (void)std::fwrite(shown.data(), 1, shown.size(), stdout);
}

}  // namespace talus::app
