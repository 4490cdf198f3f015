#pragma once
// The talus command as a user meets it: shell lines run in a folder of their own, with exit code and output.
// The build defines TALUS_COMMAND, the path of the program.

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/folder.h"
#include "talus/base/text_file.h"

namespace talus::test {

struct Outcome {
  int code;          // exit code, 128 + number of the signal that ended it
  std::string text;  // both streams
};

/// Runs a shell line inside the folder; $talus is the program, or that of TALUS_PROGRAM. The output is kept there as log.txt.
inline Outcome shell(const Folder& folder, const std::string& line) {
  const std::filesystem::path log = folder / "log.txt";
  // not "cd && line": where the line sends a program to the background with "&", that would take the "cd"
  // along, and in some shells $! would name the shell around both
  const char* another = std::getenv("TALUS_PROGRAM");
  const int status =
      std::system(fmt::format("talus='{}'; ( cd '{}' || exit 126; {} ) > '{}' 2>&1",
                              another ? another : TALUS_COMMAND, (folder / "").string(), line, log.string())
                      .c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text_file(log)};
}

/// Checks that `text` holds `part`, and says both when it does not.
inline void has(const std::string& text, const std::string& part) {
  INFO("text:\n", text, "\nshould hold: ", part);
  CHECK(text.find(part) != std::string::npos);
}

/// Whether there is a page of the report, for which npm has to be installed; says so where there is none.
inline bool page_was_built() {
  if (std::filesystem::exists(std::filesystem::path(TALUS_COMMAND).parent_path() /
                              "../share/talus/report_page.html"))
    return true;
  MESSAGE("skipped: the page was not built, npm is not installed");
  return false;
}

}  // namespace talus::test
