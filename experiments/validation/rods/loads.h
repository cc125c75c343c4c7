#pragma once

#include <vector>

#include "math/vec3.h"
#include "models/effects/effect.h"

/// Loads of a strand in a test of statics. Time is the load factor: 0 none, 1 full.
namespace tress::experiments::validation {

/// Gravity g t (m/s^2). O(points).
class Weight final : public Effect {
 public:
  explicit Weight(const Vec& gravity) : g_(gravity) {}

  std::string_view name() const override { return "weight"; }
  Needs needs() const override { return {}; }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double t, const Points& p) const noexcept override;
  double power(double, const Points&) const noexcept override { return 0; }

 private:
  Vec g_;
};

/// Interpolates the tip from the last points. If the last point is a node it is the tip.
/// Gauss points of a segment stop short of the tip. A quantity that is smooth along the
/// segment is then sum_k w_k f_k at the tip, by the polynomial through the points of the
/// last segment. Exact for cubic splines and rigid links. For a helix the tip position is
/// off by 6e-4 kappa^3 h^4 or less with four points. It is off by less with the
/// additional points that models take for a large angle kappa h.
class TipPoints {
 public:
  explicit TipPoints(int elements) : elements_(elements) {}
  /// w of the last points, one per entry.
  const std::vector<double>& weights(const Points& p) const;

 private:
  int elements_;
  mutable std::vector<double> weights_{1};  // as last requested: for one model
};

/// A dead force (N) on the tip, constant in direction and size. w_k F acts on each of the
/// TipPoints, with the same work.
class TipForce final : public Effect {
 public:
  explicit TipForce(int elements) : tip_(elements) {}

  Vec force{};  // changes during the search for equilibrium

  std::string_view name() const override { return "tip_force"; }
  Needs needs() const override { return {}; }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double t, const Points& p) const noexcept override;
  double power(double, const Points&) const noexcept override { return 0; }

 private:
  TipPoints tip_;
};

}  // namespace tress::experiments::validation
