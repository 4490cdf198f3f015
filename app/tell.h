#pragma once
// What verbs say, whatever has become of the standard streams.

#include <fmt/format.h>

#include <string>

namespace talus::app {

/// To standard error. A stream that cannot be written keeps nothing from going on.
void tell(const std::string& text);

/// To standard output, texts from outside among it: control characters are shown, and not sent to a terminal.
/// Whether it has arrived is asked at the end.
void show(const std::string& text);

template <class... Args>
void tell(fmt::format_string<Args...> format, Args&&... args) {
  tell(fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void show(fmt::format_string<Args...> format, Args&&... args) {
  show(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace talus::app
