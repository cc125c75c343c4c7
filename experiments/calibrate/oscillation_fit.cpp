#include "experiments/calibrate/oscillation_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "contract/input_error.h"
#include "simulation/fit/record_runs.h"

namespace tress::experiments::calibrate {
namespace {

// Central differences in the logarithms: at 1e-3 the error is 2e-7 of the third
// derivative, and Newton's tolerance of 1e-10 contributes 1e-7.
constexpr double difference = 1e-3;
constexpr double tolerance = 1e-7;  // of the logarithms

constexpr double too_correlated = 0.99;
constexpr double widest = 2.302585092994046;  // ln 10
constexpr double deviations = 4;  // standard deviations 1/sqrt(n) of an autocorrelation
constexpr int refinement = 2;     // of the step; tolerances by its 4th power
// Halving the step removes half the error of a method of order 1, three quarters for
// order 2: the whole error is then below half a half-interval.
constexpr double largest_shift = 0.25;  // half-intervals

/// One fitted value: its name in messages and its place in the properties and the result.
struct Unknown {
  Fitted one;
  std::string_view name;
  double Properties::*property;
  Estimate OscillationFit::*estimate;
  double most;  // beyond it no strand is built
};
constexpr Unknown known_unknowns[] = {
    {Fitted::stiffness, "stiffness", &Properties::youngs_modulus,
     &OscillationFit::youngs_modulus, 1e14},
    {Fitted::gamma, "gamma", &Properties::gamma, &OscillationFit::gamma, 1e6},
    {Fitted::nu, "nu", &Properties::nu, &OscillationFit::nu, 1e6},
};

/// The logarithms of the fitted values as least-squares unknowns.
class Unknowns {
 public:
  Unknowns(const std::vector<Specimen>& strands, Fitted fitted) : strands_(strands) {
    for (const Unknown& one : known_unknowns) {
      if (fits(fitted, one.one)) fitted_.push_back(one);
    }
  }

  std::size_t count() const { return fitted_.size(); }
  const Unknown& operator[](std::size_t j) const { return fitted_[j]; }

  std::vector<double> of(const Properties& properties) const {
    std::vector<double> x;
    for (const Unknown& one : fitted_) x.push_back(std::log(properties.*one.property));
    return x;
  }
  /// For the first strand; a known value may differ between strands.
  Properties properties(In x) const { return properties(x, strands_.front()); }
  /// Builds the strands with `finer` times the elements. Empty: out of range.
  std::vector<BuiltStrand> strands(In x, int finer) const {
    for (std::size_t j = 0; j < count(); ++j) {
      if (!(std::exp(x[j]) < fitted_[j].most)) return {};
    }
    std::vector<BuiltStrand> all;
    for (const Specimen& one : strands_) {
      all.push_back(one.build(properties(x, one), finer));
    }
    return all;
  }

 private:
  Properties properties(In x, const Specimen& strand) const {
    Properties all = strand.properties;
    for (std::size_t j = 0; j < count(); ++j) all.*fitted_[j].property = std::exp(x[j]);
    return all;
  }

  const std::vector<Specimen>& strands_;
  std::vector<Unknown> fitted_;
};

/// The pair of fitted values of the largest correlation.
struct Pair {
  std::size_t one = 0, other = 0;
  double correlation = Estimate::none;
};
Pair most_correlated(const std::vector<double>& covariance, std::size_t p) {
  Pair most;
  for (std::size_t i = 0; i < p; ++i) {
    for (std::size_t j = i + 1; j < p; ++j) {
      const double c = covariance[i * p + j] /
                       std::sqrt(covariance[i * p + i] * covariance[j * p + j]);
      if (std::abs(c) <= std::abs(most.correlation)) continue;
      most = {i, j, c};
    }
  }
  return most;
}

/// The records as used by the fit, and their common scale (m, or 1 with standard errors).
struct Measured {
  std::vector<std::vector<double>> values;
  double scale = 1;
};

Measured measured(const Records& records, Observed observed) {
  Measured all;
  double squares = 0;
  for (const Record& record : records.all) {
    std::vector<double>& values = all.values.emplace_back(record.value);
    if (observed == Observed::displacement) centre(record, values);
    for (std::size_t k = 0; k < values.size(); ++k) {
      squares += weight(record, k) * values[k] * values[k];
    }
  }
  all.scale = std::sqrt(squares / static_cast<double>(records.points()));
  return all;
}

class Fit {
 public:
  Fit(const Records& records, const std::vector<Specimen>& strands, const FitOptions& how)
      : records_(records),
        how_(how),
        unknowns_(strands, how.fitted),
        strands_(strands),
        measured_(measured(records, how.observed)) {}

