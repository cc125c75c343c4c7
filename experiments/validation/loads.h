#pragma once

#include "models/effects/effect.h"
#include "models/math/vec3.h"

/// What loads a strand in a test of statics. Time is the load: 0 none, 1 all of it.
namespace tress {

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

/// A force (N) on the tip, dead: constant in direction and size. Where the last point is
/// a node it is the tip. Points of Gauss's rule in each segment stop short of it: there
/// the tip is sum_k w_k x_k, the polynomial through the points of the last segment, and
/// w_k F acts on each, with the same work. Exact for cubic splines and rigid links; of a
/// helix the tip is off by 6e-4 kappa^3 h^4 or less.
class TipForce final : public Effect {
 public:
  explicit TipForce(int elements);

  Vec force{};  // changes while equilibrium is sought

  std::string_view name() const override { return "tip_force"; }
  Needs needs() const override { return {}; }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double t, const Points& p) const noexcept override;
  double power(double, const Points&) const noexcept override { return 0; }

 private:
  /// Of the last points, as many as it has entries.
  const std::vector<double>& weights(const Points& p) const noexcept;

  int elements_;
  std::vector<std::vector<double>> rules_;  // of 4, 8, 12 ... points a segment
};

}  // namespace tress
