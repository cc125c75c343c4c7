// Errors of runs, and what this build is.
#include <pybind11/stl.h>

#include <memory>

#include "python/bindings/owned_system.h"
#include "simulation/errors/error_bars.h"
#include "simulation/files/build_facts.h"

namespace tress::python {
namespace {

using namespace simulation;
using ScenePtr = std::shared_ptr<const Scene>;

/// Returns the error of each strand, and of all strands over the frames.
py::dict values(const ErrorBar& bar) {
  py::list strands;
  for (const StrandError& one : bar.strands) {
    strands.append(
        py::make_tuple(one.error.largest, one.error.rms, one.largest_at, one.parts));
  }
  std::vector<double> largest, rms;
  for (const PointErrors& frame : bar.frames) {
    largest.push_back(frame.largest);
    rms.push_back(frame.rms);
  }
  py::dict all;
  all["strands"] = strands;
  all["largest"] = copy(largest);
  all["rms"] = copy(rms);
  all["missing"] = bar.missing;
  all["finished"] = !bar.unfinished;
  return all;
}

template <class Estimate>
py::dict estimated(const ScenePtr& scene, int threads, const Estimate& estimate) {
  check_error_bars(*scene);
  ErrorBar bar;
  {
    const py::gil_scoped_release release;
    bar = estimate(*scene, threads);
  }
  return values(bar);
}

}  // namespace

void add_errors(py::module_& m) {
  m.def("version_text", [] { return build_facts().described("tress"); });
  m.attr("time_bound") = time_bound;
  m.attr("space_bound") = space_bound;
  m.def("time_error", [](const std::shared_ptr<Scene>& scene, int threads) {
    return estimated(scene, threads, time_error);
  });
  m.def("space_error", [](const std::shared_ptr<Scene>& scene, int threads) {
    return estimated(scene, threads, space_error);
  });
}

}  // namespace tress::python
