#pragma once
// `talus report`: one HTML page from one or more result folders.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace talus::app {

struct ReportArguments {
  std::vector<std::string> folders;
  std::string output;
  int frames = 0;
  double megabytes = 0;
  double live = -1;  // of talus run --watch: live.html, loaded anew after so many seconds (0: never again)
  bool force = false;
};

void add_report_arguments(CLI::App& verb, ReportArguments& args);
/// The page that reports are made of. Throws FileError where it was not built.
std::string page_text();
int report_command(const ReportArguments& args);

}  // namespace talus::app
