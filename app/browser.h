#pragma once
// The user's browser.

#include <filesystem>

namespace talus::app {

/// Opens a page in the browser that the desktop starts for it (xdg-open), and goes on at once. False where there is
/// no screen or no such program.
bool open_in_browser(const std::filesystem::path& page);

/// Opens the page of a section, or says that it is to be opened by hand.
void show_section_page(const std::filesystem::path& page);

}  // namespace talus::app
