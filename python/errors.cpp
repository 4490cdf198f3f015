#include "errors.h"

namespace talus::python {

namespace {

py::object error_class(const char* name) { return py::module_::import("talus.errors").attr(name); }

}  // namespace

void raise(const char* name, const std::string& text, const py::object& findings) {
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

}  // namespace talus::python
