#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "experiments/calibrate/friction_fit.h"

namespace tress::experiments::calibrate {
namespace {

constexpr double negligible = 1e-30;  // in either unit: relative to a value fitted alone
constexpr int tenths = 6;             // number of tenths of gamma tried

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) /
         static_cast<double>(values.size());
}

double rms(std::span<const double> values, double about) {
  double squares = 0;
  for (const double x : values) squares += (x - about) * (x - about);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

double decay_rate(const Record& record, Observed observed) {
  const std::size_t n = record.t.size();
  const std::span<const double> values(record.value);
  const double rest = observed == Observed::displacement ? mean(values) : 0;
  const double early = rms(values.first(n / 2), rest);
  const double late = rms(values.last(n - n / 2), rest);
  const std::span<const double> times(record.t);
  const double apart = mean(times.last(n - n / 2)) - mean(times.first(n / 2));
  return std::max(0.0, std::log(early / late) / apart);
}

Friction friction_start(const Records& records, const std::vector<Specimen>& strands,
                        Observed observed, Fitted fitted,
                        const std::function<double(const Friction&)>& misfit) {
  // Geometric means over the records; one that does not decay counts with a tenth of the
  // decay.
  double log_nu = 0, log_gamma = 0;
  for (std::size_t i = 0; i < strands.size(); ++i) {
    const Record& record = records.all[i];
    const double least = 0.1 / record.t.back();
    const double rate = std::max(decay_rate(record, observed), least);
    const double nu = 2 * rate * strands[i].mass / strands[i].length;
    log_nu += std::log(nu);
    log_gamma += std::log(nu * std::pow(strands[i].length / 1.8751, 4));
  }
  const auto count = static_cast<double>(strands.size());
  const Friction drag{negligible, std::exp(log_nu / count)};
  if (fitted == Fitted::nu) return drag;

  Friction best{0, drag.nu};
  double least = std::numeric_limits<double>::infinity();
  double gamma = 10 * std::exp(log_gamma / count);
  for (int i = 0; i < tenths; ++i, gamma /= 10) {
    const double found = misfit({gamma, negligible});
    if (found < least || best.gamma == 0) best.gamma = gamma;
    if (found < least) least = found;
  }
  if (fitted == Fitted::gamma) return best;
  return {best.gamma / 2, drag.nu / 2};
}

}  // namespace tress::experiments::calibrate
