#pragma once

#include <string>
#include <vector>

#include "integrators/formulation/dynamics.h"
#include "integrators/point_norm.h"

namespace tress::integrators {

/// Size of an error of coordinates and velocities by the material points that it moves
/// (PointNorm). Coordinates alone miss energy, and generalised velocities count twist
/// that moves nothing. A body without length is measured by its coordinates over
/// System::scale.
class ErrorNorm {
 public:
  explicit ErrorNorm(Dynamics& dynamics);

  void start(double t, In q);

  /// Of the error (dq, dv) of the state (q, v).
  double of(double t, In q, In v, In dq, In dv);

  /// What the last value came from: "velocity of point 7".
  std::string where() const;

  /// Time (s) in which the body falls about its own size.
  double typical_time() const { return time_; }

 private:
  Dynamics& dynamics_;
  MaterialPoints* points_;
  PointNorm norm_;
  double time_ = 0;
  bool velocity_ = false;  // of a body without length
  std::vector<double> x_, shifted_x_, u_, shifted_u_, q_, v_;
};

}  // namespace tress::integrators
