#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "contract/layers.h"

namespace tress::experiments::scene_runs {

/// Lets the thread that handles signals request that the run saves itself between two
/// steps. A permanent copy of the state for a signal at any time would double the memory.
class StopRequest {
 public:
  bool asked() const { return asked_; }
  /// Asks the run to stop, called by the thread of signals: returns when the run has
  /// answered. A run of several ranks may wait in vain for one that was killed, and
  /// mpirun ends it a second later.
  void ask(bool ranks) {
    constexpr std::chrono::milliseconds before_mpirun_kills(800);
    asked_ = true;
    std::unique_lock lock(mutex_);
    const auto answered = [this] { return answered_; };
    if (!ranks) changed_.wait(lock, answered);
    if (ranks && !changed_.wait_for(lock, before_mpirun_kills, answered)) {
      throw std::runtime_error(
          "its ranks do not answer (mpirun prints if one was killed): the "
          "same command with --resume continues from the last saved state");
    }
    if (!problem_.empty()) throw std::runtime_error(problem_);
  }
  /// Answers the request, called by the run when it has saved itself or is over.
  void answer(std::string problem = {}) {
    const std::lock_guard lock(mutex_);
    answered_ = true;
    problem_ = std::move(problem);
    changed_.notify_all();
  }

 private:
  std::atomic<bool> asked_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool answered_ = false;
  std::string problem_;
};

}  // namespace tress::experiments::scene_runs
