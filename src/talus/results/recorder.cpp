#include "talus/results/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "talus/base/clock.h"
#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/text_file.h"
#include "talus/base/version.h"
#include "talus/model/with_folder.h"
#include "talus/output/paraview_view.h"
#include "talus/output/summary_seal.h"
#include "talus/results/model_report.h"
#include "talus/results/problem_file.h"
#include "talus/results/slip_report.h"
#include "talus/results/step_table.h"

namespace talus {

namespace {

// Whether an instant reaches the next multiple of the interval, which then moves on. Interval 0: always.
bool is_due(double time, double dt, double interval, double& next) {
  if (interval <= 0) return true;
  if (time < next - 1e-6 * dt) return false;
  next = (std::floor((time + 1e-6 * dt) / interval) + 1) * interval;
  return true;
}

constexpr const char *kHistorySize = "recorder.histories_csv", *kStepsSize = "recorder.steps_csv";
constexpr const char *kJointsSize = "recorder.joints_csv", *kBoltsSize = "recorder.bolts_csv";
constexpr const char* kSlipsSize = "recorder.slips_csv";
constexpr size_t kSavedStates = 2;  // between stages

std::string dump_name(int64_t step) { return fmt::format("step_{}.json", step); }
std::string step_name(int64_t step) { return fmt::format("step_{:09}.h5", step); }

// Number of the step in the name of a state between stages; none in any other name, which is the user's.
std::optional<int64_t> step_in(const std::string& name) {
  int64_t step = -1;
  if (name.rfind("step_", 0) != 0) return std::nullopt;
  std::from_chars(name.data() + 5, name.data() + name.size(), step);
  return name == step_name(step) ? std::optional(step) : std::nullopt;
}

int64_t size_in(const Archive& saved, const std::string& name) {
  Loader loader(saved);
  int64_t size = 0;
  loader(name, size);
  return size;
}

// Whether the state was saved of a run that wrote results.
bool has_results(const Archive& saved) {
  const auto at = saved.numbers.lower_bound("recorder.");
  return at != saved.numbers.end() && at->first.rfind("recorder.", 0) == 0;
}

// A table that is written whole at the end of every stage, as it was when the state was saved.
std::string table_then(ResultFolder& folder, const char* name, int64_t size) {
  const std::filesystem::path path = folder.path() / name;
  std::error_code ec;
  if (size == 0) {
    std::filesystem::remove(path, ec);  // written after the state was
    return {};
  }
  std::string text = read_text_file(path);
  text.resize(size);  // check_tables(): it is that long
  folder.write(name, text, Reach::kDisk);
  return text;
}

// Replaced at the end: a run that was killed shows as one.
std::string running_text(const Scene& scene) {
  const nlohmann::ordered_json running = {{"program", fmt::format("talus {}", kVersion)},
                                          {"title", scene.model.title},
                                          {"model_hash", scene.model.hash},
                                          {"status", "running"}};
  return running.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

// The model such that it runs again where the results lie: its paths count from where they did.
std::string model_to_keep(const Model& model, const std::filesystem::path& folder) {
  return !model.files.empty() ? with_folder(model.text, model.folder, folder) : model.text;
}

// First of all files: whatever happens then, the folder says what it is.
ResultFolder begin_results(ResultFolder folder, const Scene& scene) {
  folder.write("summary.json", running_text(scene), Reach::kDisk);
  folder.write("model.toml", model_to_keep(scene.model, folder.path()), Reach::kDisk);
  folder.make_folder("fields");
  folder.write(kParaviewView, paraview_view());
  return folder;
}

// Before a byte of the results is cut off: they are as long as the state says, or longer.
void check_tables(const std::filesystem::path& folder, const Archive& saved) {
  for (const auto& [name, size] : {std::pair("histories.csv", kHistorySize),
                                   std::pair("steps.csv", kStepsSize), std::pair("joints.csv", kJointsSize),
                                   std::pair("bolts.csv", kBoltsSize), std::pair("slips.csv", kSlipsSize)}) {
    const int64_t then = size_in(saved, size);
    const bool grows = std::string_view(name) == "histories.csv" || std::string_view(name) == "steps.csv";
    if (then == 0 && grows) throw FileError(fmt::format("the saved state is damaged: {} had no title", name));
    if (then != 0) check_continued(folder / name, then);
  }
}

void check_frames(const std::filesystem::path& folder, const Archive& saved, bool bolts) {
  std::vector<double> times;
  const Loader from(saved);
  from("recorder.frames", times);
  for (const auto& [name, end] :
       {std::pair("blocks", "vtu"), std::pair("contacts", "vtp"), std::pair("bolts", "vtp")})
    if (bolts || std::string_view(name) != "bolts")
      check_frames_there(folder / "fields", name, end, times.size());
}

}  // namespace

Recorder::~Recorder() = default;

Recorder::Recorder(const Scene& scene, ResultFolder folder, RunNotes notes)
    : scene_(scene),
      folder_(begin_results(std::move(folder), scene)),
      notes_(std::move(notes)),
      model_(model_in_numbers(scene).dump()),
      history_file_(folder_.note("histories.csv"), texts_of(Histories(scene, nullptr).columns())),
      steps_file_(folder_.note("steps.csv"), titles_of(step_columns())),
      histories_(scene, [this](const std::vector<double>& row) { append_history(row); }),
      block_frames_(folder_, "blocks", "vtu"),
      contact_frames_(folder_, "contacts", "vtp"),
      bolt_frames_(folder_, "bolts", "vtp"),
      last_flush_(wall_now()),
      last_saved_(wall_now()) {
  if (scene.model.output.audit) auditor_.emplace(scene);
}

Recorder::Recorder(const Scene& scene, ResultFolder folder, const Archive& saved, RunNotes notes)
    : scene_(scene),
      folder_(taken_up(std::move(folder), scene, saved)),
      notes_(std::move(notes)),
      model_(model_in_numbers(scene).dump()),
      history_file_(folder_.note("histories.csv"), size_in(saved, kHistorySize)),
      steps_file_(folder_.note("steps.csv"), size_in(saved, kStepsSize)),
      histories_(scene, [this](const std::vector<double>& row) { append_history(row); }),
      block_frames_(folder_, "blocks", "vtu"),
      contact_frames_(folder_, "contacts", "vtp"),
      bolt_frames_(folder_, "bolts", "vtp"),
      bolt_table_(table_then(folder_, "bolts.csv", size_in(saved, kBoltsSize))),
      joints_(table_then(folder_, "joints.csv", size_in(saved, kJointsSize))),
      slips_(table_then(folder_, "slips.csv", size_in(saved, kSlipsSize))),
      last_flush_(wall_now()),
      last_saved_(wall_now()) {
  if (scene.model.output.audit) auditor_.emplace(scene);
  load(saved);
  find_saved();
}

std::unique_ptr<Recorder> Recorder::branch_off(const Scene& scene, ResultFolder folder, const Archive& parent,
                                               RunNotes notes) {
  const BranchOrigin origin = notes.branch.value();
  if (!has_results(parent)) return std::make_unique<Recorder>(scene, std::move(folder), std::move(notes));
  check_kept(scene, parent, origin.same_monitors, origin.same_output);
  auto recorder = std::make_unique<Recorder>(scene, std::move(folder), std::move(notes));
  Loader from(parent);
  recorder->joint_summary_.load(from, "recorder.joints", scene);
  recorder->bolt_summary_.load(from, "recorder.bolts");
  if (origin.same_monitors) recorder->histories_.load(from);
  if (origin.same_output) {
    Due::exchange(from, recorder->due_);
    if (recorder->auditor_) recorder->auditor_->load(from);
  }
  return recorder;
}

// The sizes of the tables are read where these are opened.
template <class X, class Self>
void Recorder::Due::exchange(X& x, Self& due) {
  x("recorder.history", due.history), x("recorder.next_steps", due.steps);
  x("recorder.next_frame", due.frame), x("recorder.worst", due.worst);
  x("recorder.dumped_failure", due.dumped_failure);
}

void Recorder::load(const Archive& saved) {
  Loader from(saved);
  Due::exchange(from, due_);
  joint_summary_.load(from, "recorder.joints", scene_);
  bolt_summary_.load(from, "recorder.bolts");
  histories_.load(from);
  if (auditor_) auditor_->load(from);
  std::vector<double> times;
  from("recorder.frames", times);
  block_frames_.go_on(times);
  contact_frames_.go_on(times);
  if (!scene_.model.bolts.empty()) bolt_frames_.go_on(times);
}

// What of monitors and output is to go on can be read.
void Recorder::check_kept(const Scene& scene, const Archive& saved, bool monitors, bool output) {
  try {
    Loader from(saved);
    JointSummary().load(from, "recorder.joints", scene);
    if (monitors) Histories(scene, nullptr).load(from);
    if (!output) return;
    if (scene.model.output.audit) Auditor(scene).load(from);
    Due due;
    Due::exchange(from, due);
    if (!due.worst.empty() && due.worst.size() != step_columns().size())
      throw FileError(
          fmt::format("it has {} values of a step, not {}", due.worst.size(), step_columns().size()));
  } catch (const FileError& e) {
    throw FileError(fmt::format(
        "the saved state is damaged: {}. Go on from another one, or run the model anew", e.what()));
  }
}

void Recorder::check(const ResultFolder& folder, const Scene& scene, const Archive& saved) {
  check_kept(scene, saved, true, true);
  check_tables(folder.path(), saved);
  check_frames(folder.path(), saved, !scene.model.bolts.empty());
}

// Before any of the results is cut back.
ResultFolder Recorder::taken_up(ResultFolder folder, const Scene& scene, const Archive& saved) {
  check(folder, scene, saved);
  folder.write("summary.json", running_text(scene), Reach::kDisk);
  return folder;
}

bool Recorder::wants_state() {
  // the clock is not asked at every step
  constexpr int kStepsBetween = 16;
  const double interval = scene_.model.output.save_interval;
  return interval > 0 && (interval < 1 || ++steps_since_look_ % kStepsBetween == 0) &&
         wall_now() - last_saved_ >= interval;
}

bool Recorder::wants_copy() {
  constexpr int kStepsBetween = 16;
  // takes at most this share of the time
  constexpr double kShare = 0.02;
  if (held_ && ++steps_since_held_ % kStepsBetween != 0) return false;
  return !held_ || wall_now() - held_at_ >= holding_took_ / kShare;
}

void Recorder::hold_state(const Standing& standing, const State& state) {
  const std::lock_guard lock(taking_);
  if (ended_) return;
  const double begin = wall_now();
  RunResult interrupted = standing.result;
  interrupted.interrupted = true;
  held_ = Held{archive_of(standing, state), state.step, summary_of(interrupted)};
  held_at_ = wall_now(), holding_took_ = held_at_ - begin;
}

Archive Recorder::archive_of(const Standing& standing, const State& state) const {
  Archive archive = run_archive(scene_, standing, state);
  Saver to(archive);
  Due::exchange(to, due_);
  joint_summary_.save(to, "recorder.joints");
  bolt_summary_.save(to, "recorder.bolts");
  histories_.save(to);
  if (auditor_) auditor_->save(to);
  to("recorder.frames", block_frames_.times());
  to(kHistorySize, history_file_.size());
  to(kStepsSize, steps_file_.size());
  to(kJointsSize, joints_.size());
  to(kSlipsSize, slips_.size());
  to(kBoltsSize, bolt_table_.size());
  return archive;
}

std::string Recorder::summary_of(const RunResult& result) const {
  return summary_text(scene_, result, notes_, block_frames_.count(), joint_summary_, bolt_summary_,
                      &histories_, model_, audit());
}

void Recorder::flush_tables() {
  history_file_.flush();
  steps_file_.flush();
}

// A state counts on the rows and frames before it: they reach the disk first.
std::filesystem::path Recorder::write_saved(const std::string& name, const Archive& archive) {
  flush_tables();
  folder_.make_folder("saved");
  auto path = folder_.note("saved/" + name);
  sync_files_of(folder_.path());
  write_archive(path, archive);
  left_.state = "saved/" + name;
  return path;
}

void Recorder::write_step(int64_t step, const Archive& archive) {
  const auto path = write_saved(step_name(step), archive);
  std::erase(saved_, path);
  saved_.push_back(path);
  std::error_code ec;
  for (; saved_.size() > kSavedStates; saved_.erase(saved_.begin())) std::filesystem::remove(saved_[0], ec);
}

void Recorder::write_held() {
  if (held_ && saved_step_ < held_->step) write_step(held_->step, held_->archive);
}

void Recorder::keep_state(const Standing& standing, const State& state) {
  const std::lock_guard lock(taking_);
  if (ended_) return;
  const Archive archive = archive_of(standing, state);
  if (standing.between)
    write_saved(fmt::format("stage_{:02}.h5", standing.result.stages.size()), archive);
  else
    write_step(state.step, archive);
  saved_step_ = state.step;
  last_saved_ = wall_now();
}

// States between stages that an interrupted run has left.
void Recorder::find_saved() {
  std::error_code ec;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "saved", ec))
    if (step_in(entry.path().filename().string())) saved_.push_back(entry.path());
  std::sort(saved_.begin(), saved_.end());
}

