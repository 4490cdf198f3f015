#include "model.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "errors.h"
#include "talus/base/index.h"
#include "talus/plot/cut_picture.h"
#include "talus/results/check_report.h"
#include "talus/results/cut_model.h"

namespace talus::python {

namespace {

py::list corners_of(const Polygon& polygon) {
  py::list corners;
  for (const Vec2 v : polygon) corners.append(py::make_tuple(v.x, v.y));
  return corners;
}

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

}  // namespace

PreparedRun PyModel::prepare(Cut* cut) {
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

py::dict PyModel::scene() {
  Cut cut;
  const PreparedRun run = prepare(&cut);
  const Scene& scene = run.scene;
  py::dict out;
  py::list blocks, stages, polygons, steps;
  for (const std::string& name : scene.blocks.name) blocks.append(name);
  for (const StageInput& s : scene.model.stages) stages.append(s.name);
  for (const BlockShape& b : scene.layout.blocks) polygons.append(corners_of(b.polygon));
  for (const StagePlan& p : run.plans) steps.append(p.dt);
  out["title"] = scene.model.title;
  out["blocks"] = blocks, out["stages"] = stages, out["polygons"] = polygons, out["time_steps"] = steps;
  out["mass"] =
      py::array_t<double>(static_cast<py::ssize_t>(scene.blocks.mass.size()), scene.blocks.mass.data());
  return out;
}

std::string PyModel::check() {
  Cut cut;
  const PreparedRun run = prepare(&cut);
  py::gil_scoped_release free;
  return check_report(file, count_of(notes.warnings), run, cut);
}

void PyModel::picture(const std::string& stem) {
  Cut cut;
  const PreparedRun run = prepare(&cut);
  guarded([&] {
    py::gil_scoped_release free;
    plot::write_cut_picture(run.scene.model, cut, run.scene.layout, stem);
  });
}

void bind_models(py::module_& m) {
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
                                 return py::str(c.cut.model.materials[b.material].name);
                               });
                             })
      .def("write", &PyCut::write, py::arg("folder"), py::arg("force"))
      .def("picture", &PyCut::picture, py::arg("stem"));
}

}  // namespace talus::python
