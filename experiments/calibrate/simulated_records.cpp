#include "experiments/calibrate/simulated_records.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include <memory>

#include "experiments/numerics/tip_signal.h"

namespace tress::experiments::calibrate {
namespace {

struct FreeGenerator {
  void operator()(gsl_rng* generator) const { gsl_rng_free(generator); }
};
using Generator = std::unique_ptr<gsl_rng, FreeGenerator>;

}  // namespace

double weight(const Record& record, std::size_t k) {
  return record.sigma.empty() ? 1 : 1 / (record.sigma[k] * record.sigma[k]);
}

/// Subtracts the weighted mean from values of a record.
void centre(const Record& record, std::vector<double>& values) {
  double sum = 0, weights = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    sum += weight(record, k) * values[k];
    weights += weight(record, k);
  }
  for (double& x : values) x -= sum / weights;
}

std::vector<std::vector<double>> simulated(const Records& records,
                                           const std::vector<BuiltStrand>& strands,
                                           const Watch& watch) {
  // Long enough to complete a swing that extends beyond the last envelope.
  const double longer = watch.observed == Observed::envelope ? 1.25 : 1;
  std::vector<std::vector<double>> all;
  for (std::size_t i = 0; i < records.all.size(); ++i) {
    const Record& record = records.all[i];
    System& system = *strands[i].system;
    Guard guard(system, strands[i].guarded);
    const TipSignal signal = run_tip_signal(watch.integrator, system, watch.options,
                                            watch.axis, longer * record.t.back(), &guard);
    if (signal.status != Status::ok) return {};
    if (watch.observed == Observed::envelope) {
      all.push_back(envelope(signal, record.t));
      if (all.back().empty()) return {};
    } else {
      all.push_back(displacement(signal, record.t));
      centre(record, all.back());
    }
  }
  return all;
}

bool fill_in(Records& records, const std::vector<BuiltStrand>& strands,
             const Watch& watch, const Noise& noise) {
  const auto signals = simulated(records, strands, watch);
  if (signals.empty()) return false;
  const Generator generator(gsl_rng_alloc(gsl_rng_mt19937));
  gsl_rng_set(generator.get(), noise.seed);
  for (std::size_t i = 0; i < signals.size(); ++i) {
    for (const double value : signals[i]) {
      records.all[i].value.push_back(value +
                                     gsl_ran_gaussian(generator.get(), noise.sigma));
    }
  }
  return true;
}

}  // namespace tress::experiments::calibrate