void Recorder::at(const Instant& i) {
  const std::lock_guard lock(taking_);
  if (ended_) return;
  const OutputInput& out = scene_.model.output;
  const double t = i.state.time, dt = i.advance;
  // of these results, which may be those of a branch
  const bool first = block_frames_.count() == 0, start = first || i.stage_start;
  if (out.history_interval > 0)
    histories_.at_even(i, out.history_interval, due_.history);
  else
    histories_.at(i, true);
  record_step(i);
  const bool failure = i.report.failed && !due_.dumped_failure;
  if (failure || i.state.step == dump_step_) {
    const std::string name = write_dump(i);
    if (failure) left_.step = name;
    due_.dumped_failure = due_.dumped_failure || failure;
  }
  const bool frame = out.field_interval > 0 && !i.on_the_way && is_due(t, dt, out.field_interval, due_.frame);
  if (frame || start || i.last) {
    const FrameTexts texts = write_frame(i);
    if (first && out.pictures) folder_.write("blocks_start.svg", picture_of(texts, scene_.model.title));
    if (i.last && out.pictures) folder_.write("blocks_end.svg", picture_of(texts, scene_.model.title));
  }
  if (auditor_) auditor_->at(i, frame || start || i.last);
  // a stage ends at the instant at which the next one starts
  if (i.stage_start && i.stage > 0) write_joints(i, i.stage - 1);
  if (i.last) write_joints(i, i.stage);
  if (first) folder_.write("blocks.csv", blocks_table(scene_));
  if (i.last || (start && i.stage > 0)) write_bolts(i);
  if (wall_now() - last_flush_ > 1) {
    flush_tables();
    last_flush_ = wall_now();
  }
}

