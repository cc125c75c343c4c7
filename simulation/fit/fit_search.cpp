#include "simulation/fit/fit_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"
#include "simulation/fit/least_squares.h"

namespace tress::simulation {
namespace {

// Of the unknowns: a Gauss-Newton step below this leaves its square.
constexpr double search_tolerance = 1e-5;
// Standard error of the weak prior of every unknown. A value whose interval is 1 moves by
// 1e-4 of its distance from the start.
constexpr double weak_prior = 100;

/// Index of each named parameter among those of the fit. Throws InputError on a name that
/// is not fitted or stands twice.
template <class Named>
std::vector<std::size_t> indices(const std::vector<Named>& given, std::string_view what,
                                 const std::vector<SceneParameter>& parameters) {
  std::vector<std::string_view> fitted;
  for (const SceneParameter& one : parameters) fitted.push_back(one.name);
  std::vector<std::size_t> all;
  for (const Named& one : given) {
    const auto found = std::ranges::find(fitted, one.name);
    refuse_if(found == fitted.end(),
              fmt::format("{} of {}, which is not fitted", what, one.name), one.place,
              suggestion(one.name, fitted,
                         fmt::format("fitted are: {}", fmt::join(fitted, ", "))));
    const auto k = static_cast<std::size_t>(found - fitted.begin());
    refuse_if(std::ranges::count(all, k) > 0, fmt::format("two {} of {}", what, one.name),
              one.place, "leave one out");
    all.push_back(k);
  }
  return all;
}

void check(const FitPrior& prior, const SceneParameter& parameter) {
  const std::string text = fmt::format("the prior of {} is {:g} with sigma = {:g}",
                                       prior.name, prior.value, prior.sigma);
  refuse_if(!std::isfinite(prior.value) || !std::isfinite(prior.sigma), text, prior.place,
            "give two finite numbers");
  refuse_if(!(prior.sigma > 0), text, prior.place, "give a sigma above 0");
  refuse_if(prior.value < parameter.min || prior.value > parameter.max, text, prior.place,
            fmt::format("give a value between {:g} and {:g}, its range in a scene",
                        parameter.min, parameter.max));
}

}  // namespace

FitSearch::FitSearch(const FitTask& task)
    : task_(task),
      runs_(task),
      simulated_(runs_.count()),
      by_(runs_.count() * runs_.parameters().size()) {
  const auto& parameters = runs_.parameters();
  std::vector<const FitBound*> bounds(parameters.size());
  const std::vector<std::size_t> bounded = indices(task.bounds, "bounds", parameters);
  for (std::size_t i = 0; i < bounded.size(); ++i) bounds[bounded[i]] = &task.bounds[i];
  const std::vector<std::size_t> known = indices(task.priors, "priors", parameters);
  for (std::size_t i = 0; i < known.size(); ++i) {
    const FitPrior& prior = task.priors[i];
    check(prior, parameters[known[i]]);
    refuse_if(!runs_.sigma_known(), "a prior needs the records' standard errors",
              prior.place, "give the records a column sigma_m, or leave out priors");
    priors_.push_back({known[i], prior.value, prior.sigma});
  }
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    variables_.emplace_back(parameters[k], bounds[k]);
    free_.push_back(k);
    x_.push_back(variables_.back().start());
  }
  held_.resize(parameters.size());
  refuse_if(rows() <= parameters.size(),
            fmt::format("measured coordinates: {} for {} parameters", runs_.count(),
                        parameters.size()),
            task.place, "give more, or fit fewer parameters");
}

std::vector<double> FitSearch::u_of(In x) const {
  std::vector<double> u(variables_.size());
  for (std::size_t k = 0; k < u.size(); ++k) u[k] = held_[k].value_or(0);
  for (std::size_t i = 0; i < free_.size(); ++i)
    u[free_[i]] = variables_[free_[i]].u(x[i]);
  return u;
}

std::vector<double> FitSearch::values(const std::vector<double>& u) const {
  std::vector<double> p;
  for (std::size_t k = 0; k < u.size(); ++k) p.push_back(variables_[k].p(u[k]));
  return p;
}

