#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "experiments/run/command_line.h"
#include "simulation/files/row.h"

namespace tress::experiments {

/// How far a sweep is, on standard error: a bar with the time left on a terminal, a plain
/// line now and then otherwise, one JSON object per row with `json`, nothing with `none`.
class Progress {
 public:
  Progress(ProgressMode mode, std::string_view name, std::size_t rows);
  ~Progress();  // clears the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// A row that took so long.
  void finished(const Row& row, double seconds);

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

/// 42 s, 3 min 20 s, 2 h 05 min.
std::string readable_duration(double seconds);

}  // namespace tress::experiments
