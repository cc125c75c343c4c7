#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "contract/layers.h"

namespace tress::experiments {

/// Says every few seconds on standard error what a long computation is doing, from a
/// thread of its own: "name: reference, 80 elements (12 s)".
class Heartbeat {
 public:
  /// `loud`: false says nothing.
  Heartbeat(std::string name, bool loud,
            std::chrono::milliseconds between = std::chrono::seconds(4));
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

  /// What is being done from now on.
  void doing(std::string what);

 private:
  void beat(const std::stop_token& ended);

  std::string name_, what_ = "reading";
  std::chrono::milliseconds between_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;
};

}  // namespace tress::experiments
