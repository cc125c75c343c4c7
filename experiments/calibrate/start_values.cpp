#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "experiments/calibrate/oscillation_fit.h"

namespace tress::experiments::calibrate {
namespace {

constexpr double negligible = 1e-30;  // in either unit: relative to a value fitted alone
constexpr int tenths = 6;             // number of tenths of gamma tried
constexpr int most_secants = 10;
constexpr double alike = 1e-3;         // relative difference of half periods
const double longest = std::log(4.0);  // step of ln E

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

double half_period(const Record& record, const std::vector<double>& values) {
  const double middle = mean(values), far = 0.3 * rms(values, middle);
  double first = 0, last = 0, crossed = 0;
  int crossings = -1, side = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double x = values[k] - middle;
    if (k > 0 && x * (values[k - 1] - middle) <= 0 && x != values[k - 1] - middle) {
      const double before = values[k - 1] - middle;
      crossed = record.t[k - 1] + (record.t[k] - record.t[k - 1]) * before / (before - x);
    }
    if (std::abs(x) <= far || (x > 0 ? 1 : -1) == side) continue;
    side = x > 0 ? 1 : -1;
    if (crossings == 0) first = crossed;
    last = crossed;
    ++crossings;
  }
  if (crossings < 2) return Estimate::none;
  return (last - first) / (crossings - 1);
}

double start_stiffness(
    const Records& records, const Properties& guess,
    const std::function<std::vector<std::vector<double>>(const Properties&)>& simulate) {
  // Mean of ln(half period simulated over recorded); it falls by 1/2 of ln E.
  const auto lag = [&](double ln_modulus) {
    Properties p = guess;
    p.youngs_modulus = std::exp(ln_modulus);
    const auto values = simulate(p);
    if (values.empty()) return Estimate::none;
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Record& record = records.all[i];
      sum += std::log(half_period(record, values[i]) / half_period(record, record.value));
    }
    return sum / static_cast<double>(values.size());
  };
  double x = std::log(guess.youngs_modulus), off = lag(x), slope = -0.5;
  for (int i = 0; i < most_secants && std::abs(off) > alike; ++i) {
    const double step = std::clamp(-off / slope, -longest, longest);
    const double next = lag(x + step);
    if (std::isnan(next)) break;
    slope = std::min((next - off) / step, -0.05);  // a stiffer strand is faster
    x += step;
    off = next;
  }
  return std::exp(x);
}

Properties start_values(const Records& records, const std::vector<Specimen>& strands,
                        Observed observed, Fitted fitted, double youngs_modulus,
                        const std::function<double(const Properties&)>& misfit) {
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
  const Properties drag{negligible, std::exp(log_nu / count), youngs_modulus};
  if (!fits(fitted, Fitted::gamma)) return drag;

  Properties best{0, drag.nu, youngs_modulus};
  double least = std::numeric_limits<double>::infinity();
  double gamma = 10 * std::exp(log_gamma / count);
  for (int i = 0; i < tenths; ++i, gamma /= 10) {
    const double found = misfit({gamma, negligible, youngs_modulus});
    if (found < least || best.gamma == 0) best.gamma = gamma;
    if (found < least) least = found;
  }
  if (!fits(fitted, Fitted::nu)) return best;
  return {best.gamma / 2, drag.nu / 2, youngs_modulus};
}

}  // namespace tress::experiments::calibrate
