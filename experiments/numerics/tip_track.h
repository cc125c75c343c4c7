#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "contract/forms/material_points.h"
#include "contract/integrator.h"
#include "math/vec3.h"
#include "simulation/run/guard.h"

namespace tress::experiments {

/// Positions of a tip, the last material point, at t_end k / count, k = 1 .. count. Fixed
/// steps do not land on these times: in between, the tip follows the cubic Hermite
/// interpolant of the step, whose error falls as the fourth power of the step. Positions
/// are read during the run: the meaning of q may change as it goes on (System::accept).
class TipSamples {
 public:
  /// `growth`: largest ratio of successive steps.
  TipSamples(System& system, double t_end, int count, double growth);

  /// s, of sample k, 1 .. count; exact, for those who stop there.
  static double time(double t_end, int k, int count) {
    return t_end * (static_cast<double>(k) / count);
  }

  void start(In q, In v);
  void step_to(double t, In q, In v);

  std::vector<double> tips;  // (3 samples), so far

 private:
  struct End {
    double t;
    Vec x, u;
  };

  double next() const;
  End read(double t, In q, In v);
  void interpolate(const End& now);

  MaterialPoints& points_;
  double t_end_;
  int count_;
  double growth_;
  std::vector<double> x_;
  End before_{};
};

/// One run of a strand from its initial state, sampled at its tip.
struct TipRun {
  Status status;
  std::string failure;
  Stats stats;
  double wall_s;            // stepping only, without setup and reading the tip
  std::vector<double> tip;  // (3 samples) m; fewer when the run failed
  int unknowns;             // coordinates
  Limit limit;              // of Options that ended it, if any
};

/// Runs to t_end; samples the tip by TipSamples. With a tolerance, steps are long, and
/// the method itself interpolates the states at the samples' times within its tolerance.
/// With repeat = 0, or after a failure, there is one untimed run. Otherwise the time is
/// the median, as in time_run. `guard` watches the first run, not the timed ones; a
/// breach is the run's failure.
TipRun run_tip(std::string_view integrator, System& system, const Options& options,
               double t_end, int samples, int repeat = 0, Guard* guard = nullptr);

/// Root mean square distance over the samples, over `length`; infinite when a sample is
/// missing or not finite.
double tip_error(In tip, In reference, double length);

/// Returns the largest distance of the tips, over the length.
double largest_tip_error(In tip, In reference, double length);

}  // namespace tress::experiments
