#include "experiments/problems/strand_reference.h"

#include <stdexcept>
#include <string>

#include "experiments/numerics/tip_track.h"

namespace tress {
namespace {

// Local errors of 1e-5 leave 1e-7 of the length after 2 s, as the gap of the two shows.
constexpr double tolerance = 1e-5;

constexpr int steps_per_sample = 8;

constexpr double newton_tolerance = 1e-4;  // corrections below 1e-6 of the length

std::vector<double> tip(const MakeStrand& make, std::string_view model, int elements,
                        std::string_view integrator, const Options& options,
                        const TipSampling& sampling) {
  const auto system = make(model, elements);
  TipRun run = run_tip(integrator, *system, options, sampling.t_end, sampling.samples);
  if (run.status != Status::ok) {
    throw std::runtime_error("reference of " + std::string(model) + " by " +
                             std::string(integrator) + " failed: " + run.failure);
  }
  return std::move(run.tip);
}

std::vector<double> rod(const TipsOf& tips, std::string_view model,
                        std::string_view integrator, const Finest& finest) {
  const auto converged_in_time = [&](int elements) {
    Options options;
    options.refresh = Refresh::every_step;
    options.newton_tolerance = newton_tolerance;
    options.step = 2 * finest.step;
    const auto coarse = tips(model, integrator, elements, options);
    options.step = finest.step;
    const auto fine = tips(model, integrator, elements, options);
    return extrapolated(coarse, fine, 2);
  };
  const auto half = converged_in_time(finest.elements / 2);
  return extrapolated(half, converged_in_time(finest.elements), 2);
}

}  // namespace

std::vector<double> extrapolated(In coarse, In fine, double ratio) {
  std::vector<double> limit(fine.begin(), fine.end());
  for (std::size_t i = 0; i < limit.size(); ++i) {
    limit[i] += (fine[i] - coarse[i]) / (ratio * ratio - 1);
  }
  return limit;
}

TipReference converged_model(const MakeStrand& make, std::string_view model, int elements,
                             const TipSampling& sampling) {
  Options options;
  options.rtol = options.atol = tolerance;
  // Of few elements steps would be longer than what the cubic between them follows.
  options.max_step = sampling.t_end / sampling.samples / steps_per_sample;
  TipReference reference;
  reference.tip = tip(make, model, elements, "gsl_rk8pd", options, sampling);
  reference.other = tip(make, model, elements, "cvode_adams", options, sampling);
  reference.gap = tip_error(reference.other, reference.tip, sampling.length);
  return reference;
}

TipReference converged_rod(const TipsOf& tips, double length, const RodModels& models,
                           const Finest& finest) {
  TipReference reference;
  reference.tip = rod(tips, models.one, "implicit_midpoint", finest);
  reference.other = rod(tips, models.other, "generalized_alpha", finest);
  reference.gap = tip_error(reference.other, reference.tip, length);
  return reference;
}

TipReference converged_rod(const MakeStrand& make, const TipSampling& sampling,
                           const RodModels& models) {
  const auto tips = [&](std::string_view model, std::string_view integrator, int elements,
                        const Options& options) {
    return tip(make, model, elements, integrator, options, sampling);
  };
  return converged_rod(tips, sampling.length, models);
}

}  // namespace tress
