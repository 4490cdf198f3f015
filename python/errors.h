#pragma once
// What the library throws, as the exceptions of talus/errors.py.

#include <pybind11/pybind11.h>

#include <string>

#include "talus/base/error.h"
#include "talus/schema/findings.h"

namespace talus::python {

namespace py = pybind11;

/// @param name  of the exception; `findings` are those of an InputError
[[noreturn]] void raise(const char* name, const std::string& text, const py::object& findings = py::none());

/// A list of Finding.
py::list told(const Findings& findings, const std::string& file);

/// Calls `what` and passes on what it throws; `findings()` gives those of an InputError.
template <class What, class Told>
auto guarded(const What& what, const Told& findings) {
  try {
    return what();
  } catch (const InputError& e) {
    raise("InputError", e.what(), findings());
  } catch (const FileError& e) {
    raise("FileError", e.what());
  } catch (const NumericalError& e) {
    raise("NumericalError", e.what());
  } catch (const Error& e) {
    raise("Error", e.what());
  }
}
template <class What>
auto guarded(const What& what) {
  return guarded(what, [] { return py::none(); });
}

}  // namespace talus::python
