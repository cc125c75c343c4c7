#include "experiments/problems/strand_reference.h"

#include <stdexcept>
#include <string>

#include "experiments/numerics/tip_track.h"
#include "experiments/problems/formulations.h"
#include "integrators/catalogue.h"

namespace tress::experiments {
namespace {

// Local errors of 1e-5 leave 1e-7 of the length after 2 s, according to the gap.
constexpr double tolerance = 1e-5;

constexpr int steps_per_sample = 8;

// Of order 2 and from different families: the extrapolated sides of a reference.
constexpr std::string_view one_method = "implicit_midpoint",
                           other_method = "generalized_alpha";

constexpr double newton_tolerance = 1e-4;  // corrections below 1e-6 of the length

std::vector<double> tip(const MakeStrand& make, std::string_view model, int elements,
                        std::string_view integrator, Options options,
                        const TipSampling& sampling) {
  const auto system = make(model, elements);
  const auto usable = usable_formulations(find_integrator(integrator), *system);
  if (!usable.empty()) options.formulation = usable.front();
  TipRun run = run_tip(integrator, *system, options, sampling.t_end, sampling.samples);
  if (run.status != Status::ok) {
    throw std::runtime_error("reference of " + std::string(model) + " by " +
                             std::string(integrator) + " failed: " + run.failure);
  }
  return std::move(run.tip);
}

TipsOf tips_of(const MakeStrand& make, const TipSampling& sampling) {
  return [&make, &sampling](std::string_view model, std::string_view integrator,
                            int elements, const Options& options) {
    return tip(make, model, elements, integrator, options, sampling);
  };
}

std::vector<double> in_time(const TipsOf& tips, std::string_view model,
                            std::string_view integrator, const Finest& finest) {
  Options options;
  options.refresh = Refresh::every_step;
  options.newton_tolerance = newton_tolerance;
  options.step = 2 * finest.step;
  const auto coarse = tips(model, integrator, finest.elements, options);
  options.step = finest.step;
  const auto fine = tips(model, integrator, finest.elements, options);
  return extrapolated(coarse, fine, 2);
}

std::vector<double> rod(const TipsOf& tips, std::string_view model,
                        std::string_view integrator, const Finest& finest) {
  const auto half = in_time(tips, model, integrator, {finest.elements / 2, finest.step});
  return extrapolated(half, in_time(tips, model, integrator, finest), 2);
}

TipReference both(std::vector<double> one, std::vector<double> other, double length) {
  const double gap = tip_error(other, one, length);
  return {std::move(one), std::move(other), gap};
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
  // With few elements steps would be too long for the cubic interpolation between them.
  options.max_step = sampling.t_end / sampling.samples / steps_per_sample;
  return both(tip(make, model, elements, "gsl_rk8pd", options, sampling),
              tip(make, model, elements, "cvode_adams", options, sampling),
              sampling.length);
}

TipReference converged_rod(const TipsOf& tips, double length, const RodModels& models,
                           const Finest& finest) {
  return both(rod(tips, models.one, one_method, finest),
              rod(tips, models.other, other_method, finest), length);
}

TipReference extrapolated_model(const TipsOf& tips, double length, std::string_view model,
                                const Finest& finest) {
  return both(in_time(tips, model, one_method, finest),
              in_time(tips, model, other_method, finest), length);
}

TipReference extrapolated_model(const MakeStrand& make, std::string_view model,
                                int elements, const TipSampling& sampling, double step) {
  return extrapolated_model(tips_of(make, sampling), sampling.length, model,
                            {elements, step});
}

TipReference converged_rod(const MakeStrand& make, const TipSampling& sampling,
                           const RodModels& models) {
  return converged_rod(tips_of(make, sampling), sampling.length, models);
}

}  // namespace tress::experiments
