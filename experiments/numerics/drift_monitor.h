#pragma once

#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/forms/energetics.h"
#include "contract/forms/material_points.h"
#include "contract/system.h"

namespace tress::experiments {

/// Observes constraint violation and energy drift over a run; never allocates. Parametric
/// systems have no constraints: their violation is zero by construction.
class DriftMonitor {
 public:
  /// `escape` (m): a violation beyond it ends the run as diverged.
  DriftMonitor(System& system, In q, In v, double escape);

  bool operator()(double t, In q, In v);

  double g_max() const { return g_max_; }
  double g_final() const { return g_final_; }
  double g_rate_max() const { return g_rate_max_; }
  /// Largest |E - E_start| of a conservative system over the energy scale (largest
  /// kinetic energy reached); NaN when the system has no energetics.
  double energy_drift() const;
  /// Largest |length/rest - 1| of a segment; NaN when the system does not provide it.
  double length_error() const { return length_error_; }
  bool escaped() const { return escaped_; }

  /// The last time at which the violation was above `threshold`; set before the run.
  void watch_recovery(double threshold) { threshold_ = threshold; }
  double recovery_time() const { return recovery_time_; }
  /// Largest violation of the sign opposite to the initial one, over the initial one.
  double overshoot() const { return overshoot_; }

 private:
  ConstraintForm* constraints_;
  Energetics* energetics_;
  MaterialPoints* points_;
  double escape_;
  std::vector<double> g_, g_dot_, g_start_;
  double g_max_ = 0, g_final_ = 0, g_rate_max_ = 0;
  double energy_start_ = 0, energy_error_ = 0, kinetic_max_ = 0;
  double threshold_ = 0, recovery_time_ = 0, overshoot_ = 0;
  double length_error_ = 0;
  bool escaped_ = false;
};

/// Tracks the momentum drift over a run of a free body.
class MomentumDrift {
 public:
  /// Takes the state at t = 0. The system must provide its momentum.
  MomentumDrift(Energetics& energetics, In q, In v);
  void see(double t, In q, In v);

  double linear_start() const { return norm(start_.linear); }  // |p|, kg m/s
  double angular_start() const { return norm(start_.angular); }
  double angular_now() const { return norm(now_.angular); }
  /// Largest |p - p_start| and |L - L_start| so far.
  double linear() const { return linear_; }
  double angular() const { return angular_; }

 private:
  using Three = std::array<double, 3>;
  static double norm(const Three& x);
  static double distance(const Three& x, const Three& y);

  Energetics& energetics_;
  Momentum start_, now_;
  double linear_ = 0, angular_ = 0;
};

}  // namespace tress::experiments
