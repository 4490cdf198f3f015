#pragma once
// Models, and what `talus cut` makes of them.

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "talus/talus.h"

namespace talus::python {

namespace py = pybind11;

/// A model as it was read: each run takes a scene of its own, which stages change.
struct PyModel {
  std::string file, text;
  std::vector<std::string> overrides;
  py::list findings;
  RunNotes notes;

  /// Reads, checks and plans it; findings and notes are those of this reading.
  PreparedRun prepare(Cut* cut = nullptr);
  py::dict scene();
  std::string check();
  /// Writes STEM.svg and STEM.png.
  void picture(const std::string& stem);
};

/// Model and Cut.
void bind_models(py::module_& m);

}  // namespace talus::python
