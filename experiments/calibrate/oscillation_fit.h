#pragma once

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/calibrate/simulated_records.h"
#include "simulation/fit/least_squares.h"

namespace tress::experiments::calibrate {

/// The fitted values, as a set of bits; the others are known. `both` are gamma and nu.
enum class Fitted {
  gamma = 1,
  nu = 2,
  both = 3,
  stiffness = 4,
  stiffness_gamma = 5,
  stiffness_nu = 6,
  all = 7
};
constexpr bool fits(Fitted fitted, Fitted one) {
  return (static_cast<int>(fitted) & static_cast<int>(one)) != 0;
}

struct FitOptions : Watch {
  Fitted fitted = Fitted::both;
  double confidence = 0.95;  // of the intervals
};

/// A fitted value and its interval; no interval for a known value.
struct Estimate {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double value = none, low = none, high = none;
};

struct OscillationFit {
  Estimate gamma;                           // internal friction, kg m^3/s
  Estimate nu;                              // air drag, kg/(m s)
  Estimate youngs_modulus;                  // Pa
  double correlation = Estimate::none;      // of two fitted values, the largest in size
  double condition = Estimate::none;        // of dr/dx
  double rms = Estimate::none;              // m, of measured less fitted
  double reduced_chi2 = Estimate::none;     // where standard errors are known
  double autocorrelation = Estimate::none;  // of successive residuals
  double step_shift = Estimate::none;  // largest change at half the step, half-intervals
  double elements_shift = Estimate::none;  // the same with twice as many elements
  int degrees = 0;      // of freedom: points - fitted values - constants of the records
  int evaluations = 0;  // simulations of all records
  std::string status = "ok", reason;
};

/// The strands of the records: `parameters` overridden by each record's settings. Throws
/// InputError at the record's cell on keys that the model does not have or the fit
/// determines.
std::vector<Specimen> strands_of(const Records& records, const ModelEntry& model,
                                 const Parameters& parameters, Fitted fitted);
/// The scene's strand, for each record; throws InputError at a cell that sets what the
/// scene defines, and at a time after the scene's end.
std::vector<Specimen> strands_of(const Records& records, const Scene& scene);

/// Fits internal friction gamma, air drag nu and Young's modulus E to damped
/// oscillations. [Bertails et al. 2006, section 4.2 and first seed, figure 1.8] fit gamma
/// in this way to the span of a curly clump that oscillates vertically. Least squares
/// over all records in the fitted values of x = (ln E, ln gamma, ln nu),
///
///     min_x sum_k ((y_k - c_record - s_k(x))/sigma_k)^2,
///
/// with s the simulated signal. The constant of a displacement, c, is the weighted mean
/// of y - s. It is removed from residuals and their derivatives, so that statistics are
/// those of a fit with c unknown. Standard errors count relative to each other; their
/// common scale is estimated from the residuals. Intervals are exp(x_j +- t sqrt(C_jj
/// s^2)), with C = (J^T J)^-1. s^2 is the sum of squares over the degrees of freedom and
/// t Student's quantile.
///
/// A mode k of a strand of mass per length m decays at (nu/m + gamma c_k)/2, with c_k =
/// omega_k^2/(EI) for a straight weightless strand. One mode determines only the sum, two
/// modes or strands of two lengths (omega ~ 1/L^2) determine both. E follows from the
/// frequency; an envelope has none, and its records determine gamma and nu only. Status:
///
///     ok
///     not_identified  |correlation| above 0.99 (the interval is 7 times that of one
///                     value alone), or an interval wider than tenfold each way
///     time_error      halving the step changes a value by more than a quarter of half
///                     its interval
///     space_error     doubling the elements does
///     misfit          successive residuals are correlated, unlike measurement errors:
///                     model or strand are not those of the record, the interval is too
///                     narrow
///     solver_error    the fit did not converge, or a run failed, also at half the step
OscillationFit fit_oscillation(const Records& records,
                               const std::vector<Specimen>& strands,
                               const FitOptions& how);

/// Decay rate (1/s) of a record, exp(-rate t): logarithmic decrement between the root
/// mean squares of its halves about the common mean, over the time between them. 0 when
/// it grows.
double decay_rate(const Record& record, Observed observed);

/// Time between two crossings of the mean, averaged over the record (s). A crossing
/// counts once the record has moved away by 0.3 times its root mean square, more than its
/// noise. NaN with fewer than two crossings.
double half_period(const Record& record, const std::vector<double>& values);

/// Initial guess of gamma and nu. Drag alone that matches the decay: nu = 2 m rate, m the
/// mass per length, whatever the mode. Friction alone: that of a straight strand's first
/// mode, gamma = 2 m rate (L/1.8751)^4, or tenths of it (a curl needs less), whichever
/// has the least `misfit` (NaN: none). Both: half of each. Young's modulus:
/// `youngs_modulus`.
Properties start_values(const Records& records, const std::vector<Specimen>& strands,
                        Observed observed, Fitted fitted, double youngs_modulus,
                        const std::function<double(const Properties&)>& misfit);

/// Initial guess of Young's modulus: the one at which `simulate` has the records' half
/// periods, in the mean of their logarithms. Secant method in ln E from `guess`, with
/// frequency ~ sqrt(E) at first and at most a factor of 4 a step. `simulate`: the values
/// of each record for these properties; empty: the run failed.
double start_stiffness(
    const Records& records, const Properties& guess,
    const std::function<std::vector<std::vector<double>>(const Properties&)>& simulate);

}  // namespace tress::experiments::calibrate
