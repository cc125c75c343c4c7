#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "simulation/fit/record_runs.h"
#include "simulation/fit/scene_fit.h"

namespace tress::simulation {

/// Weighted residuals of records, then of priors, and their derivatives by the free
/// unknowns u of FitVariable.
struct LinearizedFit {
  Eigen::VectorXd r;  // weighted residuals (n)
  Eigen::MatrixXd j;  // dr/du (n x free unknowns)
};

/// The search for the least squares of fit_scenes(). Parameters that come to a bound are
/// held there, and the others go on.
class FitSearch {
 public:
  /// Throws InputError as fit_scenes() does. `task` must outlive it.
  explicit FitSearch(const FitTask& task);

  /// Returns why the search did not converge; empty: it did.
  std::string run();

  /// State of a search.
  struct Place {
    std::vector<std::optional<double>> held;  // u of parameters that are held
    std::vector<std::size_t> free;            // the others
    std::vector<double> x;                    // of these
  };
  /// Returns where the search is.
  Place place() const { return {held_, free_, x_}; }
  /// Moves the search there.
  void go_to(Place place);
  /// Holds free parameter k at u: run() then searches for the others from where they are.
  void hold(std::size_t k, double u);

  /// Returns the runs of the records.
  const RecordRuns& runs() const { return runs_; }
  /// Returns the variables of all parameters, in order.
  const std::vector<FitVariable>& variables() const { return variables_; }
  /// Parameters that are not held at a bound, in order.
  const std::vector<std::size_t>& free() const { return free_; }
  /// Returns whether parameter k is held: after run() alone, at a bound.
  bool held(std::size_t k) const { return held_[k].has_value(); }
  /// Unknowns of all parameters where the search is.
  std::vector<double> u() const { return u_of(x_); }
  /// Returns the values of all parameters at u(), in their units.
  std::vector<double> values() const { return values(u()); }
  /// Returns the number of residuals: coordinates of the records, then priors.
  std::size_t rows() const { return runs_.count() + priors_.size(); }
  /// Returns the number of runs of all records with their derivatives.
  int evaluations() const { return evaluations_; }
  /// Returns both at u(), from runs that are refined. Empty: a run fails, for the reason
  /// failure().
  std::optional<LinearizedFit> linear(RecordRuns::Finer finer) {
    return finer == RecordRuns::Finer::no ? at(x_) : linear(u(), finer);
  }
  /// Returns why a run of the last evaluation failed; empty if none did.
  const std::string& failure() const { return failure_; }
  /// Coordinates of the last linear() (m).
  In simulated() const { return simulated_; }

 private:
  using Linear = std::optional<LinearizedFit>;
  struct Prior {
    std::size_t parameter;
    double value, sigma;
  };

  std::vector<double> u_of(In x) const;
  std::vector<double> values(const std::vector<double>& u) const;
  Linear linear(const std::vector<double>& u, RecordRuns::Finer finer);
  const Linear& at(In x);
  std::string search();
  bool hold_at_bounds();

  const FitTask& task_;
  RecordRuns runs_;
  std::vector<FitVariable> variables_;
  std::vector<Prior> priors_;
  std::vector<std::optional<double>> held_;  // u of parameters that are held
  std::vector<std::size_t> free_;            // the others
  std::vector<double> x_;                    // of free_
  std::vector<double> seen_x_, simulated_, by_;
  Linear seen_;
  std::string failure_;
  int evaluations_ = 0;
};

}  // namespace tress::simulation
