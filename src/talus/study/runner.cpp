#include "talus/study/runner.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <nlohmann/json.hpp>

#include "talus/base/clock.h"
#include "talus/base/descriptor.h"
#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/spawn.h"
#include "talus/base/text_file.h"
#include "talus/output/files.h"
#include "talus/output/folder_lock.h"

namespace talus::study {

namespace fs = std::filesystem;

namespace {

constexpr const char* kLog = "log.txt";
constexpr size_t kMostMessage = 2000;

// The end of what a process has said.
std::string said(const fs::path& log) {
  std::string text;
  try {
    if (!is_there(log)) return "";
    text = read_text_file(log);
  } catch (const FileError& e) {
    return e.what();
  }
  if (text.size() > kMostMessage) text = "... " + text.substr(text.size() - kMostMessage);
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text;
}

// Why the audit does not accept a run, from its summary.
std::string not_valid_because(const fs::path& attempt) {
  try {
    const auto summary = nlohmann::json::parse(read_text_file(attempt / "summary.json"));
    for (const auto& warning : summary.at("warnings"))
      if (const auto text = warning.get<std::string>(); text.rfind("audit:", 0) == 0) return text;
  } catch (const std::exception&) {  // then the run says it itself
  }
  return "";
}

// The answers of a run, without the rest of its results.
void keep_answers(const fs::path& attempt) {
  std::error_code ec;
  std::vector<fs::path> gone;
  for (const auto& entry : fs::directory_iterator(attempt, ec)) {
    const std::string name = entry.path().filename().string();
    if (name != "summary.json" && name != "monitors.csv") gone.push_back(entry.path());
  }
  for (const fs::path& path : gone) fs::remove_all(path, ec);
}

}  // namespace

// The last state of a parent, "" when there is none.
std::string Runner::state_of(const std::string& group) const {
  std::error_code ec;
  std::string newest;
  for (const auto& entry : fs::directory_iterator(folder_.parent_folder(group) / "saved", ec))
    if (const std::string name = entry.path().filename().string();
        name.rfind("stage_", 0) == 0 && name.size() == 11)
      newest = std::max(newest, entry.path().string());
  return newest;
}

void Runner::start(Job job) {
  const std::string model = folder_.model();
  const bool parent = job.number < 0;
  job.attempt = folder_.attempt(parent ? "parent_" + job.group : fmt::format("{:06}", job.number));
  std::vector<std::string> words{settings_.program, "run", model, "-q",
                                 "--threads",       "1",   "-o",  job.attempt.string()};
  for (const std::string& item : parent ? job.task.group_overrides : job.task.overrides)
    words.insert(words.end(), {"--set", item});
  if (!settings_.keep_all) words.insert(words.end(), {"--set", "output.pictures=false"});
  if (parent) words.insert(words.end(), {"--until", folder_.until()});
  if (job.branch) words.insert(words.end(), {"--from", state_of(job.group)});
  folder_.check(settings_.version);
  job.begun = wall_now(), job.writings = folder_.writings();
  try {
    const pid_t process = spawn(words, job.attempt.string() + ".log", Life::kOfParent);
    running_[process] = std::move(job);
  } catch (const FileError& e) {  // no room for its log, no process to be had
    if (parent)
      group_state_[job.group] = 2;
    else
      keep(job, {job.number, Outcome::kNotDone, kExitFile, 0, this_host(), e.what()});
  }
}

void Runner::ended(Job job, int status, bool stopped) {
  std::error_code ec;
  const fs::path log = job.attempt.string() + ".log";
  const int code = WIFSIGNALED(status) ? kExitSignal + WTERMSIG(status) : WEXITSTATUS(status);
  if (stopped && outcome_of(code) == Outcome::kNotDone) {  // it will be made anew
    fs::remove_all(job.attempt, ec);
    fs::remove(log, ec);
    return;
  }
  if (job.number < 0) {
    if (folder_.check(settings_.version);
        (code == kExitOk || code == kExitNotValid) && folder_.writings() == job.writings)
      fs::rename(job.attempt, folder_.parent_folder(job.group), ec);
    fs::remove_all(job.attempt, ec);
    fs::remove(log, ec);
    group_state_[job.group] = state_of(job.group).empty() ? 2 : 1;
    return;
  }
  if (job.branch &&
      (code == kExitInput || code == kExitFile)) {  // more differs than a branch may have, or the state
                                                    // cannot be read: as a run of its own
    fs::remove_all(job.attempt, ec);
    fs::remove(log, ec);
    job.branch = false;
    job.group.clear();
    waiting_.push_front(std::move(job));
    return;
  }
  RunRecord record{job.number, outcome_of(code), code, wall_now() - job.begun, this_host(), said(log)};
  if (code == kExitOk) record.message.clear();  // warnings stand in its summary
  if (code > kExitSignal && record.message.empty())
    record.message = fmt::format("ended by signal {}", code - kExitSignal);
  // what it says of its folder is true of where that goes
  for (size_t at; (at = record.message.find(job.attempt.string())) != std::string::npos;)
    record.message.replace(at, job.attempt.string().size(), folder_.run_folder(job.number).string());
  if (code == kExitNotValid)
    if (std::string why = not_valid_because(job.attempt); !why.empty()) record.message = std::move(why);
  if (folder_.check(settings_.version); folder_.writings() != job.writings)
    record.outcome = Outcome::kNotDone, record.message = "a file that it reads was written while it ran";
  keep(job, std::move(record));
}

// A run that cannot be kept is not done, and the study goes on.
void Runner::keep(const Job& job, RunRecord record) {
  std::error_code ec;
  const fs::path log = job.attempt.string() + ".log";
  try {
    fs::create_directories(job.attempt, ec);
    if (!settings_.keep_all) keep_answers(job.attempt);
    if (settings_.keep_all && !record.message.empty()) fs::rename(log, job.attempt / kLog, ec);
    folder_.finish(job.number, job.attempt, record);
    // as the folder sees it: a summary that is not whole is none
    const auto kept = folder_.record_of(job.number);
    record.outcome = kept ? kept->outcome : Outcome::kNotDone;
    if (!kept) record.message = "what it wrote is not whole";
    if (settings_.report && record.outcome != Outcome::kRefused && record.outcome != Outcome::kNotDone)
      make_report(job);
  } catch (const FileError& e) {
    record.outcome = Outcome::kNotDone, record.message = e.what();
    fs::remove_all(job.attempt, ec);
  }
  fs::remove(log, ec);
  if (record.outcome == Outcome::kNotDone) {
    ++progress_.not_done;
    progress_.cause =
        fmt::format("run {}: {}", job.number,
                    record.message.empty() ? fmt::format("exit code {}", record.exit_code) : record.message);
  } else {
    ++progress_.done;
    progress_.without += record.outcome == Outcome::kRefused || record.outcome == Outcome::kNotValid;
  }
}

// A report that cannot be made is none: the row of the run opens its folder.
void Runner::make_report(const Job& job) {
  try {
    const pid_t process = spawn({settings_.program, "report", folder_.run_folder(job.number).string()},
                                "/dev/null", Life::kOfParent);
    int ignored = 0;
    while (waitpid(process, &ignored, 0) < 0 && errno == EINTR) continue;
  } catch (const FileError&) {
  }
}

// Ends what runs, and leaves nothing of it.
void Runner::give_up() {
  for (const auto& [process, job] : running_) kill(process, SIGKILL);
  for (auto& [process, job] : running_) {
    std::error_code ec;
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
    fs::remove_all(job.attempt, ec);
    fs::remove(job.attempt.string() + ".log", ec);
  }
  running_.clear();
}

// The first of those that run that has ended; -1 after a while without, to ask for a stop: a signal that comes before one
// waits does not end the waiting.
pid_t Runner::one_that_ended(int& status) const {
  constexpr int kWhile = 200;  // [ms]
  std::vector<Descriptor> descriptors;
  std::vector<pollfd> ends;
  for (const auto& [process, job] : running_) {
    descriptors.emplace_back(static_cast<int>(syscall(SYS_pidfd_open, process, 0)));
    if (descriptors.back() >= 0) ends.push_back({descriptors.back(), POLLIN, 0});
  }
  (void)poll(ends.data(), ends.size(), ends.size() < running_.size() ? kWhile / 10 : kWhile);
  for (const auto& [process, job] : running_)
    if (waitpid(process, &status, WNOHANG) == process) return process;
  return -1;
}

Progress Runner::run(const std::vector<int>& numbers, const std::function<void(const Progress&)>& told,
                     const std::function<bool()>& stop) {
  try {
    return run_all(numbers, told, stop);
  } catch (...) {
    give_up();
    throw;
  }
}

Progress Runner::run_all(const std::vector<int>& numbers, const std::function<void(const Progress&)>& told,
                         const std::function<bool()>& stop) {
  progress_ = {};
  progress_.all = count_of(numbers);
  std::deque<Job> parents;
  for (const int number : numbers) {
    if (const auto record = folder_.record_of(number); record && record->outcome != Outcome::kNotDone) {
      ++progress_.done;
      progress_.without += record->outcome == Outcome::kRefused || record->outcome == Outcome::kNotValid;
      continue;
    }
    Job job;
    job.number = number, job.task = folder_.task(number), job.group = job.task.group;
    if (!job.group.empty() && !group_state_.count(job.group)) {
      std::error_code ec;
      const bool there = fs::exists(folder_.parent_folder(job.group), ec);
      group_state_[job.group] = !there ? 0 : state_of(job.group).empty() ? 2 : 1;
      if (!there) {
        Job parent = job;
        parent.number = -1;
        parents.push_back(std::move(parent));
      }
    }
    waiting_.push_back(std::move(job));
  }
  waiting_.insert(waiting_.begin(), parents.begin(), parents.end());
  const int before = progress_.done;
  const double begun = wall_now();
  bool stopped = false;
  while (!waiting_.empty() || !running_.empty()) {
    // as many as there is room for; those whose parent is being made wait
    for (size_t i = 0; i < waiting_.size() && !stopped && count_of(running_) < settings_.jobs;) {
      Job& next = waiting_[i];
      if (next.number >= 0 && !next.group.empty()) {
        const int state = group_state_[next.group];
        if (state == 0) {
          ++i;
          continue;
        }
        next.branch = state == 1;
      }
      Job job = std::move(next);
      waiting_.erase(waiting_.begin() + i);
      start(std::move(job));
    }
    if (stopped) waiting_.clear();  // a branch that was refused meanwhile, too
    if (running_.empty() && waiting_.empty()) break;
    if (running_.empty()) continue;  // none could be started
    progress_.running = count_of(running_);
    told(progress_);
    int status = 0;
    const pid_t process = one_that_ended(status);
    if (!stopped && stop()) {
      stopped = true;
      waiting_.clear();
      for (const auto& [running, job] : running_) kill(running, SIGTERM);
    }
    const auto at = running_.find(process);
    if (at == running_.end()) continue;
    Job job = std::move(at->second);
    running_.erase(at);
    ended(std::move(job), status, stopped);
    const int ours = progress_.done + progress_.not_done - before;
    if (ours > 0) progress_.to_go = (wall_now() - begun) / ours * (progress_.all - before - ours);
  }
  progress_.running = 0;
  told(progress_);
  return progress_;
}

}  // namespace talus::study
