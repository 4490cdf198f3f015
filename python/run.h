#pragma once
// Runs, taken as far as one likes; how they ended; their states.

#include <pybind11/pybind11.h>

namespace talus::python {

/// Result, State and Run.
void bind_runs(pybind11::module_& m);

}  // namespace talus::python
