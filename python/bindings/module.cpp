// tress._core: what python/tress/ is made of.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "contract/parameters.h"
#include "python/bindings/owned_system.h"
#include "simulation/plugin/load_plugin.h"

#ifndef TRESS_VERSION
#define TRESS_VERSION ""
#endif

PYBIND11_MODULE(_core, m) {
  namespace py = pybind11;
  using namespace tress::python;
  m.attr("version") = TRESS_VERSION;
  // With the text that the programs print; tress/__init__.py gives them their parts.
  // Never given back: the interpreter ends before the destructors of this library run.
  static const py::handle errors = py::module_::import("tress.errors").release();
  py::register_local_exception_translator([](std::exception_ptr raised) {
    if (!raised) return;
    try {
      std::rethrow_exception(raised);
    } catch (const tress::InputError& error) {
      PyErr_SetString(errors.attr("InputError").ptr(), error.what());
    } catch (const SolveError& error) {
      PyErr_SetString(errors.attr("SolveError").ptr(), error.what());
    }
  });
  m.def("load_plugin", [](const std::filesystem::path& library) {
    tress::simulation::load_plugin(library.string());
  });
  // Remedy for an unknown name: its present name, or the nearest of those that are known.
  m.def("suggestion", [](const std::string& word, const std::vector<std::string>& known,
                         const std::string& otherwise) {
    const std::vector<std::string_view> names(known.begin(), known.end());
    return tress::suggestion(word, names, otherwise);
  });
  add_systems(m);
  add_integrators(m);
  add_scenes(m);
  add_gradients(m);
  add_errors(m);
}
