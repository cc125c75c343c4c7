#pragma once

#include <barrier>
#include <functional>
#include <thread>
#include <vector>

#include "contract/layers.h"

namespace tress::simulation {

/// Threads that share loops: run() calls work(i) for every i < count once, worker w the
/// indices w, w + workers, ... so who computes what does not depend on timing.
class Crew {
 public:
  explicit Crew(int workers);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// Returns when all is done. `work` must not throw.
  void run(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  void share(std::size_t worker);

  std::size_t workers_;
  std::size_t count_ = 0;
  const std::function<void(std::size_t)>* work_ = nullptr;  // null: go home
  std::barrier<> gate_;
  std::vector<std::jthread> threads_;  // all workers but the caller
};

}  // namespace tress::simulation