/// Empty: a run fails there.
FitSearch::Linear FitSearch::linear(const std::vector<double>& u,
                                    RecordRuns::Finer finer) {
  const std::vector<double> p = values(u);
  if (!std::ranges::all_of(p, [](double one) { return std::isfinite(one); })) return {};
  ++evaluations_;
  failure_ = runs_.run(p, finer, simulated_, by_);
  if (!failure_.empty()) return {};
  const auto n = static_cast<Eigen::Index>(rows());
  LinearizedFit all{Eigen::VectorXd(n),
                    Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(free_.size()))};
  double squares = 0;
  for (std::size_t i = 0; i < runs_.count(); ++i) {
    const double left = runs_.measured()[i] - simulated_[i];
    squares += left * left;
    const auto row = static_cast<Eigen::Index>(i);
    all.r[row] = left / runs_.sigma()[i];
    for (std::size_t k = 0; k < free_.size(); ++k) {
      all.j(row, static_cast<Eigen::Index>(k)) = -by_[i * u.size() + free_[k]] *
                                                 variables_[free_[k]].dp_du(u[free_[k]]) /
                                                 runs_.sigma()[i];
    }
  }
  for (std::size_t i = 0; i < priors_.size(); ++i) {
    const auto [k, value, sigma] = priors_[i];
    const auto row = static_cast<Eigen::Index>(runs_.count() + i);
    all.r[row] = (p[k] - value) / sigma;
    const auto place = std::ranges::find(free_, k);
    if (place == free_.end()) continue;
    all.j(row, place - free_.begin()) = variables_[k].dp_du(u[k]) / sigma;
  }
  if (!all.r.allFinite() || !all.j.allFinite()) return {};
  if (task_.progress) {
    task_.progress(evaluations_, std::sqrt(squares / static_cast<double>(runs_.count())));
  }
  return all;
}

/// The last one is kept: a search asks for residuals first, then for derivatives.
const FitSearch::Linear& FitSearch::at(In x) {
  if (seen_ && std::ranges::equal(x, seen_x_)) return seen_;
  seen_ = linear(u_of(x), RecordRuns::Finer::no);
  seen_x_.assign(x.begin(), x.end());
  return seen_;
}

/// From x_, of the free parameters. Returns why it did not converge.
std::string FitSearch::search() {
  seen_.reset();
  if (free_.empty()) return {};
  const std::vector<double> start = x_;
  const std::size_t p = free_.size(), n = rows();
  const auto residual = [&](In x, Out r) {
    const Linear& here = at(x);
    if (!here) return false;
    std::ranges::copy(here->r, r.begin());
    for (std::size_t k = 0; k < p; ++k) {
      const FitVariable& variable = variables_[free_[k]];
      r[n + k] = (variable.u(x[k]) - variable.u(start[k])) / weak_prior;
    }
    return true;
  };
  const auto derivative = [&](In x, Out jacobian) {
    const Linear& here = at(x);
    if (!here) return false;
    std::ranges::fill(jacobian, 0.0);
    for (std::size_t k = 0; k < p; ++k) {
      const double slope = variables_[free_[k]].du_dx(x[k]);
      for (std::size_t i = 0; i < n; ++i) {
        jacobian[i * p + k] =
            slope * here->j(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      }
      jacobian[(n + k) * p + k] = slope / weak_prior;
    }
    return true;
  };
  const LeastSquares least =
      least_squares(residual, derivative, start, n + p, search_tolerance);
  if (!least.x.empty()) x_ = least.x;
  return least.failure;
}

/// Whether some value has come to its bound: there it stays, and the others go on.
bool FitSearch::hold_at_bounds() {
  std::vector<std::size_t> free;
  std::vector<double> x;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const std::size_t k = free_[i];
    if (variables_[k].at_bound(x_[i])) {
      held_[k] = variables_[k].u(std::copysign(1.5707963267948966, std::sin(x_[i])));
    } else {
      free.push_back(k);
      x.push_back(x_[i]);
    }
  }
  const bool held = free.size() < free_.size();
  free_ = std::move(free);
  x_ = std::move(x);
  return held;
}

void FitSearch::go_to(Place place) {
  held_ = std::move(place.held);
  free_ = std::move(place.free);
  x_ = std::move(place.x);
  seen_.reset();
}

void FitSearch::hold(std::size_t k, double u) {
  const auto at = std::ranges::find(free_, k) - free_.begin();
  held_[k] = u;
  free_.erase(free_.begin() + at);
  x_.erase(x_.begin() + at);
  seen_.reset();
}

std::string FitSearch::run() {
  std::string failed;
  do {
    failed = search();
  } while (hold_at_bounds());
  return free_.empty() ? std::string() : failed;
}

}  // namespace tress::simulation
