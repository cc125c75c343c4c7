// Derivatives of runs, and fits.
#include <pybind11/stl.h>

#include <cmath>
#include <map>
#include <optional>

#include "python/bindings/owned_system.h"
#include "simulation/errors/halved_step.h"
#include "simulation/fit/scene_fit.h"
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
  check_derivatives(scene);
  if (names) return gradient_parameters(scene, *names, by_place);
  refuse_if(!scene.tables->gradient, "scene " + scene.name + " has no [gradient]",
            by_place, "give by=[\"youngs_modulus_pa\"], or [gradient] by in the scene");
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

/// (points, jacobian, not_smooth, near_contact_change) of one strand: (F, P, 3), (F, P,
/// 3, K), and a list of F.
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
                        strand.not_smooth, strand.near_contact_change);
}

py::dict gradient(const Scene& scene, bool tip, const Names& names,
                  const std::optional<std::string>& start, int parts) {
  GradientTask task;
  task.parameters = parameters_of(scene, names);
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
                  py::arg("damped") = task.damped, py::arg("moved") = moved,
                  py::arg("error_over_change") = error_over_change(scene));
}

py::dict step_matrices(const Scene& scene, std::size_t strand, double t,
                       std::optional<double> dt, const std::vector<std::string>& names) {
  check_derivatives(scene);
  const auto parameters = gradient_parameters(scene, names, by_place);
  refuse_if(strand >= scene.strands.size(),
            "there is no strand " + std::to_string(strand), "strand",
            "the scene has " + std::to_string(scene.strands.size()) +
                " strands, the first is 0");
  const double step = dt.value_or(scene.options.step);
  refuse_if(!(t >= 0) || !std::isfinite(t), "a step begins at t = 0 or later", "t",
            "give t >= 0, in seconds");
  refuse_if(!(step > 0) || !std::isfinite(step), "the length of a step is above 0", "dt",
            "give dt > 0, in seconds");
  LinearizedStep found;
  {
    const py::gil_scoped_release release;
    found = linearized_step(scene, strand, t, step, parameters);
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

// ---- fits

using Scenes = std::vector<std::shared_ptr<Scene>>;
using Texts = std::vector<std::pair<std::string, std::string>>;  // text, file
using Pairs = std::map<std::string, std::pair<double, double>>;

std::vector<std::string> fitted_names(const Scene& scene, const Names& by) {
  if (by) return *by;
  refuse_if(!scene.tables || !scene.tables->gradient,
            "scene " + scene.name + " does not say what to fit", "by",
            "give by=[\"youngs_modulus_pa\"], or [gradient] by in the scene");
  return simulation::names_of(scene.tables->gradient->values().word("by"));
}

template <class Of>
py::list of_each(const SceneFit& fit, const Of& of) {
  py::list all;
  for (const FittedParameter& one : fit.parameters) all.append(of(one));
  return all;
}

py::array_t<double> numbers(const SceneFit& fit, double FittedParameter::*number) {
  std::vector<double> all;
  for (const FittedParameter& one : fit.parameters) all.push_back(one.*number);
  return copy(all);
}

py::dict as_dict(const SceneFit& fit, const std::vector<PointRecord>& records) {
  py::list measured, fitted;
  for (std::size_t i = 0; i < fit.fitted.size(); ++i) {
    std::vector<double> values;
    for (const Observation& one : records[i].observations) values.push_back(one.value);
    measured.append(copy(values));
    fitted.append(copy(fit.fitted[i]));
  }
  return py::dict(
      py::arg("names") = of_each(fit, [](const auto& one) { return one.name; }),
      py::arg("units") = of_each(fit, [](const auto& one) { return one.unit; }),
      py::arg("values") = numbers(fit, &FittedParameter::value),
      py::arg("low") = numbers(fit, &FittedParameter::low),
      py::arg("high") = numbers(fit, &FittedParameter::high),
      py::arg("profile_low") = numbers(fit, &FittedParameter::profile_low),
      py::arg("profile_high") = numbers(fit, &FittedParameter::profile_high),
      py::arg("step_shift") = numbers(fit, &FittedParameter::step_shift),
      py::arg("elements_shift") = numbers(fit, &FittedParameter::elements_shift),
      py::arg("statuses") = of_each(fit, [](const auto& one) { return one.status; }),
      py::arg("reasons") = of_each(fit, [](const auto& one) { return one.reason; }),
      py::arg("status") = fit.status, py::arg("reason") = fit.reason,
      py::arg("undetermined") = fit.undetermined,
      py::arg("singular_values") = copy(fit.singular), py::arg("rms") = fit.rms,
      py::arg("reduced_chi2") = fit.reduced_chi2,
      py::arg("autocorrelation") = fit.autocorrelation, py::arg("degrees") = fit.degrees,
      py::arg("evaluations") = fit.evaluations, py::arg("measured") = measured,
      py::arg("fitted") = fitted);
}

py::dict fit(const Scenes& scenes, const Texts& texts, const Names& by,
             const Pairs& bounds, const Pairs& priors, double confidence, bool shifts,
             bool profile, const py::object& progress) {
  refuse_if(scenes.empty() || (scenes.size() > 1 && scenes.size() != texts.size()),
            std::to_string(scenes.size()) + " scenes for " +
                std::to_string(texts.size()) + " records",
            "scene", "give one scene for all records, or one for each");
  refuse_if(!(confidence > 0 && confidence < 1), "a confidence is between 0 and 1",
            "confidence", "give 0.95");
  std::vector<PointRecord> records;
  for (const auto& [text, file] : texts)
    records.push_back(parse_point_record(text, file));
  FitTask task;
  for (std::size_t i = 0; i < records.size(); ++i) {
    task.records.push_back({scenes[scenes.size() > 1 ? i : 0].get(), &records[i]});
  }
  task.by = fitted_names(*scenes.front(), by);
  for (const auto& [name, two] : bounds)
    task.bounds.push_back({name, two.first, two.second});
  for (const auto& [name, two] : priors)
    task.priors.push_back({name, two.first, two.second});
  task.confidence = confidence;
  task.shifts = shifts;
  task.profile = profile;
  task.place = "by";
  task.progress = [&](int evaluations, double rms) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!progress.is_none()) progress(evaluations, rms);
  };
  SceneFit found;
  {
    const py::gil_scoped_release release;
    found = fit_scenes(task);
  }
  return as_dict(found, records);
}

}  // namespace

void add_gradients(py::module_& m) {
  m.def("gradient", gradient);
  m.def("linearized_step", step_matrices);
  m.def("fit", fit);
}

}  // namespace tress::python
