#include "observer.h"

namespace talus::python {

namespace {

struct PyInstant : Views {
  const Instant* now = nullptr;  // while the observer is called

  const Instant& instant() const {
    if (!now)
      throw py::value_error(
          "an instant is over once the observer has returned; views of its arrays stay valid");
    return *now;
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

}  // namespace

void PyObserver::at(const Instant& now) {
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

bool PyObserver::stop() {
  if (const auto now = std::chrono::steady_clock::now(); now - asked_ > std::chrono::milliseconds(50)) {
    asked_ = now;
    py::gil_scoped_acquire hold;
    if (PyErr_CheckSignals() != 0) error_ = std::make_unique<py::error_already_set>(), stopped_ = true;
  }
  return stopped_ || (next_ && next_->stop());
}

void PyObserver::throw_if_error() {
  if (!error_) return;
  py::error_already_set e = std::move(*error_);
  error_.reset();
  throw e;
}

py::dict energy_of(const Energy& e) {
  py::dict out;
  out["kinetic"] = e.kinetic, out["strain"] = e.strain, out["gravity"] = e.gravity,
  out["left_over"] = e.left_over;
  return out;
}

void bind_instants(py::module_& m) {
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
      .def_property_readonly(
          "velocity", [](const PyInstant& i) { return velocity_of(i.instant()); },
          "velocities of the centroids at this instant [m/s], (blocks, 2): a copy")
      .def_property_readonly(
          "stress", [](const PyInstant& i) { return stress_of(i.instant().scene, i.instant().state); },
          "Cauchy stress of each block, tension > 0 [Pa], (blocks, 2, 2): a copy (theory 1.5)")
      .def_property_readonly(
          "contacts", [](const PyInstant& i) { return contacts_of(i.instant().state); },
          "contact points of the step that begins here, open ones too, as a structured array, a copy: block_a, block_b, joint (-1: "
          "none), normal (> 0 pressing) and shear force on a [N], length [m], slip to and fro [m]")
      .def_property_readonly(
          "points", [](const PyInstant& i) { return points_of(i.instant()); },
          "all points at which forces act, as a structured array, a copy: kind (0 contact, 1 glued face, 2 "
          "support, 3 boundary, 4 bolt), state of a joint (0 intact, 1 slipped, 2 open, 3 apart, -1 none), "
          "block_a, block_b (-1: the ground), x, y [m], force_x, force_y on a [N], normal (> 0 pressing), shear "
          "[N], gap, length, slip, slip_left, opening [m]")
      .def_property_readonly(
          "rows", [](const PyInstant& i) { return rows_of(i.instant()); },
          "the equations of the step as the solver left them (theory 4.1), a structured array, a copy: family (0 "
          "glued face, 1 contact, 2 support, 3 boundary, 4 tie, 5 bolt), block_a, block_b, partner (row of the "
          "other end of the face), normal from b into a, impulses [N s], bias [m/s], compliance [1/kg], bounds of the "
          "normal impulse [N s], friction [-], cohesion [N s]")
      .def("__repr__", [](const PyInstant& i) {
        return i.now ? py::str("<talus.Instant t = {:.6g} s, step {}, stage {}>")
                           .format(i.now->state.time, i.now->state.step, i.now->stage)
                     : py::str("<talus.Instant that is over>");
      });
}

}  // namespace talus::python
