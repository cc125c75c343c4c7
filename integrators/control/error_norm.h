#pragma once

#include <string>
#include <vector>

#include "contract/forms/material_points.h"
#include "integrators/control/point_norm.h"
#include "integrators/formulation/dynamics.h"

namespace tress::integrators {

/// Size of an error of coordinates and velocities by the material points that it moves
/// (PointNorm). Coordinates alone miss energy, and generalised velocities count twist
/// that moves nothing. Errors of frames that move no point must count as well:
/// coordinates over System::scale count with a factor of 1/15. In tests of seven strand
/// models in hard cases with tr_bdf2 at 1e-3, 325 of 259 625 steps exceeded that by a
/// quarter or more. Where elements of corde and xpbd_cosserat turned over, which released
/// a hundred times the energy of the fall, the excess was a factor of 1.3 to 4.6. A body
/// without length is measured by its coordinates and velocities alone.
class ErrorNorm {
 public:
  /// Uses the material points and scales of the system of `dynamics`.
  explicit ErrorNorm(Dynamics& dynamics);

  /// Takes the length of the body from the state at the start of a run.
  void start(double t, In q);

  /// Returns the size of the error (dq, dv) of the state (q, v).
  double of(double t, In q, In v, In dq, In dv);

  /// Names the origin of the last value: "velocity of point 7".
  std::string where() const;

  /// Time (s) in which the body falls about its own size.
  double typical_time() const { return time_; }
  /// Speed (m/s) whose size is 1.
  double typical_speed() const { return norm_.length() / time_; }

 private:
  enum class From { points, coordinates, velocities };

  Dynamics& dynamics_;
  MaterialPoints* points_;
  PointNorm norm_;
  double time_ = 0;
  From from_ = From::points;  // of the last value
  std::vector<double> x_, shifted_x_, u_, shifted_u_, q_, v_;
};

}  // namespace tress::integrators
