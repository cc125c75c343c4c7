#include "experiments/run/heartbeat.h"

#include <cmath>
#include <stop_token>
#include <utility>

#include "experiments/run/message.h"

namespace tress::experiments {

Heartbeat::Heartbeat(std::string name, bool loud, std::chrono::milliseconds between)
    : name_(std::move(name)), between_(between) {
  if (!loud) return;
  thread_ = std::jthread([this](const std::stop_token& ended) { beat(ended); });
}

Heartbeat::~Heartbeat() {
  thread_.request_stop();
  wake_.notify_all();
}

void Heartbeat::doing(std::string what) {
  const std::lock_guard lock(mutex_);
  what_ = std::move(what);
}

void Heartbeat::beat(const std::stop_token& ended) {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, ended, between_, [] { return false; }) &&
         !ended.stop_requested()) {
    const std::chrono::duration<double> so_far =
        std::chrono::steady_clock::now() - start_;
    tell("{}: {} ({:.0f} s)\n", name_, what_, so_far.count());
  }
}

}  // namespace tress::experiments
