// The extension of the Python package: models, runs, and what an observer sees of them. What can be written in Python is
// (talus/*.py); docs/python.md is for its users.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <cstring>
#include <memory>

#include "talus/base/text_file.h"
#include "talus/talus.h"

namespace py = pybind11;

namespace {

using namespace talus;

// The exceptions of talus/errors.py.
py::object error_class(const char* name) { return py::module_::import("talus.errors").attr(name); }

[[noreturn]] void raise(const char* name, const std::string& text, const py::object& findings) {
  py::object error = error_class(name)(text);
  if (!findings.is_none()) error.attr("findings") = findings;
  PyErr_SetObject(error_class(name).ptr(), error.ptr());
  throw py::error_already_set();
}

py::list told(const Findings& findings, const std::string& file) {
  py::list list;
  const py::object finding = error_class("Finding");
  for (const Finding& f : findings.list())
    list.append(finding(f.severity == Severity::kError ? "error" : "warning", file, f.where.line,
                        f.where.column, f.key, f.text, f.hint, f.where.override_text));
  return list;
}

// A model as it was read: each run takes a scene of its own, which stages change.
struct PyModel {
  std::string file, text;
  std::vector<std::string> overrides;
  py::list findings;
  RunNotes notes;

  PreparedRun prepare() {
    Findings found(file, text);
    try {
      PreparedRun run;
      {
        py::gil_scoped_release free;
        run = prepare_run(file, text, overrides, found);
      }
      findings = told(found, file), notes = notes_of(overrides, found);
      return run;
    } catch (const InputError& e) {
      raise("InputError", e.what(), told(found, file));
    } catch (const FileError& e) {
      raise("FileError", e.what(), py::none());
    } catch (const Error& e) {
      raise("Error", e.what(), py::none());
    }
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

// A contact point as a record of NumPy.
struct ContactRow {
  int32_t block_a, block_b, joint;
  double normal, shear, length, slip;
};

struct PyInstant {
  std::shared_ptr<Memory> memory;
  const Instant* now = nullptr;  // while the observer is called

  const Instant& instant() const {
    if (!now)
      throw py::value_error(
          "an instant is over once the observer has returned; views of its arrays stay valid");
    return *now;
  }
  py::array displacement() const {
    const auto& d = memory->state.displacement;
    return view(memory, d.data(), d.size(), {2}, sizeof(Vec2));
  }
  py::array strain_part() const {
    const auto& f = memory->state.strain_part;
    return view(memory, f.data(), f.size(), {2, 2}, sizeof(Mat2));
  }
  py::array velocity() const {
    const Instant& i = instant();
    py::array_t<double> out({static_cast<py::ssize_t>(i.state.rate.size()), static_cast<py::ssize_t>(2)});
    auto v = out.mutable_unchecked<2>();
    for (size_t k = 0; k < i.state.rate.size(); ++k) {
      const Vec2 a = rate_now(i.work, i.state, k).a;
      v(static_cast<py::ssize_t>(k), 0) = a.x, v(static_cast<py::ssize_t>(k), 1) = a.y;
    }
    return out;
  }
  py::array contacts() const {
    const std::vector<Contact>& of = instant().state.contacts;
    py::array_t<ContactRow> out(static_cast<py::ssize_t>(of.size()));
    auto rows = out.mutable_unchecked<1>();
    for (size_t k = 0; k < of.size(); ++k)
      rows(static_cast<py::ssize_t>(k)) = {of[k].key.block_a, of[k].key.block_b, of[k].joint, of[k].force[0],
                                           of[k].force[1],    of[k].length,      of[k].slip};
    return out;
  }
};

// Shows a Python function the instants, and hears Ctrl-C.
class PyObserver : public Observer {
 public:
  PyObserver(std::shared_ptr<Memory> memory, py::object function, int64_t every, Observer* next)
      : memory_(std::move(memory)),
        function_(std::move(function)),
        every_(every),
        next_(next),
        displacement_(memory_->state.displacement.data()),
        strain_part_(memory_->state.strain_part.data()) {}

  void stage_begins(const Scene& scene, int stage, const StagePlan& plan) override {
    if (next_) next_->stage_begins(scene, stage, plan);
  }
  void at(const Instant& now) override {
    // views point here; a run that moved its numbers elsewhere would leave them behind. (The last instant of a stage is shown
    // by a copy whose blocks are where they are.)
    const State& own = memory_->state;
    if (own.displacement.data() != displacement_ || own.strain_part.data() != strain_part_)
      throw Error(kExitInternal, "the numbers of the run lie elsewhere than its views");
    if (next_) next_->at(now);
    if (function_.is_none() || stopped_ || !(now.state.step % every_ == 0 || now.last)) return;
    py::gil_scoped_acquire hold;
    const auto instant = std::make_shared<PyInstant>(PyInstant{memory_, &now});
    try {
      const py::object answer = function_(instant);
      stopped_ = answer.ptr() == Py_False;  // anything else goes on
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
  const Vec2* displacement_;
  const Mat2* strain_part_;
  bool stopped_ = false;
  std::unique_ptr<py::error_already_set> error_;
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
};

struct PyResult {
  std::shared_ptr<Memory> memory;
  RunResult result;
  std::string folder;
  bool valid = true;  // by the audit, where there was one
};

PyResult run(PyModel& model, const py::object& folder, const py::object& function, int64_t every, int threads,
             const std::string& until, bool force) {
  if (every < 1) throw py::value_error("every: 1 or more steps from call to call");
  if (threads < 0 || threads > 1024) throw py::value_error("threads: from 0, as many as pay, to 1024");
  const auto memory = std::make_shared<Memory>();
  memory->prepared = model.prepare();
  Scene& scene = memory->prepared.scene;
  if (!until.empty()) {
    const size_t stages = stages_until(scene.model, until);
    if (stages == 0)
      throw py::value_error("until: there is no stage \"" + until + "\"; Model.stages has their names");
    end_after(memory->prepared, stages);
  }
  PyResult out;
  out.memory = memory;
  std::unique_ptr<Recorder> recorder;
  try {
    if (!folder.is_none()) {
      ResultFolder results(py::str(folder).cast<std::string>(), force);
      out.folder = results.path().string();
      recorder = std::make_unique<Recorder>(scene, std::move(results), model.notes);
    }
    memory->state = start_state(scene);
    PyObserver observer(memory, function, every, recorder.get());
    {
      py::gil_scoped_release free;
      const Workers workers(threads > 0 ? threads : threads_for(scene.blocks.count));
      try {
        out.result = run_stages(scene, memory->prepared.plans, memory->state, observer, workers);
        if (recorder) recorder->finish(out.result);
      } catch (const std::exception& e) {
        if (recorder) recorder->abandon(e.what());
        throw;
      }
    }
    observer.throw_if_error();
  } catch (const FileError& e) {
    raise("FileError", e.what(), py::none());
  } catch (const Error& e) {
    raise("Error", e.what(), py::none());
  }
  if (recorder)
    if (const auto audit = recorder->audit()) out.valid = audit->valid();
  if (!out.result.failure.empty()) raise("NumericalError", out.result.failure, py::none());
  return out;
}

}  // namespace

PYBIND11_MODULE(_talus, m) {
  m.doc() = "Blocks that move, slip and break under dynamic load: the library behind the package talus.";
  m.attr("__version__") = std::string(kVersion);
  PYBIND11_NUMPY_DTYPE(ContactRow, block_a, block_b, joint, normal, shear, length, slip);

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
      .def("_scene",
           [](PyModel& model) {
             const PreparedRun run = model.prepare();
             const Scene& scene = run.scene;
             py::dict out;
             py::list blocks, stages;
             for (const std::string& name : scene.blocks.name) blocks.append(name);
             for (const StageInput& s : scene.model.stages) stages.append(s.name);
             out["title"] = scene.model.title, out["hash"] = scene.model.hash;
             out["blocks"] = blocks, out["stages"] = stages;
             out["mass"] = py::array_t<double>(static_cast<py::ssize_t>(scene.blocks.mass.size()),
                                               scene.blocks.mass.data());
             py::list polygons, steps;
             for (const BlockShape& b : scene.layout.blocks) {
               py::list corners;
               for (const Vec2 v : b.polygon) corners.append(py::make_tuple(v.x, v.y));
               polygons.append(corners);
             }
             for (const StagePlan& p : run.plans) steps.append(p.dt);
             out["polygons"] = polygons, out["time_steps"] = steps;
             return out;
           })
      .def("_run", &run, py::arg("folder"), py::arg("observer"), py::arg("every"), py::arg("threads"),
           py::arg("until"), py::arg("force"));

  py::class_<PyInstant, std::shared_ptr<PyInstant>>(m, "Instant",
                                                    "What an observer is called with: one instant of a run.")
      .def_property_readonly(
          "time", [](const PyInstant& i) { return i.instant().state.time; }, "time [s]")
      .def_property_readonly(
          "step", [](const PyInstant& i) { return i.instant().state.step; }, "steps completed")
      .def_property_readonly(
          "stage", [](const PyInstant& i) { return i.instant().stage; }, "index of the stage")
      .def_property_readonly(
          "last", [](const PyInstant& i) { return i.instant().last; }, "whether no step follows")
      .def_property_readonly(
          "kinetic_energy", [](const PyInstant& i) { return i.instant().report.energy.kinetic; },
          "kinetic energy [J]")
      .def_property_readonly(
          "displacement", &PyInstant::displacement,
          "displacements of the centroids [m], (blocks, 2): a view, not a copy, valid for ever, that goes on "
          "with the run")
      .def_property_readonly("strain_part", &PyInstant::strain_part,
                             "deformation gradients F - I [-], (blocks, 2, 2): a view as displacement")
      .def_property_readonly("velocity", &PyInstant::velocity,
                             "velocities of the centroids at this instant [m/s], (blocks, 2): a copy")
      .def_property_readonly(
          "contacts", &PyInstant::contacts,
          "contact points as a structured array, a copy: block_a, block_b, joint (-1: none), normal and "
          "shear force on a [N], length [m], slip [m]");

  py::class_<PyResult>(m, "Result", "How a run ended.")
      .def_property_readonly(
          "steps", [](const PyResult& r) { return r.memory->state.step; }, "steps taken")
      .def_property_readonly("failed_steps", [](const PyResult& r) { return r.result.failed_steps; })
      .def_property_readonly(
          "closure", [](const PyResult& r) { return r.result.closure(); },
          "energy left over / largest term of the ledger [-]")
      .def_property_readonly(
          "interrupted", [](const PyResult& r) { return r.result.interrupted; },
          "whether the observer ended it")
      .def_property_readonly("wall_seconds", [](const PyResult& r) { return r.result.wall_seconds; })
      .def_property_readonly(
          "time", [](const PyResult& r) { return r.memory->state.time; }, "time at the end [s]")
      .def_property_readonly(
          "displacement",
          [](const PyResult& r) {
            return PyInstant{r.memory, nullptr}.displacement();
          },
          "displacements of the centroids at the end [m], (blocks, 2): a view")
      .def_property_readonly(
          "strain_part",
          [](const PyResult& r) {
            return PyInstant{r.memory, nullptr}.strain_part();
          },
          "F - I at the end [-], (blocks, 2, 2): a view")
      .def_readonly("folder", &PyResult::folder, "folder of results, \"\" when none was written")
      .def_readonly("valid", &PyResult::valid, "what the audit says; True when nothing was recorded");
}
