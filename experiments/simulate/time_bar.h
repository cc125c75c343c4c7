#pragma once

#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/run/command_line.h"
#include "experiments/run/message.h"
#include "experiments/run/progress.h"
#include "simulation/scene/scene.h"

namespace tress::experiments::scene_runs {

/// Simulated time, wall time and the remaining time, on standard error.
class TimeBar {
 public:
  /// Starts the bar at the simulated time `from`, at which the run continues.
  TimeBar(ProgressMode mode, const simulation::Scene& scene, double from,
          Heartbeat& heartbeat)
      : mode_(mode),
        heartbeat_(heartbeat),
        terminal_(::isatty(STDERR_FILENO) != 0),
        scene_(scene),
        from_(from) {
    at(from);
  }
  TimeBar(const TimeBar&) = delete;
  TimeBar& operator=(const TimeBar&) = delete;
  ~TimeBar() {
    if (mode_ == ProgressMode::automatic && terminal_) tell("\r\033[K");
  }

  void show(double t) {
    at(t);
    const double wall = std::chrono::duration<double>(Clock::now() - start_).count();
    if (mode_ == ProgressMode::none || wall - last_ < (terminal_ ? 0.1 : 5.0)) return;
    last_ = wall;
    heartbeat_.told();
    const double left = wall * (scene_.duration - t) / (t - from_);
    if (mode_ == ProgressMode::json) {
      const nlohmann::json event{
          {"event", "frame"}, {"scene", scene_.name}, {"t_s", t}, {"wall_s", wall}};
      tell("{}\n", event.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
      return;
    }
    constexpr int width = 30;
    const auto full = static_cast<std::size_t>(width * t / scene_.duration);
    tell("{}{} [{}{}] {:.2f}/{:.2f} s simulated in {:.1f} s, about {} left{}",
         terminal_ ? "\r" : "", scene_.name, std::string(full, '#'),
         std::string(width - full, '.'), t, scene_.duration, wall,
         readable_duration(left), terminal_ ? "\033[K" : "\n");
  }

 private:
  using Clock = std::chrono::steady_clock;
  void at(double t) {
    heartbeat_.doing(
        fmt::format("{}: at {:.4g} s of {:.4g} s", scene_.name, t, scene_.duration));
  }

  ProgressMode mode_;
  Heartbeat& heartbeat_;
  bool terminal_;
  const simulation::Scene& scene_;
  double from_;  // s
  Clock::time_point start_ = Clock::now();
  double last_ = 0;
};

}  // namespace tress::experiments::scene_runs
