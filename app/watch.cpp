#include "watch.h"

#include <algorithm>

#include "talus/base/clock.h"
#include "talus/output/files.h"
#include "talus/output/result_folder.h"
#include "talus/report/page.h"
#include "tell.h"

namespace talus::app {

namespace {

constexpr double kEvery = 3;       // [s]
constexpr double kShare = 0.05;    // of the time of the run
constexpr double kMegabytes = 20;  // of the page
constexpr int kStepsBetween = 16;  // the clock is not asked at every step

}  // namespace

LivePage::LivePage(Observer& next, std::filesystem::path folder, std::string page)
    : next_(next), folder_(std::move(folder)), page_(std::move(page)), next_at_(wall_now() + kEvery) {}

void LivePage::at(const Instant& instant) {
  next_.at(instant);
  if (++steps_ % kStepsBetween != 0 || wall_now() < next_at_) return;
  write(kEvery);
}

void LivePage::write(double reload) {
  const double begin = wall_now();
  try {
    const report::RunFolder run = report::read_run_folder(folder_);
    report::PageNotes notes;
    const std::string html =
        report::report_page(page_, {run}, {.frames = 0, .megabytes = kMegabytes, .reload = reload}, notes);
    if (!noted_) note_result(folder_, file());
    noted_ = true;
    write_file(file(), html);
  } catch (const std::exception& e) {  // the run goes on without
    if (!told_) tell("talus: note: live.html is not written: {}\n", e.what());
    told_ = true;
  }
  const double took = wall_now() - begin;
  next_at_ = begin + took + std::max(kEvery, took * (1 / kShare - 1));
}

}  // namespace talus::app
