#include "report_command.h"

#include <fmt/format.h>

#include <filesystem>

#include "data_files.h"
#include "talus/base/error.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"
#include "talus/output/result_folder.h"
#include "talus/report/page.h"
#include "talus/report/safety_page.h"
#include "tell.h"

namespace talus::app {

namespace fs = std::filesystem;

std::string page_text() {
  const fs::path place = data_file("report_page.html");
  std::error_code ec;
  if (!fs::exists(place, ec))
    throw FileError(fmt::format(
        "{}: the page of the report was not built, for want of npm: install npm (with Node.js 18 or "
        "newer) and build again (./run.sh does both)",
        place.string()));
  return read_text_file(place);
}

void add_report_arguments(CLI::App& verb, ReportArguments& args) {
  verb.add_option("DIR", args.folders, "result folders; the charts of several are overlaid")->required();
  verb.add_option("-o,--output", args.output,
                  "file to write, - for standard output; without: report.html in the first folder");
  verb.add_option("--frames", args.frames,
                  "at most so many frames of each run, spread evenly; 0: as many as fit")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  verb.add_option("--megabytes", args.megabytes,
                  "largest size of the page; 0: 2 kB a block, within 29 and 95 MB")
      ->check(CLI::Range(0.0, 2000.0))
      ->capture_default_str();
  verb.footer(
      "Example: talus report out/impact_bar/run      (then open out/impact_bar/run/report.html in a "
      "browser)");
}

namespace {

// Puts a page where it is wanted, and says where.
int written(const ReportArguments& args, const std::string& html) {
  if (args.output == "-") {
    fmt::print("{}", html);
    return kExitOk;
  }
  const fs::path file =
      args.output.empty() ? fs::path(args.folders[0]) / "report.html" : fs::path(args.output);
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
  note_result(args.folders[0], file);
  write_file(file, html);
  fmt::print("{}: {}\n", file.string(), readable_bytes(static_cast<double>(html.size())));
  return kExitOk;
}

}  // namespace

int report_command(const ReportArguments& args) {
  if (!args.output.empty() && args.output != "-") check_no_result(args.output);
  if (report::is_safety_folder(args.folders[0])) {
    if (args.folders.size() > 1)
      throw FileError(fmt::format("{}: is a folder of talus safety, whose page stands alone; name it alone",
                                  args.folders[0]));
    return written(args, report::safety_page(args.folders[0]));
  }
  const std::string page = page_text();
  std::vector<report::RunFolder> runs;
  for (const std::string& folder : args.folders) {
    runs.push_back(report::read_run_folder(folder));
    for (const std::string& note : runs.back().notes) tell("talus: note: {}: {}\n", folder, note);
  }
  report::PageNotes notes;
  const std::string html =
      report::report_page(page, runs, {.frames = args.frames, .megabytes = args.megabytes}, notes);
  if (args.output != "-")
    for (const auto& run : notes.runs)
      fmt::print("{}: {} of {} frames{}, contact points of {} frames\n", run.name, run.frames,
                 run.frames_there, run.reason.empty() ? "" : " (" + run.reason + ")", run.contact_frames);
  return written(args, html);
}

}  // namespace talus::app