  OscillationFit result();

 private:
  bool residuals(In x, const FitOptions& how, int finer, Out r) const;
  bool residuals(In x, Out r) const { return residuals(x, how_, 1, r); }
  std::vector<double> start();
  void describe(const LeastSquares& least, OscillationFit& fit) const;
  void judge(const LeastSquares& least, const std::vector<double>& half,
             OscillationFit& fit) const;
  double shift(const LeastSquares& least, const std::vector<double>& half,
               const FitOptions& how, int finer) const;

  const Records& records_;
  const FitOptions& how_;
  Unknowns unknowns_;
  const std::vector<Specimen>& strands_;
  Measured measured_;
  int start_evaluations_ = 0;
};

bool Fit::residuals(In x, const FitOptions& how, int finer, Out r) const {
  const std::vector<BuiltStrand> strands = unknowns_.strands(x, finer);
  if (strands.empty()) return false;
  const auto signals = simulated(records_, strands, how);
  if (signals.empty()) return false;
  std::size_t at = 0;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    for (std::size_t k = 0; k < signals[i].size(); ++k) {
      const double w = std::sqrt(weight(records_.all[i], k)) / measured_.scale;
      r[at++] = w * (measured_.values[i][k] - signals[i][k]);
    }
  }
  return std::ranges::all_of(r, [](double entry) { return std::isfinite(entry); });
}

std::vector<double> Fit::start() {
  std::vector<double> r(records_.points());
  const auto misfit = [&](const Properties& properties) {
    ++start_evaluations_;
    if (!residuals(unknowns_.of(properties), r)) return Estimate::none;
    return std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
  };
  double modulus = strands_.front().properties.youngs_modulus;
  if (fits(how_.fitted, Fitted::stiffness)) {
    const auto values = [&](const Properties& properties) {
      ++start_evaluations_;
      return simulated(records_, unknowns_.strands(unknowns_.of(properties), 1), how_);
    };
    // Damping hardly moves the frequency: that of the decay.
    const Properties damped =
        start_values(records_, strands_, how_.observed, Fitted::nu, modulus, misfit);
    modulus = start_stiffness(records_, damped, values);
  }
  return unknowns_.of(
      start_values(records_, strands_, how_.observed, how_.fitted, modulus, misfit));
}

void Fit::describe(const LeastSquares& least, OscillationFit& fit) const {
  const std::size_t n = least.residual.size(), p = least.x.size();
  const double squares = std::inner_product(least.residual.begin(), least.residual.end(),
                                            least.residual.begin(), 0.0);
  double chained = 0, unweighted = 0;
  std::size_t at = 0;
  for (const Record& record : records_.all) {
    for (std::size_t k = 0; k < record.t.size(); ++k, ++at) {
      const double metres =
          least.residual[at] * measured_.scale / std::sqrt(weight(record, k));
      unweighted += metres * metres;
      if (k > 0) chained += least.residual[at] * least.residual[at - 1];
    }
  }
  fit.rms = std::sqrt(unweighted / static_cast<double>(n));
  fit.autocorrelation = chained / squares;
  fit.condition = least.condition;
  if (!records_.all.front().sigma.empty()) {
    fit.reduced_chi2 = squares * measured_.scale * measured_.scale / fit.degrees;
  }
  const Properties properties = unknowns_.properties(least.x);
  for (const Unknown& one : known_unknowns) {
    (fit.*one.estimate).value = properties.*one.property;
  }
  if (least.covariance.empty()) return;

  const std::vector<double> half = least.half_intervals(fit.degrees, how_.confidence);
  for (std::size_t j = 0; j < p; ++j) {
    Estimate& estimate = fit.*unknowns_[j].estimate;
    estimate.low = estimate.value / std::exp(half[j]);
    estimate.high = estimate.value * std::exp(half[j]);
  }
  FitOptions finer = how_;
  const double tighter = std::pow(refinement, 4);
  finer.options.step /= refinement;
  finer.options.rtol /= tighter;
  finer.options.atol /= tighter;
  fit.step_shift = shift(least, half, finer, 1);
  fit.elements_shift = shift(least, half, how_, refinement);
  judge(least, half, fit);
}

/// The largest change of a fitted value, over half its interval, for these runs.
double Fit::shift(const LeastSquares& least, const std::vector<double>& half,
                  const FitOptions& how, int finer) const {
  std::vector<double> r(least.residual.size());
  if (!residuals(least.x, how, finer, r)) return Estimate::none;
  // The remaining step at the optimum is not zero to rounding.
  const std::vector<double> now = least.step(least.residual), then = least.step(r);
  double most = 0;
  for (std::size_t j = 0; j < half.size(); ++j) {
    most = std::max(most, std::abs(then[j] - now[j]) / half[j]);
  }
  return most;
}

void Fit::judge(const LeastSquares& least, const std::vector<double>& half,
                OscillationFit& fit) const {
  const auto say = [&fit](std::string_view status, std::string reason) {
    fit.status = status;
    fit.reason = std::move(reason);
  };
  const auto widest_one = std::ranges::max_element(half);
  const Pair pair = most_correlated(least.covariance, half.size());
  fit.correlation = pair.correlation;
  if (std::abs(fit.correlation) > too_correlated) {
    const std::string_view a = unknowns_[pair.one].name, b = unknowns_[pair.other].name;
    say("not_identified",
        fmt::format("{} and {} change this motion in the same way (correlation {:.4f}): "
                    "fit one of them (fit={}, fit={}) or add a record of another length",
                    a, b, fit.correlation, a, b));
  } else if (*widest_one > widest) {
    const auto j = static_cast<std::size_t>(widest_one - half.begin());
    say("not_identified",
        fmt::format("the interval of {} spans a factor of {:.3g} each way: it may be 0",
                    unknowns_[j].name, std::exp(*widest_one)));
  } else if (std::isnan(fit.step_shift) || std::isnan(fit.elements_shift)) {
    say("solver_error", "a run with half the step or twice the elements fails");
  } else if (fit.step_shift > largest_shift) {
    say("time_error", fmt::format("half the step moves a value by {:.3g} half-intervals",
                                  fit.step_shift));
  } else if (fit.elements_shift > largest_shift) {
    say("space_error",
        fmt::format("twice as many elements move a value by {:.3g} half-intervals",
                    fit.elements_shift));
  } else if (const double n = static_cast<double>(records_.points());
             fit.autocorrelation > deviations / std::sqrt(n)) {
    say("misfit",
        fmt::format("residuals are correlated ({:.2f}): the strand or its model is not "
                    "that of the records, the interval is too narrow",
                    fit.autocorrelation));
  }
}

OscillationFit Fit::result() {
  OscillationFit fit;
  const std::size_t n = records_.points(), p = unknowns_.count();
  const std::size_t constants =
      how_.observed == Observed::displacement ? records_.all.size() : 0;
  fit.degrees = static_cast<int>(n - p - constants);
  const LeastSquares least = least_squares(
      [this](In x, Out r) { return residuals(x, r); }, start(), n, difference, tolerance);
  fit.evaluations = start_evaluations_ + least.evaluations;
  if (!least.x.empty()) describe(least, fit);
  if (least.x.empty() || (fit.status == "ok" && !least.failure.empty())) {
    fit.status = "solver_error";
    fit.reason = least.failure;
  } else if (least.covariance.empty()) {
    fit.status = "not_identified";
    fit.reason = "the records do not depend on what is fitted";
  }
  return fit;
}

}  // namespace

