#pragma once

#include "contract/system.h"

namespace tress::experiments {

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
