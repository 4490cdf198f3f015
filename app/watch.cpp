#include "watch.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>

#include "talus/base/clock.h"
#include "talus/base/spawn.h"
#include "talus/output/files.h"
#include "tell.h"

namespace talus::app {

namespace {

constexpr double kEvery = 3;       // [s]
constexpr double kShare = 0.05;    // of the time of the run
constexpr double kMegabytes = 20;  // of the page
constexpr int kStepsBetween = 16;  // the clock is not asked at every step

}  // namespace

LivePage::LivePage(Observer& next, std::filesystem::path folder)
    : next_(next), folder_(std::move(folder)), next_at_(wall_now() + kEvery) {}

void LivePage::at(const Instant& instant) {
  next_.at(instant);
  if (++steps_ % kStepsBetween != 0) return;
  if (writer_ != 0) look(false);
  if (writer_ == 0 && wall_now() >= next_at_) begin(kEvery);
}

void LivePage::finish() {
  look(true);
  begin(0);
  look(true);
}

void LivePage::begin(double reload) {
  begun_ = wall_now();
  try {
    writer_ = spawn({own_program(), "report", folder_.string(), "--megabytes", fmt::format("{}", kMegabytes),
                     "--live", fmt::format("{}", reload)},
                    "/dev/null", Life::kOfParent);
  } catch (const std::exception& e) {  // the run goes on without
    tell_once(e.what());
    next_at_ = begun_ + kEvery;
  }
}

// Whether the page is written by now.
void LivePage::look(bool wait) {
  if (writer_ == 0) return;
  int status = 0;
  pid_t ended = 0;
  while ((ended = waitpid(writer_, &status, wait ? 0 : WNOHANG)) < 0 && errno == EINTR) continue;
  if (ended == 0) return;
  writer_ = 0;
  if (WIFEXITED(status) && WEXITSTATUS(status) != 0)  // one that a signal ended was ended with the run
    tell_once(fmt::format("talus report {} tells why", folder_.string()));
  const double took = wall_now() - begun_;
  next_at_ = begun_ + took + std::max(kEvery, took * (1 / kShare - 1));
}

void LivePage::tell_once(const std::string& why) {
  if (!told_) tell("talus: note: live.html is not written: {}\n", why);
  told_ = true;
}

}  // namespace talus::app
