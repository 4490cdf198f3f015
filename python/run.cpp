#include "run.h"

#include <pybind11/stl.h>
#include <unistd.h>

#include <cmath>
#include <memory>
#include <optional>
#include <thread>

#include "errors.h"
#include "model.h"
#include "observer.h"
#include "talus/base/text_file.h"
#include "talus/results/opened_run.h"

namespace talus::python {

namespace {

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

struct PyState : StateBytes {
  void write(const std::string& path) const {
    guarded([&] { write_file(path, bytes, Reach::kDisk); });
  }
  static PyState read(const std::string& path) {
    return guarded([&] { return PyState{StateBytes::read(path)}; });
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
      return PyState{{scene().model.file + ", a state in memory",
                      archive_bytes(recorder_ ? recorder_->archive_of(standing, state())
                                              : run_archive(scene(), standing, state()))}};
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

 private:
  void begin(RunNotes notes, const std::string& folder, const py::object& function, int64_t every,
             int threads, bool force, const std::optional<PyState>& from) {
    PreparedRun& prepared = memory->prepared;
    const bool goes_on = from && !folder.empty() && lies_in(from->name, folder);
    std::function<StateBytes()> state;
    if (from) state = [&from] { return *from; };
    OpenedRun opened = [&] {
      py::gil_scoped_release free;
      return open_run(prepared, folder, state, goes_on);
    }();
    std::optional<SavedRun>& saved = opened.saved;
    if (saved && saved->standing.result.stages.size() > prepared.plans.size())
      throw py::value_error("until: that stage had ended when the state was saved");
    if (!folder.empty()) {
      if (!opened.folder) opened.folder.emplace(folder, force);
      folder_ = opened.folder->path().string();
      recorder_ = opened.record(prepared.scene, notes);
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

}  // namespace

void bind_runs(py::module_& m) {
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
          "steps whose contact equations were not solved: error above solver.limit")
      .def_property_readonly(
          "loose_steps", [](const PyResult& r) { return r.result.loose_steps; },
          "steps above solver.tolerance that solver.limit allows")
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
             py::object picture = py::str("");
             if (r.over && !r.folder.empty())
               picture = py::module_::import("talus.run").attr("picture_of")(r.folder);
             return py::str("t = {:.6g} s, {} steps: {}{}{}")
                 .format(r.time, r.steps, r.how(), r.valid ? "" : ", NOT VALID", picture);
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
      .def_property_readonly("stress", &PyRun::stress)
      .def_property_readonly("contacts", &PyRun::contacts);
}

}  // namespace talus::python
