#pragma once

#include <chrono>

namespace tress::experiments::scene_runs {

/// When a state is saved by the clock, so that a run which is killed loses little.
class SaveClock {
 public:
  /// `every` (s); 0: at every frame.
  explicit SaveClock(double every) : every_(every) {}

  bool due() const { return Clock::now() - last_ >= every_; }
  void saved() { last_ = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;
  std::chrono::duration<double> every_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace tress::experiments::scene_runs
