#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "simulation/fit/fit_variable.h"
#include "simulation/fit/point_record.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// A record and the scene of the strands that it shows.
struct FitRecord {
  const Scene* scene = nullptr;         // scene of the strands
  const PointRecord* points = nullptr;  // measured points
};

/// Records, parameters and settings of a fit.
struct FitTask {
  std::vector<FitRecord> records = {};  // records that are fitted together
  std::vector<std::string> by = {};     // parameters, by the names of [gradient]
  std::vector<FitBound> bounds = {};    // limits of some of the parameters
  std::vector<FitPrior> priors = {};    // priors of some of the parameters
  double confidence = 0.95;             // of the intervals
  /// Runs again with half the step and with twice the elements.
  bool shifts = true;
  /// Adds intervals by profiles, each with about 20 runs.
  bool profile = false;
  std::string place = "fit";  // of `by`, in messages
  /// Called after each evaluation with the number of evaluations and the root mean
  /// square of measured less fitted (m).
  std::function<void(int evaluations, double rms)> progress = {};
};

/// Value of statistics that a fit does not have: NaN.
constexpr double not_there = std::numeric_limits<double>::quiet_NaN();

/// A fitted value. Status as that of SceneFit, of this parameter alone.
struct FittedParameter {
  std::string name = {}, unit = {};  // name and unit of the parameter
  double start = 0, value = 0;       // value of the scene and fitted value, in the unit
  double low = not_there, high = not_there;  // interval; NaN: none
  /// Lower end of the interval by the profile. NaN: not computed, or no end within ten
  /// linear half-intervals.
  double profile_low = not_there;
  double profile_high = not_there;  // upper end, likewise
  /// Changes with half the step and with twice the elements, over half the interval.
  double step_shift = not_there, elements_shift = not_there;
  std::string status = "ok", reason = {};  // status and its reason in words
};

/// Returns whether residuals are too small for sigma_m: less than one in a thousand sums
/// of squares is as small. False where reduced_chi2 is NaN.
bool too_small(double reduced_chi2, int degrees);

/// A fit and its statistics. Status:
///
///     ok
///     at_bound        the value is at one of its bounds
///     not_identified  the records do not determine the value: it belongs to a
///                     combination whose interval spans a factor of 10 each way
///     time_error      half the step changes a value by more than a quarter of half its
///                     interval
///     space_error     twice the elements do
///     misfit          residuals are correlated in time or too large for sigma_m: the
///                     scene is not that of the records, and intervals are too narrow.
///                     Residuals at rounding, or too small for sigma_m, are not judged.
///                     Or a value is more than 3.29 sigma from its prior
///     solver_error    the fit did not converge, or a run failed
struct SceneFit {
  std::vector<FittedParameter> parameters = {};  // parameters in the order of FitTask::by
  /// Singular values of the derivatives of the weighted residuals by the unknowns
  /// (logarithms of positive parameters, others over their measure), descending. Those of
  /// parameters at a bound are left out. Without sigma_m, residuals are over a thousandth
  /// of the strand's length.
  std::vector<double> singular = {};
  std::string undetermined = {};       // combinations that no record determines, in words
  double rms = not_there;              // m, of measured less fitted
  double reduced_chi2 = not_there;     // where standard errors are known
  double autocorrelation = not_there;  // of successive residuals of a coordinate
  int degrees = 0;      // of freedom: coordinates and priors less fitted values
  int evaluations = 0;  // runs of all records with their derivatives
  std::vector<std::vector<double>> fitted = {};  // of each record: m, as its observations
  std::string status = "ok", reason = {};        // status and its reason in words
};

/// Fits parameters of scenes to points of their strands: least squares of
///
///     (measured - simulated)/sigma  and  (p - prior)/sigma of the prior,
///
/// by Gauss-Newton steps within a trust region, with the exact derivatives of the runs
/// (GradientRun). Intervals
/// are u +- k sqrt(C_jj) in the unknowns u of FitVariable, with C = (J^T J)^-1. Where
/// sigma_m is given it is known and k the normal quantile. Otherwise the variance is
/// estimated from the residuals, and k is Student's quantile.
/// Intervals by profiles end where the least sum of squares has risen by k^2 times the
/// variance (profile_interval()).
///
/// Combinations that no record determines keep their start: a weak prior of 100 in every
/// u is part of the search, and of no statistics. Shifts are one Gauss-Newton step from
/// the result with the residuals and derivatives of the finer run.
///
/// Throws InputError as check_fit() does.
SceneFit fit_scenes(const FitTask& task);

/// Checks a task without a run. Throws InputError on parameters that the scenes do not
/// have, and on records of strands, points or times that they do not have. Also throws on
/// wrong bounds and priors, on too few coordinates, and as check_derivatives().
void check_fit(const FitTask& task);

}  // namespace tress::simulation
