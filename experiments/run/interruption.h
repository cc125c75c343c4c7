#pragma once

#include <signal.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "contract/layers.h"

namespace tress::experiments {

/// Handles stop_signals() whatever the other threads are doing: a dedicated thread waits
/// for them, calls the registered `save`, prints that --resume continues the run,
/// and exits with code 130. A second signal ends the program at once.
///
/// Construct before any other thread: later threads inherit the blocked signals.
class Interruption {
  /// Something that a signal asks for, while this exists.
  template <class Answer>
  class Asked {
   public:
    Asked(Interruption& of, std::function<Answer()>& at, std::function<Answer()> asked)
        : of_(of), at_(at) {
      const auto held = of_.hold();
      at_ = std::move(asked);
    }
    ~Asked() {
      const auto held = of_.hold();
      at_ = nullptr;
    }
    Asked(const Asked&) = delete;
    Asked& operator=(const Asked&) = delete;

   private:
    Interruption& of_;
    std::function<Answer()>& at_;
  };

 public:
  explicit Interruption(std::string_view program);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// No signal is handled while a hold exists: for operations that must be atomic.
  [[nodiscard]] std::unique_lock<std::mutex> hold() { return std::unique_lock(mutex_); }

  /// While it exists, a signal ends the program without saving or a word if `silent()`:
  /// another process has said why all end.
  class Silence : Asked<bool> {
   public:
    Silence(Interruption& of, std::function<bool()> silent)
        : Asked(of, of.silent_, std::move(silent)) {}
  };

  /// While it exists, a signal calls `save` before the program ends.
  class Save : Asked<void> {
   public:
    Save(Interruption& of, std::function<void()> save)
        : Asked(of, of.save_, std::move(save)) {}
  };

 private:
  void wait();

  std::string program_;
  sigset_t signals_;
  std::mutex mutex_;
  std::function<void()> save_;
  std::function<bool()> silent_;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

}  // namespace tress::experiments