// What there is to look at of a run that failed: the instant before nothing could go on.
void Recorder::fails(const Instant& i) {
  const std::lock_guard lock(taking_);
  if (ended_) return;
  // a step that failed before, and did not end the run, is not the one to look at
  if (left_.step != dump_name(i.state.step)) left_.step = write_dump(i);
  left_.frame = i.state.time;
  try {
    write_failed(i);
  } catch (const NumericalError&) {  // what cannot be written is the failure, of which the run tells
    left_.frame.reset();
  }
}

void Recorder::write_failed(const Instant& i) {
  const bool there = !block_frames_.times().empty() && block_frames_.times().back() >= i.state.time;
  const FrameTexts texts = there ? frame_texts(scene_, i) : write_frame(i);
  write_joints(i, i.stage);
  bolt_summary_ = BoltSummary::of(bolt_lines(scene_, i.state, i.stage));
  if (!scene_.model.output.pictures) return;
  std::string picture;
  try {
    picture = picture_of(texts, scene_.model.title);
  } catch (const FileError&) {  // blocks without a shape: that is the failure, of which the run tells
    return;
  }
  folder_.write("blocks_end.svg", picture);
}

// The equations of a step as a file, whose name it gives; of a very large one only when it was asked for.
std::string Recorder::write_dump(const Instant& i) {
  constexpr size_t kMostPoints = 200000;
  if (i.work.rows.points.size() > kMostPoints && i.state.step != dump_step_) return "";
  if (scene_.model.formulation == Formulation::kPenalty) return "";  // there are no such equations
  const std::string name = dump_name(i.state.step);
  folder_.write(name, problem_text(i));
  return name;
}

