#include "simulation/fit/scene_fit.h"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_linalg.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "linear/dense_algebra.h"
#include "simulation/fit/fit_search.h"
#include "simulation/fit/fit_words.h"
#include "simulation/fit/profile.h"

namespace tress::simulation {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using Finer = RecordRuns::Finer;

constexpr double widest = 2.302585092994046;  // ln 10
// Derivatives are exact to 1e-8: a smaller singular value is 0.
constexpr double no_effect = 1e-6;
constexpr double least_part = 0.1;  // of a unit vector: a parameter that belongs to it
constexpr double largest_shift = 0.25;  // half intervals
constexpr double deviations = 4;        // standard deviations of an autocorrelation
constexpr double unlikely = 1e-3;       // probability of a larger sum of squares
// Of a value from its prior. Records with the standard error t and a prior with s move
// the value from the prior by s/sqrt(1 + t^2/s^2) on average, less than s: it is farther
// with a probability of at most 1e-3.
constexpr double most_sigmas = 3.29;
// Over the length of a strand: Newton's tolerance and coordinates with nine digits leave
// less, and no measurement does.
constexpr double rounding = 1e-8;

/// Singular values in descending order and, by columns, the right singular vectors.
struct SingularValues {
  VectorXd s;
  MatrixXd v;
};

/// By one-sided Jacobi rotations, which find small values to their own relative accuracy
/// [Demmel, Veselic 1992, SIAM J. Matrix Anal. Appl. 13, 1204].
SingularValues singular_values(const MatrixXd& j) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto n = static_cast<std::size_t>(j.cols());
  RowMajor u = RowMajor::Zero(std::max(j.rows(), j.cols()), j.cols()),
           v(j.cols(), j.cols());
  u.topRows(j.rows()) = j;
  VectorXd s(j.cols());
  gsl_matrix_view of_u =
      gsl_matrix_view_array(u.data(), static_cast<std::size_t>(u.rows()), n);
  gsl_matrix_view of_v = gsl_matrix_view_array(v.data(), n, n);
  gsl_vector_view of_s = gsl_vector_view_array(s.data(), n);
  gsl_linalg_SV_decomp_jacobi(&of_u.matrix, &of_v.matrix, &of_s.vector);
  return {std::move(s), v};
}

/// The statistics of a search at its end.
class Fit {
 public:
  explicit Fit(const FitTask& task)
      : task_(task), search_(task), runs_(search_.runs()), free_(search_.free()) {}
  SceneFit result();

 private:
  void describe(SceneFit& fit);
  void add_intervals(SceneFit& fit, const LinearizedFit& found);
  void add_shifts(SceneFit& fit, const LinearizedFit& here, const MatrixXd& determined,
                  const VectorXd& half);
  void add_profiles(SceneFit& fit, const VectorXd& half, double least, double deviation);
  VectorXd shifts(const LinearizedFit& here, const MatrixXd& determined, Finer finer);
  std::string far_from_priors(const SceneFit& fit) const;
  void judge(SceneFit& fit) const;

  const FitTask& task_;
  FitSearch search_;
  const RecordRuns& runs_;
  const std::vector<std::size_t>& free_;
};

/// Change of the unknowns from one Gauss-Newton step of a finer run, within the
/// combinations that are determined. Empty: its run fails.
VectorXd Fit::shifts(const LinearizedFit& here, const MatrixXd& determined, Finer finer) {
  const std::optional<LinearizedFit> there = search_.linear(finer);
  if (!there) return {};
  const auto step = [&](const LinearizedFit& one) -> VectorXd {
    const MatrixXd j = one.j * determined;
    return determined * least_squares_solution(j, -one.r);
  };
  return step(*there) - step(here);
}

void Fit::add_shifts(SceneFit& fit, const LinearizedFit& here, const MatrixXd& determined,
                     const VectorXd& half) {
  const auto add = [&](Finer finer, double FittedParameter::*shift) {
    const VectorXd moved = shifts(here, determined, finer);
    if (moved.size() == 0) return;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (half[k] > 0) fit.parameters[free_[i]].*shift = std::abs(moved[k]) / half[k];
    }
  };
  add(Finer::half_step, &FittedParameter::step_shift);
  add(Finer::twice_the_elements, &FittedParameter::elements_shift);
}

/// Of all parameters that have an interval.
void Fit::add_profiles(SceneFit& fit, const VectorXd& half, double least,
                       double deviation) {
  const std::vector<std::size_t> free = free_;  // the search moves
  for (std::size_t i = 0; i < free.size(); ++i) {
    FittedParameter& one = fit.parameters[free[i]];
    if (std::isnan(one.low)) continue;
    const auto [low, high] = profile_interval(
        search_, {free[i], half[static_cast<Eigen::Index>(i)], least, deviation});
    const FitVariable& variable = search_.variables()[free[i]];
    one.profile_low = variable.p(low);
    one.profile_high = variable.p(high);
  }
}

