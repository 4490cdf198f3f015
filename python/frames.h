#pragma once
// Frames of result folders.

#include <pybind11/pybind11.h>

namespace talus::python {

void bind_frames(pybind11::module_& m);

}  // namespace talus::python
