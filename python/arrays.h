#pragma once
// Arrays of NumPy: views of what lies in one place for a whole run, and copies of what does not.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>

#include "talus/talus.h"

namespace talus::python {

namespace py = pybind11;

/// What outlives a run: its views point into it.
struct Memory {
  PreparedRun prepared;
  State state;
};

/// The views that a run has from its start to the end of the last of them, which keeps the memory. They cannot be written.
struct Views {
  std::shared_ptr<Memory> memory;

  const State& state() const { return memory->state; }
  py::array displacement() const;   // [blocks, 2] [m]
  py::array strain_part() const;    // [blocks, 2, 2]
  py::array rate() const;           // [blocks, 2] [m/s]
  py::array rate_gradient() const;  // [blocks, 2, 2] [1/s]
};

/// Copies, as structured arrays; what their fields are is told to the users (Instant.contacts, points, rows).
py::array contacts_of(const State& state);
py::array points_of(const Instant& instant);
py::array rows_of(const Instant& instant);
/// Velocities of the centroids at an instant [blocks, 2] [m/s], a copy.
py::array velocity_of(const Instant& instant);
/// Cauchy stress [blocks, 2, 2] [Pa], a copy.
py::array stress_of(const Scene& scene, const State& state);

void bind_views(py::module_& m);

}  // namespace talus::python
