#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "contract/layers.h"

namespace tress::experiments {

/// Handles SIGINT and SIGTERM whatever the other threads are doing: a dedicated thread
/// waits for them, calls the registered `save`, prints that --resume continues the run,
/// and exits with code 130. A second signal ends the program at once.
///
/// Construct before any other thread: later threads inherit the blocked signals.
class Interruption {
 public:
  explicit Interruption(std::string_view program);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// No signal is handled while a hold exists: for operations that must be atomic.
  [[nodiscard]] std::unique_lock<std::mutex> hold() { return std::unique_lock(mutex_); }

  /// While it exists, a signal ends the program without saving or a word if `silent()`:
  /// another process has said why all end.
  class Silence {
   public:
    Silence(Interruption& of, std::function<bool()> silent);
    ~Silence();
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;

   private:
    Interruption& of_;
  };

  /// While it exists, a signal calls `save` before the program ends.
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
  std::function<bool()> silent_;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

}  // namespace tress::experiments
