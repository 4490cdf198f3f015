// The extension of the Python package. What can be written in Python is (talus/*.py); docs/python.md is for its users.

#include "arrays.h"
#include "frames.h"
#include "model.h"
#include "observer.h"
#include "run.h"

PYBIND11_MODULE(_talus, m) {
  using namespace talus::python;
  m.doc() = "Blocks that move, slip and break under dynamic load: the library behind the package talus.";
  m.attr("__version__") = std::string(talus::kVersion);
  bind_models(m);
  bind_views(m);
  bind_instants(m);
  bind_runs(m);
  bind_frames(m);
}