namespace {

// A table holds numbers, or the run ends with the first that is none.
void check_finite(const std::vector<double>& row, const auto& titles, const char* file, double time) {
  for (size_t c = 0; c < row.size(); ++c)
    if (!std::isfinite(row[c]))
      throw NumericalError(fmt::format(
          "t = {:.9g} s: {} would be {} in {}: the model has a number beyond what can be computed with", time,
          titles()[c], row[c], file));
}

// The first number of a summary that is none, by its keys; "".
std::string not_finite_in(const nlohmann::ordered_json& j, const std::string& path) {
  if (j.is_null()) return path;
  if (j.is_structured())
    for (const auto& [key, value] : j.items())
      if (std::string found = not_finite_in(value, path.empty() ? key : path + "." + key); !found.empty())
        return found;
  return "";
}

}  // namespace

void Recorder::append_history(const std::vector<double>& row) {
  check_finite(
      row, [this] { return texts_of(histories_.columns()); }, "histories.csv", row[0]);
  history_file_.append(row);
}

void Recorder::record_step(const Instant& i) {
  std::vector<double> row = values_of(step_columns(), i);
  if (!due_.worst.empty()) take_in(step_columns(), due_.worst, row);
  if (is_due(i.state.time, i.advance, scene_.model.output.steps_interval, due_.steps) || i.last ||
      i.report.failed) {
    if (!i.report.failed)
      check_finite(
          row, [] { return titles_of(step_columns()); }, "steps.csv", i.state.time);
    steps_file_.append(row);
    due_.worst.clear();
  } else {
    due_.worst = std::move(row);
  }
}

