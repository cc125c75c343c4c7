// Derivatives of runs, and fits.
#include <pybind11/stl.h>

#include <optional>

#include "python/bindings/owned_system.h"
#include "simulation/gradient/linearized_step.h"
#include "simulation/gradient/scene_gradient.h"
#include "simulation/scene/strand_tables.h"

namespace tress::python {
namespace {

using namespace simulation;
using Names = std::optional<std::vector<std::string>>;

constexpr const char* by_place = "by";

/// The named parameters, or those of the scene's own [gradient].
std::vector<SceneParameter> parameters_of(const Scene& scene, const Names& names) {
  if (names) return gradient_parameters(scene, *names, by_place);
  check_gradient(scene);
  return gradient_parameters(scene);
}

std::string start_of(const Scene& scene, const std::optional<std::string>& start) {
  if (start) return *start;
  if (!scene.tables->gradient) return "auto";
  return std::string(scene.tables->gradient->values().word("start"));
}

std::vector<std::string> names_of(std::span<const SceneParameter> parameters) {
  std::vector<std::string> all;
  for (const SceneParameter& one : parameters) all.push_back(one.name);
  return all;
}

std::vector<std::string> units_of(std::span<const SceneParameter> parameters) {
  std::vector<std::string> all;
  for (const SceneParameter& one : parameters) all.push_back(one.unit);
  return all;
}

py::array_t<double> values_of(std::span<const SceneParameter> parameters) {
  std::vector<double> all;
  for (const SceneParameter& one : parameters) all.push_back(one.value);
  return copy(all);
}

py::ssize_t length(std::size_t size) { return static_cast<py::ssize_t>(size); }

/// The points asked for: all, or the last one.
struct Asked {
  std::size_t from, to;  // numbers
};
Asked asked(const std::vector<double>& points, bool tip) {
  return {tip ? points.size() - 3 : 0, points.size()};
}

/// (points, jacobian, not_smooth) of one strand: (F, P, 3) and (F, P, 3, K).
py::tuple arrays_of(const StrandGradient& strand, bool tip) {
  std::vector<double> points, by;
  for (std::size_t f = 0; f < strand.points.size(); ++f) {
    const auto [from, to] = asked(strand.points[f], tip);
    for (std::size_t i = from; i < to; ++i) {
      points.push_back(strand.points[f][i]);
      for (const auto& column : strand.by) by.push_back(column[f][i]);
    }
  }
  const py::ssize_t frames = length(strand.points.size());
  return py::make_tuple(copy(points, {frames, -1, 3}),
                        copy(by, {frames, -1, 3, length(strand.by.size())}),
                        strand.not_smooth);
}

py::dict gradient(const Scene& scene, bool tip, const Names& names,
                  const std::optional<std::string>& start, int parts) {
  GradientTask task;
  task.parameters = parameters_of(scene, names);
  check_derivatives(scene, by_place);
  task.damped = starts_damped(start_of(scene, start), task.parameters);
  task.times = times_of_frames(scene);
  task.parts = parts;
  py::list strands;
  double moved = 0;
  for (std::size_t k = 0; k < scene.strands.size(); ++k) {
    StrandGradient found;
    {
      const py::gil_scoped_release release;
      found = strand_gradient(scene, k, task);
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!found.unfinished.empty()) {
      throw SolveError("gradient of strand " + std::to_string(k) + ": " +
                       found.unfinished);
    }
    moved = std::max(moved, found.moved);
    strands.append(arrays_of(found, tip));
  }
  return py::dict(py::arg("times") = copy(task.times), py::arg("strands") = strands,
                  py::arg("names") = names_of(task.parameters),
                  py::arg("units") = units_of(task.parameters),
                  py::arg("parameters") = values_of(task.parameters),
                  py::arg("damped") = task.damped, py::arg("moved") = moved);
}

py::dict step_matrices(const Scene& scene, std::size_t strand, double t,
                       std::optional<double> dt, const std::vector<std::string>& names) {
  const auto parameters = gradient_parameters(scene, names, by_place);
  refuse_if(strand >= scene.strands.size(),
            "there is no strand " + std::to_string(strand), "strand",
            "the scene has " + std::to_string(scene.strands.size()) +
                " strands, the first is 0");
  const double step = dt.value_or(scene.options.step);
  refuse_if(!(t >= 0) || !(step > 0), "a step begins at t >= 0 and has a length above 0",
            "linearized_step", "give t >= 0 and dt > 0, in seconds");
  LinearizedStep found;
  {
    const py::gil_scoped_release release;
    found = linearized_step(scene, strand, t, step, parameters, "linearized_step");
  }
  if (!found.unfinished.empty()) throw SolveError(found.unfinished);
  const py::ssize_t states = length(2 * found.q.size());
  return py::dict(
      py::arg("A") = copy(found.by_state, {states, states}),
      py::arg("B") = copy(found.by_parameters, {states, length(parameters.size())}),
      py::arg("names") = names_of(parameters), py::arg("units") = units_of(parameters),
      py::arg("t") = found.t, py::arg("t_next") = found.t_next,
      py::arg("q") = copy(found.q), py::arg("v") = copy(found.v),
      py::arg("q_next") = copy(found.q_next), py::arg("v_next") = copy(found.v_next));
}

}  // namespace

void add_gradients(py::module_& m) {
  m.def("gradient", gradient);
  m.def("linearized_step", step_matrices);
}

}  // namespace tress::python
