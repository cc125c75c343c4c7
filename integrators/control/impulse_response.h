#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contract/forms/material_points.h"
#include "integrators/formulation/dynamics.h"

namespace tress::integrators {

/// How a strand, or some as one system, responds to forces f on its material points that
/// act during a step of h and are known at its end:
///
///     v = v* + h a,   q = q* + h^2 a,   S(1, h, h^2) a = J^T f,   J = du/dv
///
/// S at the state (q*, v*) at the end of the step without them, with the acceleration
/// that led there; constraints of the strand are held. A method may step several strands
/// as one system, of which this is a part or all. J comes from MaterialPoints::mean() or
/// jacobian(), or column by column from velocities(), unless the model knows what is
/// needed of it (pull_back(), responses()).
class ImpulseResponse {
 public:
  /// `first`: the strand's first coordinate among those of the method.
  ImpulseResponse(System& strand, const Integrator& method, const Options& options,
                  std::size_t first = 0);

  /// At the end of a step; v_before: the strand's at its start. `retry` if S is singular.
  Status prepare(double h, In v_before) noexcept;
  /// Of those points: velocities per force (m/s per N), row-major 3x3 blocks, those of
  /// the force on the first point, of the second ...
  Status compliance(std::span<const int> points, std::vector<double>& blocks);
  /// The state after forces on those points (3 numbers each, N).
  Status respond(std::span<const int> points, In forces) noexcept;
  In q() const { return q_; }
  In v() const { return v_; }

 private:
  void differentiate() noexcept;
  void pull_back(int point, const double* force, InOut r) const noexcept;
  void velocity(int point, In v, double* u) const noexcept;

  /// Of the strand, without the forces.
  In q_alone() const { return method_.q().subspan(first_, a_.size()); }
  In v_alone() const { return method_.v().subspan(first_, a_.size()); }

  System& system_;
  const Integrator& method_;
  std::size_t first_;
  Dynamics dynamics_;
  double h_ = 0;
  std::vector<std::optional<MaterialPoints::Mean>> means_;
  bool linear_;                   // every point is a mean of coordinates
  std::vector<double> jacobian_;  // (3 points x coordinates), otherwise
  bool differentiated_ = false;   // it is that of this step
  std::vector<double> a_, lambda_, r_, c_, q_, v_, u_, u_rest_;
};

}  // namespace tress::integrators
