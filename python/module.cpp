// The extension of the Python package: models, runs, and what an observer sees of them. What can be written in Python is
// (talus/*.py); docs/python.md is for its users.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <thread>

#include "talus/base/text_file.h"
#include "talus/output/read_vtk.h"
#include "talus/plot/cut_picture.h"
#include "talus/results/check_report.h"
#include "talus/results/cut_model.h"
#include "talus/run/branch.h"
#include "talus/talus.h"

namespace py = pybind11;

namespace {

using namespace talus;

// The exceptions of talus/errors.py.
py::object error_class(const char* name) { return py::module_::import("talus.errors").attr(name); }

[[noreturn]] void raise(const char* name, const std::string& text, const py::object& findings = py::none()) {
  py::object error = error_class(name)(text);
  if (!findings.is_none()) error.attr("findings") = findings;
  PyErr_SetObject(error_class(name).ptr(), error.ptr());
  throw py::error_already_set();
}

// What the library throws, as exceptions of the package; `findings` gives those of an InputError.
template <class What, class Told>
auto guarded(const What& what, const Told& findings) {
  try {
    return what();
  } catch (const InputError& e) {
    raise("InputError", e.what(), findings());
  } catch (const FileError& e) {
    raise("FileError", e.what());
  } catch (const NumericalError& e) {
    raise("NumericalError", e.what());
  } catch (const Error& e) {
    raise("Error", e.what());
  }
}
template <class What>
auto guarded(const What& what) {
  return guarded(what, [] { return py::none(); });
}

py::list told(const Findings& findings, const std::string& file) {
  py::list list;
  const py::object finding = error_class("Finding");
  for (const Finding& f : findings.list())
    list.append(finding(f.severity == Severity::kError ? "error" : "warning", file, f.where.line,
                        f.where.column, f.key, f.text, f.hint, f.where.override_text));
  return list;
}

py::list corners_of(const Polygon& polygon) {
  py::list corners;
  for (const Vec2 v : polygon) corners.append(py::make_tuple(v.x, v.y));
  return corners;
}

// A model as it was read: each run takes a scene of its own, which stages change.
struct PyModel {
  std::string file, text;
  std::vector<std::string> overrides;
  py::list findings;
  RunNotes notes;

  PreparedRun prepare(Cut* cut = nullptr) {
    Findings found(file, text);
    return guarded(
        [&] {
          PreparedRun run;
          {
            py::gil_scoped_release free;
            run = prepare_run(file, text, overrides, found, cut);
          }
          findings = told(found, file), notes = notes_of(overrides, found);
          return run;
        },
        [&] { return told(found, file); });
  }

  py::dict scene() {
    Cut cut;
    const PreparedRun run = prepare(&cut);
    const Scene& scene = run.scene;
    py::dict out;
    py::list blocks, stages, polygons, steps;
    for (const std::string& name : scene.blocks.name) blocks.append(name);
    for (const StageInput& s : scene.model.stages) stages.append(s.name);
    for (const BlockShape& b : scene.layout.blocks) polygons.append(corners_of(b.polygon));
    for (const StagePlan& p : run.plans) steps.append(p.dt);
    out["title"] = scene.model.title, out["hash"] = scene.model.hash;
    out["blocks"] = blocks, out["stages"] = stages, out["polygons"] = polygons, out["time_steps"] = steps;
    out["mass"] =
        py::array_t<double>(static_cast<py::ssize_t>(scene.blocks.mass.size()), scene.blocks.mass.data());
    return out;
  }

  std::string check() {
    Cut cut;
    const PreparedRun run = prepare(&cut);
    py::gil_scoped_release free;
    return check_report(file, static_cast<int>(notes.warnings.size()), run, cut);
  }

  void picture(const std::string& stem) {
    Cut cut;
    const PreparedRun run = prepare(&cut);
    guarded([&] {
      py::gil_scoped_release free;
      plot::write_cut_picture(run.scene.model, cut, run.scene.layout, stem);
    });
  }
};

// What `talus cut` makes of a model.
struct PyCut {
  CutModel cut;
  py::list findings;

