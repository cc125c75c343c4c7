#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <new>
#include <stdexcept>
#include <thread>

#include "experiments/hard_cases/survival.h"

namespace tress::experiments::hard_cases {
namespace {

enum Stage : int { unknown, in_work, known };

}  // namespace

struct References::Slot {
  std::atomic<int> state{unknown};
  int tips = 0;
  double gap = 0;
  double tip[3 * Reference::samples]{};
  char why[400]{};
};

References::References(std::size_t count) : count_(std::max<std::size_t>(count, 1)) {
  static_assert(std::atomic<int>::is_always_lock_free);
  void* memory = mmap(nullptr, count_ * sizeof(Slot), PROT_READ | PROT_WRITE,
                      MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no memory for references");
  slots_ = static_cast<Slot*>(memory);
  for (std::size_t i = 0; i < count_; ++i) new (slots_ + i) Slot;
}

References::~References() { munmap(slots_, count_ * sizeof(Slot)); }

Reference References::get(std::size_t index, double patience_s,
                          const std::function<Reference()>& compute) {
  Slot& slot = slots_[index];
  int expected = unknown;
  if (slot.state.compare_exchange_strong(expected, in_work)) {
    Reference found = compute();
    const std::size_t tips = std::min(found.tip.size(), std::size(slot.tip));
    std::copy_n(found.tip.begin(), tips, slot.tip);
    slot.tips = static_cast<int>(tips);
    slot.gap = found.gap;
    std::strncpy(slot.why, found.why.c_str(), sizeof slot.why - 1);
    slot.state = known;
    return found;
  }
  using Clock = std::chrono::steady_clock;
  const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(patience_s));
  while (slot.state != known) {
    if (Clock::now() > until) return {{}, 0, "its reference was not finished"};
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return {{slot.tip, slot.tip + slot.tips}, slot.gap, slot.why};
}

}  // namespace tress::experiments::hard_cases
