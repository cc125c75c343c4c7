#include "experiments/cost_of_accuracy/reference_side.h"

#include <fmt/format.h>

#include <stdexcept>

namespace tress::experiments::cost_of_accuracy {
namespace {

/// Steps of a frame; beyond it a run is given up.
constexpr long most_steps = 20000;

}  // namespace

MethodChoice side_choice(std::vector<std::string> models,
                         std::vector<std::string> integrators) {
  return {.models = std::move(models),
          .integrators = std::move(integrators),
          .options = {"none"},
          .fixed_steps = false,
          .extrapolated = false};
}

std::optional<Method> side_method(const Scene& given, std::string_view model) {
  for (const std::string_view integrator : {"esdirk43", "tr_bdf2"}) {
    const MethodChoice choice =
        side_choice({std::string(model)}, {std::string(integrator)});
    for (const Method& method : methods(given, choice)) {
      if (method.by_tolerance) return method;
    }
  }
  return {};
}

std::vector<double> ReferenceSide::run(const Level& level, double most_s,
                                       std::optional<Change> change) const {
  Scene scene = compared(trial_scene(*given_, method_, level.elements,
                                     {.tolerance = level.tolerance}, comparison_->rate),
                         *comparison_);
  scene.options.max_step = 1 / comparison_->rate;
  scene.options.max_steps = most_steps;
  if (change) scene = changed(std::move(scene), *change);
  return compared_paths(scene, *comparison_, {.wall_s = most_s}).x;
}

void ReferenceSide::refine(const Level& level, double most_s) {
  try {
    std::vector<double> x = run(level, most_s);
    if (!fine_.empty()) {
      std::vector<double> limit = x;
      const double factor = extrapolation(method_, level.elements);
      for (std::size_t i = 0; i < x.size(); ++i) limit[i] += factor * (x[i] - fine_[i]);
      change_ = limit_.empty() ? never : compared_error(limit, limit_, *comparison_);
      limit_ = std::move(limit);
      coarse_ = std::move(fine_);
      coarse_level_ = fine_level_;
    }
    fine_ = std::move(x);
    fine_level_ = level;
  } catch (const std::runtime_error& failure) {  // including refusals
    failure_ = fmt::format("{}: {}", model(), failure.what());
    ++failures_;
    fine_.clear();
  }
}

std::vector<double> ReferenceSide::moved(Change change, double most_s) const {
  std::vector<double> x = run(coarse_level_, most_s, change);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] -= coarse_[i];
  return x;
}

}  // namespace tress::experiments::cost_of_accuracy