  static std::shared_ptr<PyCut> of(const std::string& file, const std::string& text,
                                   const std::vector<std::string>& overrides) {
    auto out = std::make_shared<PyCut>();
    std::vector<Findings> found;
    const auto all = [&] {
      py::list list;
      for (const Findings& f : found) list += told(f, file);
      return list;
    };
    guarded(
        [&] {
          py::gil_scoped_release free;
          out->cut = cut_model(file, text, overrides, found);
        },
        all);
    out->findings = all();
    return out;
  }
  template <class Of>
  py::list of_blocks(const Of& of) const {
    py::list out;
    for (const BlockShape& b : cut.layout.blocks) out.append(of(b));
    return out;
  }
  void write(const std::string& folder, bool force) const {
    guarded([&] {
      py::gil_scoped_release free;
      check_result_folder(folder, force, ResultKind::kCut);
      ResultFolder out(folder, force, ResultKind::kCut);
      write_cut(cut, out);
    });
  }
  void picture(const std::string& stem) const {
    guarded([&] {
      py::gil_scoped_release free;
      plot::write_cut_picture(cut.model, cut.cut, cut.layout, stem);
    });
  }
};

// What outlives a run: its views point into it.
struct Memory {
  PreparedRun prepared;
  State state;
};

// Numbers of n blocks, of each an array of `shape`, that lie `stride` bytes apart: without a copy; keeps `memory` alive.
py::array view(const std::shared_ptr<Memory>& memory, const void* first, size_t n,
               std::vector<py::ssize_t> shape, py::ssize_t stride) {
  shape.insert(shape.begin(), static_cast<py::ssize_t>(n));
  std::vector<py::ssize_t> strides(shape.size(), sizeof(double));
  for (size_t k = shape.size() - 1; k > 1; --k) strides[k - 1] = strides[k] * shape[k];
  strides[0] = stride;
  const py::capsule owner(new std::shared_ptr<Memory>(memory),
                          [](void* p) { delete static_cast<std::shared_ptr<Memory>*>(p); });
  py::array out(py::dtype::of<double>(), shape, strides, first, owner);
  py::detail::array_proxy(out.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return out;
}

// The views that a run has from its start to the end of the last of them.
struct Views {
  std::shared_ptr<Memory> memory;

  const State& state() const { return memory->state; }
  py::array displacement() const {
    return view(memory, state().displacement.data(), state().displacement.size(), {2}, sizeof(Vec2));
  }
  py::array strain_part() const {
    return view(memory, state().strain_part.data(), state().strain_part.size(), {2, 2}, sizeof(Mat2));
  }
  py::array rate() const {
    const auto& r = state().rate;
    return view(memory, r.empty() ? nullptr : &r[0].a, r.size(), {2}, sizeof(BlockRate));
  }
  py::array rate_gradient() const {
    const auto& r = state().rate;
    return view(memory, r.empty() ? nullptr : &r[0].G, r.size(), {2, 2}, sizeof(BlockRate));
  }
};

// Contact points and rows as records of NumPy.
struct ContactRecord {
  int32_t block_a, block_b, joint;
  double normal, shear, length, slip;
};
struct PointRecord {
  int32_t kind, state, block_a, block_b;
  double x, y, force_x, force_y, normal, shear, gap, length, slip, slip_left, opening;
};
struct RowRecord {
  int32_t family, block_a, block_b, partner;
  double normal_x, normal_y, impulse_normal, impulse_shear, bias_normal, bias_shear, compliance_normal,
      compliance_shear, lower, upper, friction, cohesion;
};

template <class Record>
py::array_t<Record> records(const std::vector<Record>& of) {
  py::array_t<Record> out(static_cast<py::ssize_t>(of.size()));
  std::copy(of.begin(), of.end(), out.mutable_data());
  return out;
}

py::array_t<ContactRecord> contacts_of(const State& state) {
  std::vector<ContactRecord> rows;
  rows.reserve(state.contacts.size());
  for (const Contact& c : state.contacts)
    rows.push_back({c.key.block_a, c.key.block_b, c.joint, c.force[0], c.force[1], c.length, c.slip});
  return records(rows);
}

py::array_t<double> matrices(size_t n, const std::function<Mat2(size_t)>& of) {
  py::array_t<double> out(
      {static_cast<py::ssize_t>(n), static_cast<py::ssize_t>(2), static_cast<py::ssize_t>(2)});
  double* to = out.mutable_data();
  for (size_t k = 0; k < n; ++k) {
    const Mat2 m = of(k);
    *to++ = m.xx, *to++ = m.xy, *to++ = m.yx, *to++ = m.yy;
  }
  return out;
}

py::array_t<double> stress_of(const Scene& scene, const State& state) {
  return matrices(state.displacement.size(),
                  [&](size_t k) { return cauchy_stress(scene.blocks, state, static_cast<int>(k)); });
}

py::dict energy_of(const Energy& e) {
  py::dict out;
  out["kinetic"] = e.kinetic, out["strain"] = e.strain, out["gravity"] = e.gravity,
  out["left_over"] = e.left_over;
  return out;
}

struct PyInstant : Views {
  const Instant* now = nullptr;  // while the observer is called

  const Instant& instant() const {
    if (!now)
      throw py::value_error(
          "an instant is over once the observer has returned; views of its arrays stay valid");
    return *now;
  }
  py::array velocity() const {
    const Instant& i = instant();
    py::array_t<double> out({static_cast<py::ssize_t>(i.state.rate.size()), static_cast<py::ssize_t>(2)});
    double* to = out.mutable_data();
    for (size_t k = 0; k < i.state.rate.size(); ++k) {
      const Vec2 a = rate_now(i.work, i.state, k).a;
      *to++ = a.x, *to++ = a.y;
    }
    return out;
  }
  py::array points() const {
    std::vector<PointRecord> rows;
    for (const FramePoint& p : frame_points(instant().scene, instant()))
      rows.push_back({p.kind, p.state, p.block_a, p.block_b, p.point.x, p.point.y, p.force.x, p.force.y,
                      p.normal_force, p.shear_force, p.gap, p.length, p.slip, p.slip_signed, p.opening});
    return records(rows);
  }
  py::array rows() const {
    const RowSet& set = instant().work.rows;
    std::vector<RowRecord> rows;
    for (size_t k = 0; k < set.size(); ++k) {
      const PointRows& p = set.points[k];
      rows.push_back({static_cast<int32_t>(set.owner[k].family), p.block_a, p.block_b, p.partner, p.normal.x,
                      p.normal.y, set.impulse[k][0], set.impulse[k][1], p.row[0].bias, p.row[1].bias,
                      p.row[0].compliance, p.row[1].compliance, p.lower, p.upper, p.friction, p.cohesion});
    }
    return records(rows);
  }
};

// False of Python or of NumPy; anything else goes on.
bool is_false(const py::object& answer) {
  if (answer.ptr() == Py_False) return true;
  if (answer.is_none() || answer.ptr() == Py_True) return false;
  // kept to the end of the interpreter, and beyond
  static const py::handle numpy_bool = py::object(py::module_::import("numpy").attr("bool_")).release();
  return py::isinstance(answer, numpy_bool) && PyObject_IsTrue(answer.ptr()) == 0;
}

// Shows a Python function the instants, and hears Ctrl-C.
class PyObserver : public Observer {
 public:
  PyObserver(std::shared_ptr<Memory> memory, py::object function, int64_t every, Observer* next)
      : memory_(std::move(memory)), function_(std::move(function)), every_(every), next_(next) {
    const State& s = memory_->state;
    displacement_ = s.displacement.data(), strain_part_ = s.strain_part.data(), rate_ = s.rate.data();
  }

  void stage_begins(const Scene& scene, int stage, const StagePlan& plan) override {
    if (next_) next_->stage_begins(scene, stage, plan);
  }
  void at(const Instant& now) override {
    // views point here; a run that moved its numbers elsewhere would leave them behind. (The last instant of a stage is shown
    // by a copy whose blocks are where they are.)
    const State& own = memory_->state;
    if (own.displacement.data() != displacement_ || own.strain_part.data() != strain_part_ ||
        own.rate.data() != rate_)
      throw Error(kExitInternal, "the numbers of the run lie elsewhere than its views");
    if (next_) next_->at(now);
    if (!listens_ || stopped_ || !(now.state.step % every_ == 0 || now.last)) return;
    py::gil_scoped_acquire hold;
    const auto instant = std::make_shared<PyInstant>(PyInstant{{memory_}, &now});
    try {
      if (is_false(function_(instant))) stopped_ = true;
    } catch (py::error_already_set& e) {
      error_ = std::make_unique<py::error_already_set>(e);
      stopped_ = true;
    }
    instant->now = nullptr;
  }
  void fails(const Instant& now) override {
    if (next_) next_->fails(now);
  }
  bool stop() override {
    if (const auto now = std::chrono::steady_clock::now(); now - asked_ > std::chrono::milliseconds(50)) {
      asked_ = now;
      py::gil_scoped_acquire hold;
      if (PyErr_CheckSignals() != 0) error_ = std::make_unique<py::error_already_set>(), stopped_ = true;
    }
    return stopped_ || (next_ && next_->stop());
  }
  bool wants_state() override { return next_ && next_->wants_state(); }
  bool wants_copy() override { return next_ && next_->wants_copy(); }
  void hold_state(const Standing& standing, const State& state) override {
    if (next_) next_->hold_state(standing, state);
  }
  void keep_state(const Standing& standing, const State& state) override {
    if (next_) next_->keep_state(standing, state);
  }

  // From any thread.
  void interrupt() { stopped_ = true; }
  // No more calls, nor results: of a run that is over.
  void mute() { listens_ = false; }
  void leave_results() { next_ = nullptr; }
  // Passes on what the function has thrown, or KeyboardInterrupt. With the GIL.
  void throw_if_error() {
    if (!error_) return;
    py::error_already_set e = std::move(*error_);
    error_.reset();
    throw e;
  }

 private:
  std::shared_ptr<Memory> memory_;
  py::object function_;
  int64_t every_;
  Observer* next_;
  const Vec2* displacement_ = nullptr;
  const Mat2* strain_part_ = nullptr;
  const BlockRate* rate_ = nullptr;
  bool listens_ = !function_.is_none();
  std::atomic<bool> stopped_ = false;
  std::unique_ptr<py::error_already_set> error_;
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
};

struct PyResult : Views {
  RunResult result;
  std::string folder;
  bool valid = true;  // by the audit, where there was one
  bool over = false;
  int64_t steps = 0;
  double time = 0;  // [s]

  const char* how() const {
    return !result.failure.empty() ? "failed" : result.interrupted ? "stopped" : over ? "ended" : "goes on";
  }
  py::list stages() const {
    py::list out;
    for (const StageResult& s : result.stages) {
      py::dict stage;
      stage["name"] = s.name, stage["steps"] = s.steps, stage["begin"] = s.begin, stage["end"] = s.end;
      stage["time_step"] = s.plan.dt, stage["at_rest"] = s.at_rest;
      out.append(stage);
    }
    return out;
  }
};

// A saved state: the bytes of its file.
struct PyState {
  std::string name, bytes;

  void write(const std::string& path) const {
    guarded([&] { write_file(path, bytes, Reach::kDisk); });
  }
  static PyState read(const std::string& path) {
    return guarded([&] {
      constexpr size_t kMost = size_t{1} << 40;
      return PyState{path, read_text_file(path, kMost)};
    });
  }
};

// A run that is taken as far as its caller likes.
class PyRun : public Views {
 public:
  PyRun(PyModel& model, const py::object& folder, const py::object& function, int64_t every, int threads,
        const std::string& until, bool force, const std::optional<PyState>& from)
      : Views{std::make_shared<Memory>()} {
    if (every < 1) throw py::value_error("every: 1 or more steps from call to call");
    if (threads < 0 || threads > 1024) throw py::value_error("threads: from 0, as many as pay, to 1024");
    PreparedRun& prepared = memory->prepared;
    prepared = model.prepare();
    if (!until.empty()) {
      const size_t stages = stages_until(prepared.scene.model, until);
      if (stages == 0)
        throw py::value_error("until: there is no stage \"" + until + "\"; Model.stages has their names");
      end_after(prepared, stages);
    }
    const std::string name = folder.is_none() ? "" : py::str(folder).cast<std::string>();
    guarded([&] { begin(model.notes, name, function, every, threads, force, from); });
  }
  ~PyRun() {
    if (elsewhere()) {
      // a copy of the process that it belongs to: its threads are not here, and its results are not ours
      run_.release(), observer_.release(), recorder_.release();
      return;
    }
    try {
      if (!ended_) observer_->mute(), finish();
    } catch (...) {  // whoever wants to know calls finish()
    }
  }
  PyRun(const PyRun&) = delete;
  PyRun& operator=(const PyRun&) = delete;

  bool advance(const py::object& steps, const py::object& time, bool stage_end) {
    Pause pause;
    if (!steps.is_none()) pause.steps = steps.cast<int64_t>();
    if (!time.is_none()) pause.time = time.cast<double>();
    pause.stage_end = stage_end;
    if (pause.steps < 0) throw py::value_error("steps: 0 or more");
    if (std::isnan(pause.time)) throw py::value_error("time: a number of seconds");
    take([&] { run_->advance(pause); });
    return !over();
  }
  // Asks it to end after the step that is under way. From any thread.
  void interrupt() { observer_->interrupt(); }
  bool busy() const { return busy_; }

  std::shared_ptr<PyResult> finish() {
    if (!ended_) take([&] { run_->stop(); });
    return result();
  }

  std::shared_ptr<PyResult> result() const {
    check_still();
    auto out = std::make_shared<PyResult>();
    out->memory = memory, out->result = run_->result(), out->folder = folder_, out->valid = valid_;
    out->over = over(), out->steps = state().step, out->time = state().time;
    if (ended_ && !run_->over()) out->result.interrupted = true;  // by an error of files
    return out;
  }

  PyState save() {
    if (busy_)
      throw py::value_error(
          "a run saves no state from within its observer, nor while another thread takes it on");
    if (run_->result().stages.empty()) advance(py::int_(0), py::none(), false);
    busy_ = true, stepping_ = std::this_thread::get_id();
    const auto done = std::shared_ptr<void>(nullptr, [this](void*) { busy_ = false; });
    return guarded([&] {
      py::gil_scoped_release free;
      const Standing standing = run_->standing();
      return PyState{scene().model.file + ", a state in memory",
                     archive_bytes(recorder_ ? recorder_->archive_of(standing, state())
                                             : run_archive(scene(), standing, state()))};
    });
  }

  const Scene& scene() const { return memory->prepared.scene; }
  bool over() const { return ended_ || run_->over(); }
  py::array contacts() const {
    check_still();
    return contacts_of(state());
  }
  py::array stress() const {
    check_still();
    return stress_of(scene(), state());
  }
  std::string stage() const {
    check_still();
    const auto& stages = run_->result().stages;
    return stages.empty() ? "" : stages.back().name;
  }
  const std::string& folder() const { return folder_; }

 private:
  void begin(RunNotes notes, const std::string& folder, const py::object& function, int64_t every,
             int threads, bool force, const std::optional<PyState>& from) {
    PreparedRun& prepared = memory->prepared;
    std::optional<SavedRun> saved;
    std::optional<ResultFolder> results;
    const bool goes_on = from && !folder.empty() && lies_in(from->name, folder);
    {
      py::gil_scoped_release free;
      if (goes_on) {
        // taken before the state is read: who is about to write into the folder must not do so meanwhile
        results.emplace(ResultFolder::go_on(folder));
        saved.emplace(saved_run_of(from->name, parse_archive(from->name, from->bytes), prepared));
        Recorder::check(*results, prepared.scene, saved->archive);
      } else if (from) {
        saved.emplace(branch_of(from->name, from->bytes, prepared, notes.branch.emplace()));
      }
    }
    if (saved && saved->standing.result.stages.size() > prepared.plans.size())
      throw py::value_error("until: that stage had ended when the state was saved");
    if (!folder.empty() && !results) results.emplace(folder, force);
    if (results) {
      folder_ = results->path().string();
      try {
        recorder_ =
            goes_on ? std::make_unique<Recorder>(prepared.scene, std::move(*results), saved->archive, notes)
            : saved ? Recorder::branch_off(prepared.scene, std::move(*results), saved->archive, notes)
                    : std::make_unique<Recorder>(prepared.scene, std::move(*results), notes);
      } catch (const std::exception& e) {
        Recorder::abandon_begun(folder_, e.what());
        throw;
      }
    }
    memory->state = saved ? std::move(saved->state) : start_state(prepared.scene);
    observer_ = std::make_unique<PyObserver>(memory, function, every, recorder_.get());
    py::gil_scoped_release free;
    const Workers workers(threads > 0 ? threads : threads_for(prepared.scene.blocks.count));
    run_ = std::make_unique<StagedRun>(prepared.scene, prepared.plans, memory->state, *observer_, workers,
                                       saved ? &saved->standing : nullptr);
  }

  // Goes on by `what`, and ends what has come to its end.
  template <class What>
  void take(const What& what) {
    if (elsewhere()) throw py::value_error("the run belongs to the process that has begun it");
    if (busy_) throw py::value_error("a run is taken on by one caller at a time, and not by its observer");
    if (ended_) return;
    busy_ = true, stepping_ = std::this_thread::get_id();
    try {
      guarded([&] {
        py::gil_scoped_release free;
        what();
        if (!run_->over()) return;
        ended_ = true;
        if (recorder_) recorder_->finish(run_->result());
      });
    } catch (const std::exception& e) {
      busy_ = false, ended_ = true;
      if (recorder_) recorder_->abandon(e.what());
      leave_folder();
      throw;
    }
    busy_ = false;
    if (!ended_) return;
    if (recorder_)
      if (const auto audit = recorder_->audit()) valid_ = audit->valid();
    leave_folder();
    observer_->throw_if_error();
    if (!run_->result().failure.empty()) raise("NumericalError", run_->result().failure);
  }

  bool elsewhere() const { return getpid() != process_; }
  // What changes its size while a step is taken can be read between steps, and by the observer.
  void check_still() const {
    if (busy_ && stepping_ != std::this_thread::get_id())
      throw py::value_error(
          "another thread takes the run on: look at it between its steps, or by its observer");
  }

  // Others may take it, while this one is still looked at.
  void leave_folder() {
    observer_->leave_results();
    recorder_.reset();
  }

  std::string folder_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<PyObserver> observer_;
  std::unique_ptr<StagedRun> run_;
  bool busy_ = false, ended_ = false, valid_ = true;
  std::thread::id stepping_;  // who has it while it is busy
  pid_t process_ = getpid();
};

// A frame of a result folder: its arrays by name, (points or blocks, components).
py::tuple frame(const std::string& path) {
  const VtkFrame f = guarded([&] {
    py::gil_scoped_release free;
    return read_vtk(path);
  });
  py::dict arrays;
  for (const auto& [name, a] : f.arrays) {
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(a.tuples())};
    if (a.components > 1) shape.push_back(a.components);
    arrays[py::str(name)] = py::array_t<double>(shape, a.values.data());
  }
  return py::make_tuple(f.time, arrays);
}

py::list series(const std::string& pvd) {
  py::list out;
  guarded([&] {
    for (const SeriesEntry& e : read_series(pvd)) out.append(py::make_tuple(e.time, e.file.string()));
  });
  return out;
}

}  // namespace

