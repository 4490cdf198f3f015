#pragma once
// The report: one HTML page, complete in itself, made from result folders alone. The page itself (its program
// and style) is built from web/; here it gets its data.

#include <string>
#include <vector>

#include "talus/report/run_folder.h"

namespace talus::report {

struct PageOptions {
  int frames = 0;        // at most so many of each run, 0: as many as fit
  double megabytes = 0;  // of the page, 0: 2 kB a block, within 29 and 95 MB
  double reload = 0;     // the page loads itself anew after so long, 0: never [s]
};

struct PageNotes {
  struct Run {
    std::string name;
    size_t frames = 0, frames_there = 0;  // of blocks
    size_t contact_frames = 0;
    std::string reason;  // why not all frames, "": all
  };
  std::vector<Run> runs;
};

/// The page with the data of the runs; the first run is shown first.
/// @param page  report_page.html, with the line "<!-- talus: data -->" where data go
/// Throws FileError when a file of the results cannot be read or the page has no place for data.
std::string report_page(const std::string& page, const std::vector<RunFolder>& runs,
                        const PageOptions& options, PageNotes& notes);

}  // namespace talus::report
