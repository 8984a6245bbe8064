// Repose: the module, its exception and its version.
#include "module.h"

std::string json_of(const py::object& value) {
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  return py::module_::import("json").attr("dumps")(value).cast<std::string>();
}

namespace {

/// repose.Error with status, key and place.
void translate(std::exception_ptr thrown, PyObject* type) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const repose::Error& error) {
    const py::object made = py::reinterpret_borrow<py::object>(type)(error.what());
    made.attr("status") = error.status();
    made.attr("key") = error.key();
    made.attr("place") = error.place();
    PyErr_SetObject(type, made.ptr());
  }
}

}  // namespace

PYBIND11_MODULE(repose, module) {
  module.doc() =
      "Sand by the Material Point Method. Units are SI: m, s, kg, N, Pa; angles are in degrees. See "
      "docs/embedding.md.";
  const std::uint32_t version = repose_version();
  module.attr("__version__") = std::to_string(version / 1000000) + "." + std::to_string(version / 1000 % 1000) +
                               "." + std::to_string(version % 1000);
  static PyObject* const error =
      PyErr_NewExceptionWithDoc("repose.Error",
                                "What was refused: the message, and as attributes status (as the exit codes of "
                                "the command), key and place.",
                                PyExc_RuntimeError, nullptr);
  module.attr("Error") = py::handle(error);
  py::register_exception_translator([](std::exception_ptr thrown) { translate(thrown, error); });
  define_scene(module);
  define_engine(module);
}
