#include "browser.h"

#include <cstdlib>

#include "talus/base/error.h"
#include "talus/base/spawn.h"
#include "tell.h"

namespace talus::app {

bool open_in_browser(const std::filesystem::path& page) {
  const auto is_set = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY")) return false;
  try {
    spawn({"xdg-open", std::filesystem::absolute(page).string()}, "/dev/null");
  } catch (const FileError&) {
    return false;
  }
  return true;
}

void show_section_page(const std::filesystem::path& page) {
  if (open_in_browser(page))
    show("opened in a browser: {}\n", page.string());
  else
    show("to look into the section, open in a browser: {}\n", page.string());
}

}  // namespace talus::app