void Fit::describe(SceneFit& fit) {
  const std::vector<double> p = search_.values();
  for (std::size_t k = 0; k < p.size(); ++k) {
    fit.parameters[k].value = p[k];
    if (search_.held(k)) {
      fit.parameters[k].status = "at_bound";
      fit.parameters[k].reason =
          fmt::format("{} is at its bound", fit.parameters[k].name);
    }
  }
  const std::optional<LinearizedFit> found = search_.linear(Finer::no);
  if (!found) return;
  fit.degrees = static_cast<int>(search_.rows() - free_.size());
  const auto count = static_cast<Eigen::Index>(runs_.count());
  const double squares = found->r.head(count).squaredNorm();
  double metres = 0, chained = 0;
  for (std::size_t i = 0; i < runs_.count(); ++i) {
    metres += std::pow(runs_.measured()[i] - search_.simulated()[i], 2);
  }
  for (const auto& [i, j] : runs_.successive()) {
    chained +=
        found->r[static_cast<Eigen::Index>(i)] * found->r[static_cast<Eigen::Index>(j)];
  }
  fit.rms = std::sqrt(metres / static_cast<double>(runs_.count()));
  if (squares > 0) fit.autocorrelation = chained / squares;
  if (runs_.sigma_known()) fit.reduced_chi2 = found->r.squaredNorm() / fit.degrees;
  std::size_t first = 0;
  for (const FitRecord& record : task_.records) {
    const std::size_t some = record.points->observations.size();
    const In part = search_.simulated().subspan(first, some);
    fit.fitted.emplace_back(part.begin(), part.end());
    first += some;
  }
  if (!free_.empty()) add_intervals(fit, *found);
}

void Fit::add_intervals(SceneFit& fit, const LinearizedFit& found) {
  const std::vector<double> u = search_.u();
  const auto [s, v] = singular_values(found.j);
  fit.singular.assign(s.begin(), s.end());
  const double upper = (1 + task_.confidence) / 2;
  const double deviation = runs_.sigma_known()
                               ? gsl_cdf_ugaussian_Pinv(upper)
                               : gsl_cdf_tdist_Pinv(upper, fit.degrees) *
                                     std::sqrt(found.r.squaredNorm() / fit.degrees);
  Eigen::Index determined = 0;
  while (determined < s.size() && s[determined] > no_effect * s[0] &&
         deviation / s[determined] < widest) {
    ++determined;
  }
  const VectorXd half = deviation * (v.leftCols(determined) *
                                     s.head(determined).cwiseInverse().asDiagonal())
                                        .rowwise()
                                        .norm();
  std::vector<Combination> unknown;
  for (Eigen::Index k = determined; k < s.size(); ++k) {
    Combination& one = unknown.emplace_back();
    for (std::size_t i = 0; i < free_.size(); ++i) {
      one.push_back({&runs_.parameters()[free_[i]], v(static_cast<Eigen::Index>(i), k)});
    }
  }
  fit.undetermined = in_words(unknown, least_part);
  for (std::size_t i = 0; i < free_.size(); ++i) {
    FittedParameter& one = fit.parameters[free_[i]];
    const FitVariable& variable = search_.variables()[free_[i]];
    const auto k = static_cast<Eigen::Index>(i);
    if (v.row(k).tail(s.size() - determined).norm() > least_part) {
      one.status = "not_identified";
      one.reason = fit.undetermined;
      continue;
    }
    one.low = variable.p(u[free_[i]] - half[k]);
    one.high = variable.p(u[free_[i]] + half[k]);
  }
  if (task_.shifts && determined > 0) {
    add_shifts(fit, found, v.leftCols(determined), half);
  }
  if (task_.profile) add_profiles(fit, half, found.r.squaredNorm(), deviation);
}

/// The values that contradict their priors, in words; empty: none.
std::string Fit::far_from_priors(const SceneFit& fit) const {
  std::string all;
  for (const FitPrior& prior : task_.priors) {
    const auto one =
        std::ranges::find(fit.parameters, prior.name, &FittedParameter::name);
    const double sigmas = std::abs(one->value - prior.value) / prior.sigma;
    if (!(sigmas > most_sigmas)) continue;
    all += fmt::format("{}{} = {:.4g} {} is {:.3g} sigma from its prior, {:.4g} {}",
                       all.empty() ? "" : "; ", one->name, one->value, one->unit, sigmas,
                       prior.value, one->unit);
  }
  return all;
}