FrameTexts Recorder::write_frame(const Instant& i) {
  FrameTexts texts = frame_texts(scene_, i);
  block_frames_.add(i.state.time, texts.blocks);
  contact_frames_.add(i.state.time, texts.contacts);
  if (!texts.bolts.empty()) bolt_frames_.add(i.state.time, texts.bolts);
  return texts;
}

// Tables that are replaced as a whole reach the disk at once: states that are there already count on them.

// The bolts at the end of a stage: at the last instant, or at the first of the stage after it.
void Recorder::write_bolts(const Instant& i) {
  if (scene_.model.bolts.empty()) return;
  const int stage = i.last ? i.stage : i.stage - 1;
  if (bolt_table_.empty()) bolt_table_ = csv_head(bolt_columns());
  const std::string& name = scene_.model.stages[stage].name;
  const std::vector<BoltLine> lines = bolt_lines(scene_, i.state, stage);
  bolt_summary_ = BoltSummary::of(lines);
  for (const BoltLine& line : lines)
    bolt_table_ += csv_row(bolt_columns(), BoltRow{line, name, i.state.time});
  folder_.write("bolts.csv", bolt_table_, Reach::kDisk);
}

void Recorder::write_joints(const Instant& i, int stage) {
  const std::string& name = scene_.model.stages[stage].name;
  joint_summary_ = {};
  SlipList slipped;
  if (joints_.empty()) joints_ = csv_head(joint_columns());
  for (size_t r = 0; r < i.work.rows.range(Family::kContact).end; ++r) {
    const auto point = joint_point(scene_, i, r);
    if (!point || point->is(JointState::kApart)) continue;
    joint_summary_.add(*point);
    slipped.add(scene_, *point);
    joints_ += csv_row(joint_columns(), JointRow{scene_, *point, name, i.state.time});
  }
  joint_summary_.time = i.state.time;
  joint_summary_.look(scene_, i.state);
  folder_.write("joints.csv", joints_, Reach::kDisk);

  const std::vector<SlippedJoint> list = slipped.sorted();
  if (slips_.empty()) slips_ = csv_head(slip_columns());
  for (const SlippedJoint& joint : list)
    slips_ += csv_row(slip_columns(), SlipRow{scene_, joint, name, i.state.time});
  joint_summary_.slipped_joints = count_of(list);
  if (!list.empty()) joint_summary_.most_residual = list[0].most;
  folder_.write("slips.csv", slips_, Reach::kDisk);
}