std::vector<Specimen> strands_of(const Records& records, const ModelEntry& model,
                                 const Parameters& parameters, Fitted fitted) {
  std::vector<Specimen> all;
  for (const Record& record : records.all) {
    Parameters strand = parameters;
    for (const auto& [key, value, where] : record.of_strand) {
      if ((key == gamma_key && fits(fitted, Fitted::gamma)) ||
          (key == drag_key && fits(fitted, Fitted::nu)) ||
          (key == stiffness_key && fits(fitted, Fitted::stiffness))) {
        throw InputError("'" + key + "' is what is fitted", where,
                         "leave out the column, or do not fit it (--set fit)");
      }
      strand.set(key, value, where);
    }
    all.push_back(specimen(model, strand));
  }
  return all;
}

std::vector<Specimen> strands_of(const Records& records, const Scene& scene) {
  for (const Record& record : records.all) {
    if (!record.of_strand.empty()) {
      const auto& [key, value, where] = record.of_strand.front();
      throw InputError("the scene defines '" + key + "' itself", where,
                       "leave out the column, or --scene");
    }
    check_last_time(scene, "t_s", record.t.back(), record.end);
  }
  return {records.all.size(), specimen(scene)};
}

OscillationFit fit_oscillation(const Records& records,
                               const std::vector<Specimen>& strands,
                               const FitOptions& how) {
  return Fit(records, strands, how).result();
}

}  // namespace tress::experiments::calibrate
