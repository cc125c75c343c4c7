#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "contract/layers.h"

namespace tress::experiments {

/// SIGINT and SIGTERM end the program at any moment, whatever its other threads are at: a
/// thread of its own waits for them, calls what is to be saved, says that --resume goes
/// on, and leaves with exit code 130. A second signal ends the program at once.
///
/// To be made before any other thread: all later ones inherit that they are not
/// disturbed.
class Interruption {
 public:
  explicit Interruption(std::string_view program);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// While one lives no signal is answered: for what must be done whole or not at all.
  [[nodiscard]] std::unique_lock<std::mutex> hold() { return std::unique_lock(mutex_); }

  /// While it lives a signal calls `save` before the end.
  class Save {
   public:
    Save(Interruption& of, std::function<void()> save);
    ~Save();
    Save(const Save&) = delete;
    Save& operator=(const Save&) = delete;

   private:
    Interruption& of_;
  };

 private:
  void wait();

  std::string program_;
  std::mutex mutex_;
  std::function<void()> save_;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

}  // namespace tress::experiments
