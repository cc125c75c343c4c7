#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "experiments/run/command_line.h"
#include "simulation/files/row.h"

namespace tress::experiments {

/// A program that works tells something at least that often.
inline constexpr std::chrono::seconds between_lines{5};

/// Progress of a sweep on standard error. A terminal shows a bar with the remaining time,
/// otherwise a plain line is printed every five seconds. `json` prints one object per
/// row, and every five seconds without one; `none` prints nothing.
class Progress {
 public:
  Progress(ProgressMode mode, std::string_view name, std::size_t rows);
  ~Progress();  // clears the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// A row that took `seconds`.
  void finished(const Row& row, double seconds);
  /// Reports that no row has ended and that the row of `identity` has run for
  /// `seconds`.
  void running(const Row& identity, double seconds);

 private:
  enum class Style { bar, lines, json, none };
  using Clock = std::chrono::steady_clock;
  void print_bar(double left_s) const;

  Style style_;
  bool colour_;
  std::string name_;
  std::size_t rows_, done_ = 0, failed_ = 0;
  Clock::time_point start_, last_;
};

/// Tells on standard error what a program is doing, whenever it has told nothing for
/// five seconds.
class Heartbeat {
 public:
  Heartbeat(ProgressMode mode, std::string_view program);
  ~Heartbeat();  // clears its line of a terminal
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

  /// Sets the activity from now on.
  void doing(std::string what);
  /// Something was told: the five seconds begin again.
  void told();

 private:
  using Clock = std::chrono::steady_clock;
  void run();
  std::string line(Clock::time_point now) const;

  ProgressMode mode_;
  bool terminal_;
  std::string program_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool over_ = false;
  std::string doing_;
  Clock::time_point begun_ = Clock::now(), told_ = begun_;
  std::thread thread_;  // last: it uses all of the above
};

/// Formats as 42 s, 3 min 20 s, 2 h 05 min.
std::string readable_duration(double seconds);

}  // namespace tress::experiments
