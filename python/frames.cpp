#include "frames.h"

#include <pybind11/numpy.h>

#include "errors.h"
#include "talus/output/read_vtk.h"

namespace talus::python {

namespace {

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

void bind_frames(py::module_& m) {
  m.def("frame", &frame, py::arg("path"));
  m.def("series", &series, py::arg("pvd"));
}

}  // namespace talus::python
