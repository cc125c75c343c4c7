#pragma once

#include <vector>

#include "math/vec3.h"
#include "models/effects/effect.h"

/// What loads a strand in a test of statics. Time is the load: 0 none, 1 all of it.
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

/// The tip by the last points. Where the last one is a node it is the tip. Points of
/// Gauss's rule in each segment stop short of it: there what is smooth along the segment
/// is at the tip sum_k w_k f_k, the polynomial through the points of the last segment.
/// Exact for cubic splines and rigid links; the place of a helix's tip is off by 6e-4
/// kappa^3 h^4 or less with four points, and with the more that models take for a large
/// angle kappa h by less.
class TipPoints {
 public:
  explicit TipPoints(int elements) : elements_(elements) {}
  /// w of the last points, as many as it has entries.
  const std::vector<double>& weights(const Points& p) const;

 private:
  int elements_;
  mutable std::vector<double> weights_{1};  // as last asked for: those of one model
};

/// A force (N) on the tip, dead: constant in direction and size. w_k F acts on each of
/// the TipPoints, with the same work.
class TipForce final : public Effect {
 public:
  explicit TipForce(int elements) : tip_(elements) {}

  Vec force{};  // changes while equilibrium is sought

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

/// A force P (N) that pushes the tip back along the strand's own tangent there: -P w_k
/// t_k on each of the TipPoints, so that its work -P t . dx is that at the tip. It has no
/// potential.
class FollowerForce final : public Effect {
 public:
  FollowerForce(int elements, double force) : tip_(elements), force_(force) {}

  std::string_view name() const override { return "follower_force"; }
  Needs needs() const override { return {.tangent = true, .directions = true}; }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  void add_direction_derivatives(double t, const Points& p, double factor,
                                 InOut blocks) const noexcept override;
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double t, const Points& p) const noexcept override;

 private:
  TipPoints tip_;
  double force_;
};

}  // namespace tress::experiments::validation
