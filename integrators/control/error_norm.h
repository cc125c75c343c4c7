#pragma once

#include <string>
#include <vector>

#include "contract/forms/material_points.h"
#include "integrators/control/point_norm.h"
#include "integrators/formulation/dynamics.h"

namespace tress::integrators {

/// Size of an error of coordinates and velocities by the material points that it moves
/// (PointNorm). Coordinates alone miss energy, and generalised velocities count twist
/// that moves nothing. But frames that move no point must not leave their solution
/// unseen: coordinates over System::scale count too, a fifteenth of them. (Seven strand
/// models in hard cases by tr_bdf2 at 1e-3: 325 of 259 625 steps were above that by a
/// quarter or more; where elements of corde and xpbd_cosserat turned over, which released
/// a hundred times the energy of the fall, they were 1.3 to 4.6 times as large.) A body
/// without length is measured by its coordinates and velocities alone.
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
