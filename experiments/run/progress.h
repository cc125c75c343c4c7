#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "experiments/run/command_line.h"
#include "simulation/files/row.h"

namespace tress::experiments {

/// Progress of a sweep on standard error: a bar with the remaining time on a terminal,
/// else occasional plain lines; one JSON object per row with `json`, nothing with `none`.
class Progress {
 public:
  Progress(ProgressMode mode, std::string_view name, std::size_t rows);
  ~Progress();  // clears the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// A row that took `seconds`.
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

/// Formats as 42 s, 3 min 20 s, 2 h 05 min.
std::string readable_duration(double seconds);

}  // namespace tress::experiments