/// The status of each parameter that has none yet, and that of the fit: the first.
void Fit::judge(SceneFit& fit) const {
  const std::string far = far_from_priors(fit);
  std::string misfit, unjudged;
  const auto pairs = static_cast<double>(runs_.successive().size());
  const double length = task_.records.front().scene->strands.front().length();
  if (!runs_.sigma_known() && fit.rms < rounding * length) {
    unjudged = fmt::format(
        ". Residuals are at rounding ({:.2g} m), as of a run of this scene: their "
        "correlation is not judged",
        fit.rms);
  } else if (too_small(fit.reduced_chi2, fit.degrees)) {
    unjudged = fmt::format(
        ". Residuals are too small for sigma_m (reduced chi^2 {:.3g}): their "
        "correlation is not judged",
        fit.reduced_chi2);
  } else if (pairs > 0 && fit.autocorrelation > deviations / std::sqrt(pairs)) {
    misfit =
        fmt::format("residuals are correlated in time ({:.2f})", fit.autocorrelation);
  } else if (runs_.sigma_known() &&
             fit.reduced_chi2 * fit.degrees > gsl_cdf_chisq_Qinv(unlikely, fit.degrees)) {
    misfit = fmt::format("residuals are too large for sigma_m (reduced chi^2 {:.3g})",
                         fit.reduced_chi2);
  }
  // What limits a value, and of what there are too few. Where the residuals are no noise
  // either, both are said.
  const auto limited = [&](std::string_view error, std::string_view remedy) {
    return misfit.empty()
               ? fmt::format("{} error, not noise, limits it; give {}{}", error, remedy,
                             unjudged)
               : fmt::format(
                     "{}; give {} first; if the residuals stay so, the scene is not that "
                     "of the records, and intervals are too narrow",
                     misfit, remedy);
  };
  for (FittedParameter& one : fit.parameters) {
    if (one.status != "ok") continue;
    const auto say = [&](std::string_view status, std::string reason) {
      one.status = status;
      one.reason = std::move(reason);
    };
    if (task_.shifts && (std::isnan(one.step_shift) || std::isnan(one.elements_shift))) {
      say("solver_error", "a run with half the step or twice the elements fails");
    } else if (one.step_shift > largest_shift) {
      say("time_error",
          fmt::format("half the step moves {} by {:.3g} half intervals: {}", one.name,
                      one.step_shift, limited("time", "a shorter step")));
    } else if (one.elements_shift > largest_shift) {
      say("space_error",
          fmt::format("twice the elements move {} by {:.3g} half intervals: {}", one.name,
                      one.elements_shift, limited("space", "more elements")));
    } else if (!misfit.empty()) {
      say("misfit", misfit +
                        ": the scene is not that of the records, and intervals are "
                        "too narrow");
    } else if (!far.empty()) {
      say("misfit",
          "the prior or the scene is not that of the records, and intervals are too "
          "narrow");
    }
  }
  for (FittedParameter& one : fit.parameters) {
    if (!far.empty()) one.reason = far + ": " + one.reason;
  }
  const auto bad = std::ranges::find_if(
      fit.parameters, [](const FittedParameter& one) { return one.status != "ok"; });
  if (bad == fit.parameters.end()) return;
  fit.status = bad->status;
  fit.reason = bad->reason;
}

SceneFit Fit::result() {
  SceneFit fit;
  for (const SceneParameter& one : runs_.parameters()) {
    fit.parameters.push_back(
        {.name = one.name, .unit = one.unit, .start = one.value, .value = one.value});
  }
  std::string failed = search_.run();
  describe(fit);
  fit.evaluations = search_.evaluations();
  if (failed.empty() && fit.fitted.empty()) failed = search_.failure();
  if (failed.empty()) {
    judge(fit);
    return fit;
  }
  // Steps along what the records do not determine need not end.
  const bool known = fit.undetermined.empty();
  fit.status = known ? "solver_error" : "not_identified";
  fit.reason = known ? failed : fit.undetermined;
  for (FittedParameter& one : fit.parameters) {
    if (one.status == "not_identified") continue;
    one.status = "solver_error";
    one.reason = failed;
  }
  return fit;
}

}  // namespace

bool too_small(double reduced_chi2, int degrees) {
  return degrees > 0 && reduced_chi2 * degrees < gsl_cdf_chisq_Pinv(unlikely, degrees);
}

SceneFit fit_scenes(const FitTask& task) { return Fit(task).result(); }

void check_fit(const FitTask& task) { static_cast<void>(FitSearch(task)); }

}  // namespace tress::simulation
