#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "simulation/scene/gradient_table.h"

namespace tress::simulation {

/// Limits of a fitted parameter, in its unit.
struct FitBound {
  std::string name;              // name of the parameter
  double low, high;              // lower and upper limit
  std::string place = "bounds";  // where they are given, in messages
};

/// Knowledge of a parameter from before the records: a normal distribution, in its unit.
struct FitPrior {
  std::string name;              // name of the parameter
  double value, sigma;           // mean and standard deviation
  std::string place = "priors";  // where it is given, in messages
};

/// Returns the bounds of "NAME:LOW:HIGH,NAME:LOW:HIGH". Throws InputError naming `where`.
std::vector<FitBound> parse_bounds(std::string_view text, const std::string& where);
/// Returns the priors of "NAME:VALUE:SIGMA,NAME:VALUE:SIGMA". Throws InputError naming
/// `where`.
std::vector<FitPrior> parse_priors(std::string_view text, const std::string& where);

/// A parameter p as an unknown. Statistics are those of
///
///     u = ln p where p must be positive, else p over its measure,
///
/// and the search is in x: u itself, or with bounds u = (a + b)/2 + (b - a)/2 sin x
/// [James, Roos 1975, Comput. Phys. Commun. 10, 343 (MINUIT)].
class FitVariable {
 public:
  /// `bound` may be null. Throws InputError on a bound that leaves no room, exceeds the
  /// range of the parameter, or excludes the start.
  FitVariable(const SceneParameter& parameter, const FitBound* bound);

  /// Returns whether u = ln p.
  bool logarithmic() const { return logarithmic_; }
  double start() const { return start_; }  // x
  /// Returns the unknown u at x.
  double u(double x) const;
  /// Returns the derivative of u by x.
  double du_dx(double x) const;
  /// Returns the value of the parameter at u, in its unit.
  double p(double u) const;
  /// Returns the derivative of the parameter by u, in its unit.
  double dp_du(double u) const;
  /// Returns the u within the bounds that is nearest to u.
  double within(double u) const;
  /// Whether x is at one of the bounds.
  bool at_bound(double x) const;

 private:
  bool logarithmic_;
  double measure_;
  double middle_ = 0, reach_ = 0;  // of u; no bounds: 0
  double start_;
};

}  // namespace tress::simulation
