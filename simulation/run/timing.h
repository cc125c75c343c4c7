#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

#include "contract/layers.h"

namespace tress::simulation {

/// The middle value (mean of the two middle ones); 0 if empty.
double median(std::vector<double> values);

/// Returns the wall time of one call (s). Processor time of the thread is not used: on a
/// virtual machine that clock may stand still for some milliseconds. Neither minimum nor
/// median of several times corrects that.
template <typename F>
double seconds_of(F&& f) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  f();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Time since its construction on this thread, as if nothing else ran on the machine (s).
/// A short span is wall time: on a virtual machine the thread's processor clock may stand
/// still for some milliseconds. A longer span is processor time, which other load on the
/// machine hardly lengthens. Only for work that stays on this thread.
class ThreadTimer {
 public:
  static constexpr double short_s = 0.02;  // Length of a short span, s.

  /// Starts the clock.
  ThreadTimer() : wall_(Clock::now()), processor_s_(processor_s()) {}
  /// Returns the wall time since construction, s.
  double wall_s() const {
    return std::chrono::duration<double>(Clock::now() - wall_).count();
  }
  /// Returns the time since construction, s.
  double seconds() const {
    const double wall = wall_s();
    return wall < short_s ? wall : processor_s() - processor_s_;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double processor_s();

  Clock::time_point wall_;
  double processor_s_;
};

/// Times of repeated calls, in s. Tables show the median: the minimum is an unusually
/// fast run, and one interruption distorts the mean.
struct Timing {
  double median_s = 0, min_s = 0;  // median and least time, s
  int repeats = 0;                 // number of calls
};
/// Returns the median and the least of times (s).
Timing summarize(const std::vector<double>& seconds);

/// Calls f `repeats` times, at least once.
template <typename F>
Timing time_calls(int repeats, F&& f) {
  std::vector<double> seconds;
  for (int i = 0; i < std::max(repeats, 1); ++i) seconds.push_back(seconds_of(f));
  return summarize(seconds);
}

/// Measures as above, after one unmeasured call (caches, lazy allocation).
template <typename F>
Timing time_it(int repeats, F&& f) {
  f();
  return time_calls(repeats, f);
}

/// A longer run is timed once: one interruption is a small part of it.
inline constexpr double long_run_s = 0.05;

/// Median wall time (s) of whole runs: one if it is long, `repeats` otherwise, after an
/// uncounted one that warms the caches.
template <typename F>
double time_run(int repeats, F&& f) {
  const double first = seconds_of(f);
  return first > long_run_s ? first : time_calls(repeats, f).median_s;
}

}  // namespace tress::simulation