PYBIND11_MODULE(_talus, m) {
  m.doc() = "Blocks that move, slip and break under dynamic load: the library behind the package talus.";
  m.attr("__version__") = std::string(kVersion);
  PYBIND11_NUMPY_DTYPE(ContactRecord, block_a, block_b, joint, normal, shear, length, slip);
  PYBIND11_NUMPY_DTYPE(PointRecord, kind, state, block_a, block_b, x, y, force_x, force_y, normal, shear, gap,
                       length, slip, slip_left, opening);
  PYBIND11_NUMPY_DTYPE(RowRecord, family, block_a, block_b, partner, normal_x, normal_y, impulse_normal,
                       impulse_shear, bias_normal, bias_shear, compliance_normal, compliance_shear, lower,
                       upper, friction, cohesion);

  py::class_<PyModel, std::shared_ptr<PyModel>>(m, "Model")
      .def(py::init([](std::string file, std::string text, std::vector<std::string> overrides) {
             auto model = std::make_shared<PyModel>(
                 PyModel{std::move(file), std::move(text), std::move(overrides), py::list(), {}});
             model->prepare();
             return model;
           }),
           py::arg("file"), py::arg("text"), py::arg("overrides"))
      .def_readonly("file", &PyModel::file)
      .def_readonly("text", &PyModel::text)
      .def_readonly("overrides", &PyModel::overrides)
      .def_readonly("findings", &PyModel::findings)
      .def("scene", &PyModel::scene)
      .def("check", &PyModel::check)
      .def("picture", &PyModel::picture, py::arg("stem"));

  py::class_<PyCut, std::shared_ptr<PyCut>>(m, "Cut")
      .def(py::init(&PyCut::of), py::arg("file"), py::arg("text"), py::arg("overrides"))
      .def_readonly("findings", &PyCut::findings)
      .def_property_readonly("report", [](const PyCut& c) { return c.cut.report; })
      .def_property_readonly("summary", [](const PyCut& c) { return c.cut.summary; })
      .def_property_readonly(
          "blocks",
          [](const PyCut& c) { return c.of_blocks([](const BlockShape& b) { return py::str(b.name); }); })
      .def_property_readonly("polygons",
                             [](const PyCut& c) {
                               return c.of_blocks([](const BlockShape& b) { return corners_of(b.polygon); });
                             })
      .def_property_readonly("materials",
                             [](const PyCut& c) {
                               return c.of_blocks([&](const BlockShape& b) {
                                 return py::str(c.cut.model.materials[static_cast<size_t>(b.material)].name);
                               });
                             })
      .def("write", &PyCut::write, py::arg("folder"), py::arg("force"))
      .def("picture", &PyCut::picture, py::arg("stem"));

  py::class_<Views, std::shared_ptr<Views>>(
      m, "_Views", "Numbers of blocks that lie in one place from the start of a run on.")
      .def_property_readonly(
          "displacement", &Views::displacement,
          "displacements of the centroids [m], (blocks, 2): a read-only view, not a copy, that goes on with the run and "
          "stays valid after it (theory 1.1)")
      .def_property_readonly(
          "strain_part", &Views::strain_part,
          "deformation gradients F - I [-], (blocks, 2, 2): a view as displacement (theory 1.1)")
      .def_property_readonly(
          "rate", &Views::rate,
          "velocities of the centroids half a step on [m/s], (blocks, 2): of an instant in the middle of the step that follows (of the "
          "last one: before), between steps in the middle of the one before; a view as displacement (theory 2.1)")
      .def_property_readonly(
          "rate_gradient", &Views::rate_gradient,
          "rates of the deformation gradients then [1/s], (blocks, 2, 2); of blocks that do not deform the spin matrix: a "
          "view as displacement");

  py::class_<PyInstant, Views, std::shared_ptr<PyInstant>>(
      m, "Instant", "What an observer is called with: one instant of a run.")
      .def_property_readonly(
          "time", [](const PyInstant& i) { return i.instant().state.time; }, "time [s]")
      .def_property_readonly(
          "step", [](const PyInstant& i) { return i.instant().state.step; }, "steps completed")
      .def_property_readonly(
          "stage", [](const PyInstant& i) { return i.instant().stage; }, "index of the stage")
      .def_property_readonly(
          "last", [](const PyInstant& i) { return i.instant().last; }, "whether no step follows")
      .def_property_readonly(
          "energy", [](const PyInstant& i) { return energy_of(i.instant().report.energy); },
          "kinetic, strain, work of gravity since the start, and what the ledger cannot explain [J]")
      .def_property_readonly(
          "unbalanced", [](const PyInstant& i) { return i.instant().report.unbalanced; },
          "largest unbalanced force of a block / mean force on blocks [-]")
      .def_property_readonly("velocity", &PyInstant::velocity,
                             "velocities of the centroids at this instant [m/s], (blocks, 2): a copy")
      .def_property_readonly(
          "stress", [](const PyInstant& i) { return stress_of(i.instant().scene, i.instant().state); },
          "Cauchy stress of each block, tension > 0 [Pa], (blocks, 2, 2): a copy (theory 1.5)")
      .def_property_readonly(
          "contacts", [](const PyInstant& i) { return contacts_of(i.instant().state); },
          "contact points of the step that begins here, open ones too, as a structured array, a copy: block_a, block_b, joint (-1: "
          "none), normal (> 0 pressing) and shear force on a [N], length [m], slip to and fro [m]")
      .def_property_readonly(
          "points", &PyInstant::points,
          "all points at which forces act, as a structured array, a copy: kind (0 contact, 1 glued face, 2 "
          "support, 3 boundary, 4 bolt), state of a joint (0 intact, 1 slipped, 2 open, 3 apart, -1 none), "
          "block_a, block_b (-1: the ground), x, y [m], force_x, force_y on a [N], normal (> 0 pressing), shear "
          "[N], gap, length, slip, slip_left, opening [m]")
      .def_property_readonly(
          "rows", &PyInstant::rows,
          "the equations of the step as the solver left them (theory 4.1), a structured array, a copy: family (0 "
          "glued face, 1 contact, 2 support, 3 boundary, 4 tie, 5 bolt), block_a, block_b, partner (row of the "
          "other end of the face), normal from b into a, impulses [N s], bias [m/s], compliance [1/kg], bounds of the "
          "normal impulse [N s], friction [-], cohesion [N s]")
      .def("__repr__", [](const PyInstant& i) {
        return i.now ? py::str("<talus.Instant t = {:.6g} s, step {}, stage {}>")
                           .format(i.now->state.time, i.now->state.step, i.now->stage)
                     : py::str("<talus.Instant that is over>");
      });

  py::class_<PyResult, Views, std::shared_ptr<PyResult>>(m, "Result",
                                                         "How a run ended, or how far it has come.")
      .def_property_readonly(
          "steps", [](const PyResult& r) { return r.steps; }, "steps taken")
      .def_property_readonly(
          "time", [](const PyResult& r) { return r.time; }, "time at the end [s]")
      .def_property_readonly(
          "stages", &PyResult::stages,
          "of each stage that has begun: name, steps, begin and end [s], time_step [s], at_rest")
      .def_property_readonly(
          "failed_steps", [](const PyResult& r) { return r.result.failed_steps; },
          "steps whose contact equations were not solved to the tolerance")
      .def_property_readonly(
          "energy", [](const PyResult& r) { return energy_of(r.result.energy); },
          "as of an instant, at the end [J]")
      .def_property_readonly(
          "closure", [](const PyResult& r) { return r.result.closure(); },
          "energy left over / largest term of the ledger [-]")
      .def_property_readonly(
          "interrupted", [](const PyResult& r) { return r.result.interrupted; },
          "whether it was ended before its last step")
      .def_property_readonly(
          "wall_seconds", [](const PyResult& r) { return r.result.wall_seconds; },
          "wall time of the steps [s]")
      .def_property_readonly(
          "failure", [](const PyResult& r) { return r.result.failure; },
          "what ended it, where bad numbers have; \"\" otherwise")
      .def("__repr__",
           [](const PyResult& r) {
             return py::str("<talus.Result t = {:.6g} s, {} steps: {}{}>")
                 .format(r.time, r.steps, r.how(), r.valid ? "" : ", NOT VALID");
           })
      .def("_repr_html_",
           [](const PyResult& r) {
             const py::object picture = py::module_::import("talus.run").attr("picture_of")(r.folder);
             return py::str("t = {:.6g} s, {} steps: {}{}{}")
                 .format(r.time, r.steps, r.how(), r.valid ? "" : ", NOT VALID",
                         r.over && !r.folder.empty() ? picture : py::str(""));
           })
      .def_readonly("folder", &PyResult::folder, "folder of results, \"\" when none was written")
      .def_readonly("valid", &PyResult::valid, "what the audit says; True when nothing was recorded");

  py::class_<PyState>(m, "State", "Where a run stands: it can go on from here, and others can branch off.")
      .def_static("read", &PyState::read, py::arg("path"))
      .def("write", &PyState::write, py::arg("path"))
      .def_readonly("name", &PyState::name)
      .def_property_readonly(
          "size", [](const PyState& s) { return s.bytes.size(); }, "of its file [bytes]")
      .def(py::pickle([](const PyState& s) { return py::make_tuple(s.name, py::bytes(s.bytes)); },
                      [](const py::tuple& t) {
                        return PyState{t[0].cast<std::string>(), t[1].cast<std::string>()};
                      }));

  py::class_<PyRun, Views, std::shared_ptr<PyRun>>(m, "Run")
      .def(py::init<PyModel&, const py::object&, const py::object&, int64_t, int, const std::string&, bool,
                    const std::optional<PyState>&>(),
           py::arg("model"), py::arg("folder"), py::arg("observer"), py::arg("every"), py::arg("threads"),
           py::arg("until"), py::arg("force"), py::arg("state"))
      .def("advance", &PyRun::advance, py::arg("steps"), py::arg("time"), py::arg("stage_end"))
      .def("finish", &PyRun::finish)
      .def("interrupt", &PyRun::interrupt)
      .def_property_readonly("busy", &PyRun::busy)
      .def("save", &PyRun::save)
      .def_property_readonly("result", &PyRun::result)
      .def_property_readonly("time", [](const PyRun& r) { return r.state().time; })
      .def_property_readonly("step", [](const PyRun& r) { return r.state().step; })
      .def_property_readonly("stage", &PyRun::stage)
      .def_property_readonly("over", &PyRun::over)
      .def_property_readonly("folder", &PyRun::folder)
      .def_property_readonly("stress", &PyRun::stress)
      .def_property_readonly("contacts", &PyRun::contacts);

  m.def("frame", &frame, py::arg("path"));
  m.def("series", &series, py::arg("pvd"));
}
