#include "experiments/calibrate/friction_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "contract/input_error.h"

namespace tress::experiments::calibrate {
namespace {

// Central differences in ln gamma and ln nu: at 1e-3 the error is 2e-7 of the third
// derivative, and Newton's tolerance of 1e-10 contributes 1e-7.
constexpr double difference = 1e-3;
constexpr double tolerance = 1e-7;  // of ln gamma and ln nu

constexpr double too_correlated = 0.99;
constexpr double widest = 2.302585092994046;  // ln 10
constexpr double deviations = 4;  // standard deviations 1/sqrt(n) of an autocorrelation
constexpr int refinement = 2;     // of the step; tolerances by its 4th power
// Halving the step removes half the error of a method of order 1, three quarters for
// order 2: the whole error is then below half a half-interval.
constexpr double largest_shift = 0.25;  // half-intervals

/// The fitted values as least-squares unknowns.
class Unknowns {
 public:
  Unknowns(const std::vector<Specimen>& strands, Fitted fitted)
      : strands_(strands), gamma_(fitted != Fitted::nu), nu_(fitted != Fitted::gamma) {}

  std::size_t count() const { return (gamma_ ? 1u : 0u) + (nu_ ? 1u : 0u); }
  bool gamma() const { return gamma_; }
  bool nu() const { return nu_; }

  std::vector<double> of(const Friction& friction) const {
    std::vector<double> x;
    if (gamma_) x.push_back(std::log(friction.gamma));
    if (nu_) x.push_back(std::log(friction.nu));
    return x;
  }
  /// For the first strand; a known value may differ between strands.
  Friction friction(In x) const { return friction(x, strands_.front()); }
  /// With `finer` times as many elements. Empty: out of range.
  std::vector<BuiltStrand> strands(In x, int finer) const {
    constexpr double most = 1e6;
    const auto [gamma, nu] = friction(x);
    if ((gamma_ && !(gamma < most)) || (nu_ && !(nu < most))) return {};
    std::vector<BuiltStrand> all;
    for (const Specimen& one : strands_)
      all.push_back(one.build(friction(x, one), finer));
    return all;
  }

 private:
  Friction friction(In x, const Specimen& strand) const {
    return {gamma_ ? std::exp(x[0]) : strand.friction.gamma,
            nu_ ? std::exp(x[count() - 1]) : strand.friction.nu};
  }

  const std::vector<Specimen>& strands_;
  bool gamma_, nu_;
};

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

  FrictionFit result();

 private:
  bool residuals(In x, const FitOptions& how, int finer, Out r) const;
  bool residuals(In x, Out r) const { return residuals(x, how_, 1, r); }
  std::vector<double> start();
  void describe(const LeastSquares& least, FrictionFit& fit) const;
  void judge(const std::vector<double>& half, FrictionFit& fit) const;
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
  const auto misfit = [&](const Friction& friction) {
    ++start_evaluations_;
    if (!residuals(unknowns_.of(friction), r)) return Estimate::none;
    return std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
  };
  return unknowns_.of(
      friction_start(records_, strands_, how_.observed, how_.fitted, misfit));
}

void Fit::describe(const LeastSquares& least, FrictionFit& fit) const {
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
  const Friction friction = unknowns_.friction(least.x);
  fit.gamma.value = friction.gamma;
  fit.nu.value = friction.nu;
  if (least.covariance.empty()) return;

  const std::vector<double> half = least.half_intervals(fit.degrees, how_.confidence);
  const auto spread = [](Estimate& estimate, double ratio) {
    estimate.low = estimate.value / std::exp(ratio);
    estimate.high = estimate.value * std::exp(ratio);
  };
  if (unknowns_.gamma()) spread(fit.gamma, half.front());
  if (unknowns_.nu()) spread(fit.nu, half.back());
  if (p == 2) {
    const auto& c = least.covariance;
    fit.correlation = c[1] / std::sqrt(c[0] * c[3]);
  }
  FitOptions finer = how_;
  const double tighter = std::pow(refinement, 4);
  finer.options.step /= refinement;
  finer.options.rtol /= tighter;
  finer.options.atol /= tighter;
  fit.step_shift = shift(least, half, finer, 1);
  fit.elements_shift = shift(least, half, how_, refinement);
  judge(half, fit);
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

void Fit::judge(const std::vector<double>& half, FrictionFit& fit) const {
  const auto say = [&fit](std::string_view status, std::string reason) {
    fit.status = status;
    fit.reason = std::move(reason);
  };
  const double wide = std::ranges::max(half);
  if (std::abs(fit.correlation) > too_correlated) {
    say("not_identified",
        fmt::format(
            "gamma and nu damp this motion alike (correlation {:.4f}): fit one of "
            "them (fit=gamma, fit=nu) or add a record of another length",
            fit.correlation));
  } else if (wide > widest) {
    const bool of_gamma = unknowns_.gamma() && half.front() == wide;
    say("not_identified",
        fmt::format("the interval of {} spans a factor of {:.3g} each way: it may be 0",
                    of_gamma ? "gamma" : "nu", std::exp(wide)));
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

FrictionFit Fit::result() {
  FrictionFit fit;
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
      if ((key == gamma_key && fitted != Fitted::nu) ||
          (key == drag_key && fitted != Fitted::gamma)) {
        throw InputError("'" + key + "' is what is fitted", where,
                         "leave out the column, or fit the other one alone");
      }
      strand.set(key, value, where);
    }
    all.push_back(specimen(model, strand));
  }
  return all;
}

std::vector<Specimen> strands_of(const Records& records, const Scene& scene) {
  for (const Record& record : records.all) {
    if (record.of_strand.empty()) continue;
    const auto& [key, value, where] = record.of_strand.front();
    throw InputError("the scene says itself what '" + key + "' is", where,
                     "leave out the column, or --scene");
  }
  return {records.all.size(), specimen(scene)};
}

FrictionFit fit_friction(const Records& records, const std::vector<Specimen>& strands,
                         const FitOptions& how) {
  return Fit(records, strands, how).result();
}

}  // namespace tress::experiments::calibrate