std::optional<audit::Report> Recorder::audit() const {
  return auditor_ ? std::optional(auditor_->report()) : std::nullopt;
}

// The summary with size and digest of each table and of the model, and its own: what is changed afterwards is known as such (talus compare).
std::string Recorder::marked(const std::string& summary) const {
  auto j = nlohmann::ordered_json::parse(summary);
  if (j["status"] == "finished") {
    auto numbers = j;
    numbers.erase("valid"), numbers.erase("audit");  // null: not audited
    if (const std::string found = not_finite_in(numbers, ""); !found.empty())
      throw NumericalError(fmt::format("summary.json: {} is not finite", found));
  }
  auto& files = j["files"] = nlohmann::ordered_json::object();
  for (const char* name : kMarkedFiles)
    if (const auto mark = folder_.mark_of(name))
      files[name] = {{"bytes", mark->bytes}, {"digest", mark->digest}};
  return sealed_summary(std::move(j));
}

void Recorder::finish(const RunResult& result) {
  const std::lock_guard lock(taking_);
  if (ended_) return;
  histories_.finish();
  flush_tables();
  if (!result.failure.empty()) write_held();
  folder_.write("monitors.csv", histories_.answers().csv(), Reach::kDisk);
  if (const Histories::Spectra spectra = histories_.spectra(); !spectra.columns.empty())
    folder_.write("spectra.csv", spectra.csv(), Reach::kDisk);
  history_file_.check(), steps_file_.check(), folder_.check_files();
  folder_.write("summary.json", marked(summary_of(result)), Reach::kDisk);
  ended_ = true;
}

namespace {

// A summary of a run that has ended with an error.
std::string failed_text(const std::string& summary, const std::string& why, const std::string& state) {
  auto j = nlohmann::ordered_json::parse(summary);
  j["status"] = "failed";
  j["failure"] = why;
  if (!state.empty()) j["saved_state"] = state;
  return j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

void Recorder::abandon(const std::string& why) noexcept {
  const std::lock_guard lock(taking_);
  if (ended_) return;
  try {
    flush_tables();
  } catch (const std::exception&) {  // the rows of the last second; the table stays whole
  }
  write_last_word(why);
}

void Recorder::write_last_word(const std::string& why) noexcept {
  folder_.free_reserve();
  try {
    folder_.write("summary.json",
                  failed_text(held_ ? held_->summary : running_text(scene_), why, left_.state), Reach::kDisk);
  } catch (const std::exception&) {  // "running" stays; the command tells why
  }
}

void Recorder::abandon_begun(const std::filesystem::path& folder, const std::string& why) noexcept {
  try {
    const std::string summary = read_text_file(folder / "summary.json");
    if (nlohmann::json::parse(summary).value("status", "") != "running") return;
    ResultFolder results = ResultFolder::go_on(folder);
    results.free_reserve();
    results.write("summary.json", failed_text(summary, why, ""), Reach::kDisk);
  } catch (const std::exception&) {  // the same
  }
}

void Recorder::end_as_held() {
  const std::lock_guard lock(taking_);
  if (ended_) return;
  const std::string text = held_ ? held_->summary : running_text(scene_);
  try {
    write_held();
    auto summary = nlohmann::ordered_json::parse(text);
    summary["status"] = "interrupted";
    folder_.write("summary.json", summary.dump(2) + "\n", Reach::kDisk);
  } catch (const std::exception& e) {
    write_last_word(e.what());
    ended_ = true;
    folder_.release();
    throw;
  }
  ended_ = true;
  folder_.release();
}

}  // namespace talus
