#include "talus/study/folder.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"
#include "talus/output/files.h"
#include "talus/output/folder_lock.h"
#include "talus/output/summary_seal.h"

namespace talus::study {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

constexpr std::array<const char*, 5> kOutcomeName{"finished", "mechanism", "not valid", "refused",
                                                  "not done"};
constexpr int kFormat = 2;  // of study.json

std::string json_text(const ordered_json& j, int indent) {
  return j.dump(indent, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

// Of a file that is torn, or empty: none.
std::optional<ordered_json> json_of(const fs::path& file) {
  if (!is_there(file)) return std::nullopt;
  ordered_json j = ordered_json::parse(read_text_file(file), nullptr, false);
  return j.is_object() ? std::optional(std::move(j)) : std::nullopt;
}

// One name of a file, whatever links lead to it.
std::string absolute_text(const fs::path& path) {
  std::error_code ec;
  const fs::path found = fs::weakly_canonical(path, ec);
  return (ec ? fs::absolute(path).lexically_normal() : found).string();
}

// A line a run, and one with the digest of all: what is torn is known as such.
std::string plan_text(const std::vector<StudyFolder::Task>& tasks) {
  std::string out;
  for (size_t k = 0; k < tasks.size(); ++k) {
    ordered_json j = {{"run", k}, {"set", tasks[k].overrides}};
    if (!tasks[k].group.empty()) j["group"] = tasks[k].group, j["group_set"] = tasks[k].group_overrides;
    out += json_text(j, -1);
  }
  const ordered_json end = {{"runs", tasks.size()}, {"digest", text_hash(out)}};
  return out + json_text(end, -1);
}

std::optional<std::vector<StudyFolder::Task>> plan_of(const fs::path& file) {
  if (!is_there(file)) return std::nullopt;
  const std::string text = read_text_file(file);
  std::vector<StudyFolder::Task> tasks;
  try {
    const size_t last = text.size() < 2 ? std::string::npos : text.rfind('\n', text.size() - 2);
    if (last == std::string::npos || text.back() != '\n') return std::nullopt;
    const std::string lines = text.substr(0, last + 1);
    if (ordered_json::parse(text.substr(last + 1)).at("digest") != text_hash(lines)) return std::nullopt;
    std::istringstream in(lines);
    for (std::string line; std::getline(in, line);) {
      const ordered_json j = ordered_json::parse(line);
      StudyFolder::Task& task = tasks.emplace_back();
      task.overrides = j.at("set").get<std::vector<std::string>>();
      if (j.contains("group"))
        task.group = j["group"], task.group_overrides = j["group_set"].get<std::vector<std::string>>();
    }
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
  return tasks;
}

// Of a study that is begun: no two have the same.
std::string new_id(const fs::path& folder) {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return text_hash(
      fmt::format("{} {} {} {} {}", absolute_text(folder), this_host(), getpid(), now.tv_sec, now.tv_nsec));
}

// The keys of a run in any order: no two are the same.
std::vector<std::string> sorted(std::vector<std::string> overrides) {
  std::sort(overrides.begin(), overrides.end());
  return overrides;
}

std::string key_values(const std::vector<std::string>& overrides) {
  std::string out;
  for (const std::string& item : overrides) out += (out.empty() ? "" : ", ") + item;
  return out;
}

// What a folder holds before its study.json is written: a study that was being begun.
bool is_only_begun(const fs::path& folder, const std::string& study) {
  std::error_code ec;
  fs::directory_iterator entries(folder, ec);
  if (ec) return false;
  // a study file without a plan is somebody's, unless it is this one
  if (!is_there(folder / "plan.jsonl") && is_there(folder / "study.toml") &&
      read_text_file(folder / "study.toml") != study)
    return false;
  for (const auto& entry : entries) {
    const std::string name = entry.path().filename().string();
    const bool empty =
        name == "work" || name == "runs" || name == "parents" ? fs::is_empty(entry.path(), ec) : false;
    if (!empty && name != "study.toml" && name != "plan.jsonl" && name != "study.json" &&
        !is_unfinished_file(entry.path()))
      return false;
  }
  return true;
}

// Numbers of the planned runs: those that are known keep theirs, the others are added. Throws InputError, FileError where
// the folder has runs that are not planned.
void take_in(const Study& study, std::vector<PlannedRun>& plan, const StudyFolder::Sharing& sharing,
             std::vector<StudyFolder::Task>& known, const fs::path& folder) {
  std::map<std::vector<std::string>, size_t> number;
  std::vector<bool> planned;
  size_t free = 0;  // numbers that no record tells of, where the plan was lost
  for (const StudyFolder::Task& task : known) {
    if (!task.overrides.empty()) number.emplace(sorted(task.overrides), planned.size());
    planned.push_back(task.overrides.empty());
  }
  for (size_t k = 0; k < plan.size(); ++k) {
    while (free < known.size() && !known[free].overrides.empty()) ++free;
    const auto [at, added] = number.emplace(sorted(plan[k].overrides), free);
    if (added) {
      if (free == known.size()) known.emplace_back();
      StudyFolder::Task& task = known[free];
      task.overrides = plan[k].overrides;
      if (k < sharing.group.size() && !sharing.group[k].empty())
        task.group = sharing.group[k], task.group_overrides = sharing.group_overrides[k];
    } else if (at->second < planned.size()) {
      planned[at->second] = true;
    }
    plan[k].number = static_cast<int>(at->second);
  }
  const size_t gone = std::find(planned.begin(), planned.end(), false) - planned.begin();
  if (gone < planned.size()) {
    const bool squares = study.latin_hypercube && std::any_of(study.axes.begin(), study.axes.end(),
                                                              [](const Axis& a) { return a.sampled; });
    throw InputError(fmt::format(
        "{}: error: run {} of this folder ({}) is no run of the study file any more: runs can be added, and none "
        "taken away. {}\n",
        folder.string(), gone, key_values(known[gone].overrides),
        squares ? "Another number of samples of a Latin hypercube is another hypercube, with other samples: "
                  "method = \"random\" can be extended"
                : "Put its values back, or take another folder (answers, failure and fragility may change)"));
  }
  if (!std::all_of(known.begin(), known.end(), [](const auto& task) { return !task.overrides.empty(); }))
    throw FileError(
        fmt::format("{}: is missing or torn, and runs/ holds runs that the study file does not plan: "
                    "take another folder",
                    (folder / "plan.jsonl").string()));
}

}  // namespace

const char* name_of(Outcome outcome) { return kOutcomeName[place_of(outcome)]; }

Outcome outcome_of(int exit_code) {
  switch (exit_code) {
    case kExitOk:
      return Outcome::kFinished;
    case kExitMechanism:
      return Outcome::kMechanism;
    case kExitNotValid:
    case kExitNumerical:
      return Outcome::kNotValid;
    case kExitUsage:
    case kExitInput:
      return Outcome::kRefused;
    default:  // kExitFile, kExitResources, kExitInternal, signals
      return Outcome::kNotDone;
  }
}

void StudyFolder::begin(const Study& study, std::vector<PlannedRun>& plan, const Sharing& sharing,
                        const std::string& program, const std::vector<std::string>& files) {
  std::error_code ec;
  forget();
  std::vector<Task> known;
  Description now{new_id(path_), program, absolute_text(study.file), absolute_text(study.model),
                  sharing.until, {}};
  // one that is torn was never begun, where there is nothing else
  if (json_of(path_ / "study.json") ||
      (is_there(path_ / "study.json") && !is_only_begun(path_, study.text))) {
    const Description before = description();
    if (now.model != before.model)
      throw InputError(
          fmt::format("{}: error: {} is its model, and the study file names {}. Runs of two models are no "
                      "study: take another folder\n",
                      path_.string(), before.model, now.model));
    check_files(before, program);
    now.id = before.id, now.files = before.files;
    if (now.until.empty()) now.until = before.until;
    known = plan_of(path_ / "plan.jsonl").value_or(std::vector<Task>());
    if (known.empty()) known = tasks_by_runs();
  } else if (fs::exists(path_, ec) && !is_only_begun(path_, study.text)) {
    throw FileError(fmt::format("{}: is not empty, and holds no study. Take another folder", path_.string()));
  }
  for (const std::string& file : files) {
    const std::string path = absolute_text(file);
    if (!now.files.count(path)) now.files[path] = file_hash(path);
  }
  take_in(study, plan, sharing, known, path_);
  for (const char* name : {"", "work", "runs", "parents"}) {
    fs::create_directories(path_ / name, ec);
    if (ec) fail_file(path_ / name, "made", ec.value());
  }
  write_file(study_file(), study.text);  // answers may have changed
  const std::string lines = plan_text(known);
  if (!is_there(path_ / "plan.jsonl") || read_text_file(path_ / "plan.jsonl") != lines)
    write_file(path_ / "plan.jsonl", lines, Reach::kDisk);
  ordered_json j = {
      {"talus_study", kFormat}, {"program", now.program}, {"study_file", now.study_file},    {"id", now.id},
      {"model", now.model},     {"until", now.until},     {"files", ordered_json(now.files)}};
  // last: the folder is one of a study
  write_file(path_ / "study.json", json_text(j, 2), Reach::kDisk);
  forget();
}

void StudyFolder::check(const std::string& program) const {
  if (!is_there(path_ / "study.json"))
    throw FileError(
        fmt::format("{}: holds no study: study.json is missing. talus study STUDY.toml -o DIR begins one",
                    path_.string()));
  check_files(description(), program);
}

void StudyFolder::check_files(const Description& d, const std::string& program) const {
  const auto refuse = [this](const std::string& what) {
    throw InputError(fmt::format(
        "{}: error: {}. Runs of two models are no study: take another folder, or change it back\n",
        path_.string(), what));
  };
  if (d.program != program) refuse(fmt::format("was begun by {}, and this is {}", d.program, program));
  for (const auto& [file, digest] : d.files) {
    struct stat there {};
    if (stat(file.c_str(), &there) != 0) refuse(fmt::format("{} is gone, which the runs read", file));
    const Stamp stamp{there.st_size, static_cast<int64_t>(there.st_ino), there.st_mtim.tv_sec,
                      there.st_mtim.tv_nsec};
    if (const auto at = looked_at_.find(file); at != looked_at_.end() && at->second == stamp) continue;
    looked_at_[file] = stamp, ++writings_;
    if (file_hash(file) != digest)
      refuse(fmt::format("{} is not what it was for the runs that this folder was begun with", file));
  }
}

int StudyFolder::number(const Study& study, std::vector<PlannedRun>& plan) const {
  if (absolute_text(study.model) != model())
    throw InputError(fmt::format("{}: error: names another model, {}: the runs are of {}\n",
                                 study_file().string(), absolute_text(study.model), model()));
  std::map<std::vector<std::string>, int> numbers;
  for (const Task& task : tasks()) numbers.emplace(sorted(task.overrides), count_of(numbers));
  size_t known = 0;
  for (PlannedRun& run : plan) {
    const auto at = numbers.find(sorted(run.overrides));
    run.number = at == numbers.end() ? -1 : at->second;
    known += at != numbers.end();
  }
  const size_t unknown = plan.size() - known;
  std::erase_if(plan, [](const PlannedRun& run) { return run.number < 0; });
  if (known < numbers.size())
    throw InputError(
        fmt::format("{}: error: plans {} runs, and the folder holds {}: put back what was taken away\n",
                    study_file().string(), plan.size(), numbers.size()));
  return static_cast<int>(unknown);
}

const StudyFolder::Description& StudyFolder::description() const {
  if (description_) return *description_;
  const fs::path file = path_ / "study.json";
  const auto j = json_of(file);
  if (!j)
    throw FileError(fmt::format("{}: is empty or torn: take another folder, results of this one are in runs/",
                                file.string()));
  try {
    if (j->at("talus_study") != kFormat)
      throw FileError(fmt::format("{}: was begun by another version of talus ({}): take another folder",
                                  file.string(), j->value("program", "")));
    description_ = {
        j->at("id").get<std::string>(),         j->at("program").get<std::string>(),
        j->at("study_file").get<std::string>(), j->at("model").get<std::string>(),
        j->at("until").get<std::string>(),      j->at("files").get<std::map<std::string, std::string>>()};
  } catch (const nlohmann::json::exception& e) {
    throw FileError(fmt::format("{}: is not what talus study wrote: {}", file.string(), e.what()));
  }
  return *description_;
}

const std::vector<StudyFolder::Task>& StudyFolder::tasks() const {
  if (!tasks_) tasks_ = plan_of(path_ / "plan.jsonl");
  if (!tasks_)
    throw FileError(fmt::format("{}: is missing or torn: talus study {} -o {} --plan writes it anew",
                                (path_ / "plan.jsonl").string(), study_origin(), path_.string()));
  return *tasks_;
}

// What the records of runs tell of a plan that was lost, each under its number.
std::vector<StudyFolder::Task> StudyFolder::tasks_by_runs() const {
  std::vector<Task> found;
  std::error_code ec;
  for (const auto& entry : fs::directory_iterator(path_ / "runs", ec)) {
    const auto j = json_of(entry.path() / "run.json");
    if (!j || !j->contains("run") || !j->contains("set") || !(*j)["run"].is_number_unsigned() ||
        !(*j)["set"].is_array())
      continue;
    const size_t k = (*j)["run"];
    if (run_folder(static_cast<int>(k)).filename() != entry.path().filename()) continue;
    if (k >= found.size()) found.resize(k + 1);
    for (const auto& item : (*j)["set"])
      if (item.is_string()) found[k].overrides.push_back(item.get<std::string>());
  }
  return found;
}

StudyFolder::Task StudyFolder::task(int number) const {
  if (number < 0 || number >= planned())
    throw FileError(
        fmt::format("{}: there is no run {}; runs are 0 to {}", path_.string(), number, planned() - 1));
  return tasks()[number];
}

fs::path StudyFolder::run_folder(int number) const { return path_ / "runs" / fmt::format("{:06}", number); }

std::optional<RunRecord> StudyFolder::record_of(int number) const {
  const auto j = json_of(run_folder(number) / "run.json");
  if (!j) return std::nullopt;
  RunRecord record;
  try {
    if (j->at("study") != description().id || j->at("set") != task(number).overrides) return std::nullopt;
    const std::string outcome = j->at("outcome");
    const auto at = std::find(kOutcomeName.begin(), kOutcomeName.end(), outcome);
    if (at == kOutcomeName.end()) return std::nullopt;
    record = {j->at("run").get<int>(),          static_cast<Outcome>(at - kOutcomeName.begin()),
              j->at("exit_code").get<int>(),    j->at("wall_time [s]").get<double>(),
              j->at("host").get<std::string>(), j->at("message").get<std::string>()};
    if (record.outcome == Outcome::kRefused || record.outcome == Outcome::kNotDone) return record;
    // it has results, and they say the same
    const auto summary = json_of(run_folder(number) / "summary.json");
    if (!summary || !is_sealed(*summary) || summary->at("digest") != j->at("summary")) return std::nullopt;
    const bool ended = record.exit_code == kExitOk || record.exit_code == kExitNotValid;
    if (summary->at("status") != (ended ? "finished" : "failed")) return std::nullopt;
    if (summary->value("valid", ordered_json()) == false) record.outcome = Outcome::kNotValid;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
  return record;
}

bool StudyFolder::is_done(int number) const {
  const auto record = record_of(number);
  return record && record->outcome != Outcome::kNotDone;
}

fs::path StudyFolder::begun(const std::string& name) const {
  return fs::absolute(path_ / "work" / name).lexically_normal();
}

fs::path StudyFolder::attempt(const std::string& what) const {
  static int count = 0;
  return path_ / "work" / fmt::format("{}.{}.{}.{}", what, this_host(), getpid(), count++);
}

void StudyFolder::finish(int number, const fs::path& attempt, const RunRecord& record) const {
  std::error_code ec;
  fs::create_directories(attempt, ec);
  const auto summary = json_of(attempt / "summary.json");
  const ordered_json j = {{"study", description().id},
                          {"run", record.number},
                          {"summary", summary ? summary->value("digest", "") : ""},
                          {"set", task(number).overrides},
                          {"outcome", name_of(record.outcome)},
                          {"exit_code", record.exit_code},
                          {"wall_time [s]", record.wall_seconds},
                          {"host", record.host},
                          {"message", record.message}};
  write_file(attempt / "run.json", json_text(j, 2), Reach::kDisk);
  const fs::path place = run_folder(number);
  fs::rename(attempt, place, ec);
  if (ec && !is_done(number)) {  // what is there is not done, or torn
    if (record.outcome == Outcome::kNotDone) {
      write_file(place / "run.json", read_text_file(attempt / "run.json"), Reach::kDisk);
      ec.clear();
    } else {
      const fs::path aside = this->attempt("aside");
      fs::rename(place, aside, ec);
      fs::rename(attempt, place, ec);
      std::error_code ignored;
      fs::remove_all(aside, ignored);
    }
  }
  if (ec && !is_done(number)) fail_file(place, "written", ec.value());
  fs::remove_all(attempt, ec);  // another one was first
  sync_folder(path_ / "runs");
}

void StudyFolder::clean() const {
  std::error_code ec;
  const std::string mine = "." + this_host() + ".";
  for (const auto& entry : fs::directory_iterator(path_ / "work", ec)) {
    const std::string name = entry.path().filename().string();
    const size_t at = name.find(mine);
    if (at == std::string::npos) continue;
    const int process = std::atoi(name.c_str() + at + mine.size());
    if (process > 0 && (process == getpid() || kill(process, 0) == 0 || errno != ESRCH)) continue;
    std::error_code gone;
    fs::remove_all(entry.path(), gone);
  }
}

}  // namespace talus::study
