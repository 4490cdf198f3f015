#include "talus/study/folder.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <sstream>

#include "talus/base/error.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"
#include "talus/output/files.h"
#include "talus/output/folder_lock.h"

namespace talus::study {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

ordered_json json_of(const fs::path& file) {
  try {
    return ordered_json::parse(read_text_file(file));
  } catch (const nlohmann::json::exception& e) {
    throw FileError(fmt::format("{}: cannot be read: {}", file.string(), e.what()));
  }
}

std::string plan_text(const std::vector<PlannedRun>& plan, const StudyFolder::Sharing& sharing) {
  std::string out;
  for (const PlannedRun& run : plan) {
    ordered_json j = {{"run", run.number}, {"set", run.overrides}};
    const auto k = static_cast<size_t>(run.number);
    if (k < sharing.group.size() && !sharing.group[k].empty())
      j["group"] = sharing.group[k], j["group_set"] = sharing.group_overrides[k];
    out += j.dump() + "\n";
  }
  return out;
}

}  // namespace

void StudyFolder::begin(const Study& study, const std::vector<PlannedRun>& plan, const Sharing& sharing,
                        const std::string& program, const std::string& inputs) {
  const std::string text = plan_text(plan, sharing);
  ordered_json now = {{"talus_study", 1},
                      {"program", program},
                      {"study_file", fs::absolute(study.file).lexically_normal().string()},
                      {"model", fs::absolute(study.model).lexically_normal().string()},
                      {"inputs_hash", inputs},
                      {"runs", plan.size()},
                      {"plan_hash", text_hash(text)},
                      {"until", sharing.until}};
  std::error_code ec;
  if (fs::exists(path_ / "study.json", ec)) {
    const ordered_json before = json_of(path_ / "study.json");
    for (const auto& [key, what] :
         {std::pair("plan_hash", "the study file plans other runs than those"),
          std::pair("inputs_hash",
                    "the model file, or a file that it or the study names, is not what it was for the runs")})
      if (before.value(key, "") != now[key])
        throw InputError(fmt::format(
            "{}: error: {} that this folder was begun with. Take another folder, or change it back "
            "(answers, failure and fragility may change)\n",
            path_.string(), what));
    write_file(study_file(), study.text);  // answers may have changed
    return;
  }
  if (fs::exists(path_, ec) && !fs::is_empty(path_, ec))
    throw FileError(fmt::format("{}: is not empty, and holds no study. Take another folder", path_.string()));
  for (const char* name : {"", "work", "runs", "parents"}) {
    fs::create_directories(path_ / name, ec);
    if (ec) fail_file(path_ / name, "made", ec.value());
  }
  write_file(study_file(), study.text);
  write_file(path_ / "plan.jsonl", text);
  write_file(path_ / "study.json", now.dump(2) + "\n", Reach::kDisk);  // last: the folder is one of a study
}

void StudyFolder::check() const {
  if (!is_there(path_ / "study.json"))
    throw FileError(
        fmt::format("{}: holds no study: study.json is missing. talus study STUDY.toml -o DIR begins one",
                    path_.string()));
}

StudyFolder::Description StudyFolder::description() const {
  const fs::path file = path_ / "study.json";
  const ordered_json j = json_of(file);
  try {
    return {j.at("study_file").get<std::string>(), j.at("model").get<std::string>(),
            j.at("until").get<std::string>(), j.at("runs").get<int>()};
  } catch (const nlohmann::json::exception& e) {
    throw FileError(fmt::format("{}: is not what talus study wrote: {}", file.string(), e.what()));
  }
}

const std::string& StudyFolder::line(int number) const {
  if (lines_.empty()) {
    std::istringstream in(read_text_file(path_ / "plan.jsonl"));
    for (std::string one; std::getline(in, one);) lines_.push_back(one);
  }
  if (number < 0 || static_cast<size_t>(number) >= lines_.size())
    throw FileError(fmt::format("{}: there is no run {}; runs are 0 to {}", path_.string(), number,
                                static_cast<int>(lines_.size()) - 1));
  return lines_[static_cast<size_t>(number)];
}

StudyFolder::Task StudyFolder::task(int number) const {
  Task task;
  try {
    const auto j = ordered_json::parse(line(number));
    task.overrides = j.at("set").get<std::vector<std::string>>();
    if (j.contains("group"))
      task.group = j["group"], task.group_overrides = j["group_set"].get<std::vector<std::string>>();
  } catch (const nlohmann::json::exception& e) {
    throw FileError(
        fmt::format("{}: run {} cannot be read: {}", (path_ / "plan.jsonl").string(), number, e.what()));
  }
  return task;
}

fs::path StudyFolder::run_folder(int number) const { return path_ / "runs" / fmt::format("{:06}", number); }

std::optional<RunRecord> StudyFolder::record_of(int number) const {
  const fs::path file = run_folder(number) / "run.json";
  std::error_code ec;
  if (!fs::exists(file, ec)) return std::nullopt;
  const ordered_json j = json_of(file);
  try {
    return RunRecord{j.at("run").get<int>(),  j.at("status").get<std::string>(),
                     j.value("exit_code", 0), j.value("wall_time [s]", 0.0),
                     j.value("host", ""),     j.value("message", "")};
  } catch (const nlohmann::json::exception& e) {
    throw FileError(fmt::format("{}: is not what talus study wrote: {}", file.string(), e.what()));
  }
}

bool StudyFolder::is_done(int number) const {
  const auto record = record_of(number);
  return record && record->status != "killed";
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
  const ordered_json j = {{"run", record.number},          {"status", record.status},
                          {"exit_code", record.exit_code}, {"wall_time [s]", record.wall_seconds},
                          {"host", record.host},           {"message", record.message}};
  write_file(attempt / "run.json", j.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
  const fs::path place = run_folder(number);
  fs::rename(attempt, place, ec);
  if (!ec) return;
  if (const auto there = record_of(number); there && there->status == "killed") {
    const fs::path aside = this->attempt("killed");
    fs::rename(place, aside, ec);
    fs::rename(attempt, place, ec);
    if (!ec) {
      fs::remove_all(aside, ec);
      return;
    }
  }
  if (!record_of(number)) fail_file(place, "written", ec.value());
  fs::remove_all(attempt, ec);  // another one was first
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
