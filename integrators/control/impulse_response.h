#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contract/forms/material_points.h"
#include "integrators/formulation/dynamics.h"

namespace tress::integrators {

/// Response of a strand to forces f on its material points that act during a step of h
/// and are known at its end. Several strands may be solved as one system:
///
///     v = v* + h a,   q = q* + h^2 a,   S(1, h, h^2) a = J^T f,   J = du/dv
///
/// S is evaluated at the state (q*, v*) at the end of the step without the forces, with
/// the acceleration that led there. Constraints of the strand are satisfied. A method may
/// step several strands as one system, of which this strand is a part or all. J comes
/// from MaterialPoints::mean() or jacobian(), or column by column from velocities().
/// Models with pull_back() or responses() compute the products directly.
class ImpulseResponse {
 public:
  /// `first`: the strand's first coordinate among those of the method.
  ImpulseResponse(System& strand, const Integrator& method, const Options& options,
                  std::size_t first = 0);

  /// Prepares the response at the end of a step; v_before: the strand's velocity at the
  /// start of the step. Returns `retry` if S is singular.
  Status prepare(double h, In v_before) noexcept;
  /// Computes the compliance of these points, velocity per force (m/s per N), as
  /// row-major 3x3 blocks: the response to the force on the first point comes first, then
  /// the second.
  Status compliance(std::span<const int> points, std::vector<double>& blocks);
  /// The state after forces on those points (3 numbers each, N).
  Status respond(std::span<const int> points, In forces) noexcept;
  /// Returns the coordinates after respond().
  In q() const { return q_; }
  /// Returns the rates after respond().
  In v() const { return v_; }

 private:
  void differentiate() noexcept;
  void pull_back(int point, const double* force, InOut r) const noexcept;
  void velocity(int point, In v, double* u) const noexcept;

  /// Returns the coordinates of the strand without the forces.
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
