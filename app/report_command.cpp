#include "report_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "data_files.h"
#include "study_command.h"
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
  verb.add_option(
          "DIR", args.folders,
          "result folders; the charts of several are overlaid. One of a study: reports of its runs, and its page; of a search for safety: its page")
      ->required();
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
  verb.add_flag("--force", args.force, "replace a file that is no report");
  verb.add_option("--live", args.live, "write live.html, loaded anew after so many seconds")
      ->check(CLI::Range(0.0, 86400.0))
      ->group("");
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
  const fs::path file = args.live >= 0        ? fs::path(args.folders[0]) / "live.html"
                        : args.output.empty() ? fs::path(args.folders[0]) / "report.html"
                                              : fs::path(args.output);
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
  note_result(args.folders[0], file);
  write_file(file, html);
  fmt::print("{}: {}\n", file.string(), readable_bytes(static_cast<double>(html.size())));
  return kExitOk;
}

// A file of somebody else's is not written over.
void check_replaced(const ReportArguments& args) {
  constexpr size_t kHead = 4096;
  if (args.output.empty() || args.output == "-") return;
  check_no_result(args.output);
  std::error_code ec;
  if (args.force || !fs::is_regular_file(args.output, ec) || fs::file_size(args.output, ec) == 0) return;
  std::ifstream in(args.output, std::ios::binary);
  std::string head(kHead, '\0');
  in.read(head.data(), static_cast<std::streamsize>(kHead));
  if (head.find("<meta name=\"generator\" content=\"talus\">") == std::string::npos)
    throw FileError(fmt::format("{}: is there, and is no report of talus; --force replaces it", args.output));
}

// The page of runs beside each other.
std::string page_of_runs(const ReportArguments& args, const std::vector<std::string>& folders, bool quiet) {
  const std::string page = page_text();
  std::vector<report::RunFolder> runs;
  for (const std::string& folder : folders) {
    runs.push_back(report::read_run_folder(folder));
    for (const std::string& note : runs.back().notes) tell("talus: note: {}: {}\n", folder, note);
  }
  report::PageNotes notes;
  std::string html = report::report_page(
      page, runs, {.frames = args.frames, .megabytes = args.megabytes, .reload = std::max(0.0, args.live)},
      notes);
  for (const auto& run : notes.runs)
    if (!quiet)
      fmt::print("{}: {} of {} frames{}, contact points of {} frames\n", run.name, run.frames,
                 run.frames_there, run.reason.empty() ? "" : " (" + run.reason + ")", run.contact_frames);
  return html;
}

}  // namespace

int report_command(const ReportArguments& args) {
  check_replaced(args);
  const std::string& first = args.folders[0];
  const bool of_study = is_study_folder(first), of_safety = report::is_safety_folder(first);
  if ((of_study || of_safety) && args.folders.size() > 1)
    throw FileError(fmt::format("{}: is a folder of talus {}, whose page stands alone; name it alone", first,
                                of_study ? "study" : "safety"));
  if (of_safety) return written(args, report::safety_page(first));
  if (of_study) {
    if (!args.output.empty())
      throw Error(kExitUsage,
                  "the page of a study is its study.html, beside the runs that it opens: leave out -o");
    return report_of_study(first, [&args](const std::string& run) {
      note_result(run, fs::path(run) / "report.html");
      write_file(fs::path(run) / "report.html", page_of_runs(args, {run}, true));
    });
  }
  return written(args, page_of_runs(args, args.folders, args.output == "-"));
}

}  // namespace talus::app
