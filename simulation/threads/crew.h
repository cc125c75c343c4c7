#pragma once

#include <barrier>
#include <functional>
#include <thread>
#include <vector>

#include "contract/layers.h"

namespace tress::simulation {

/// Thread pool for loops: run() calls work(i) once for every i < count, worker w with the
/// indices w, w + workers, ... so the assignment does not depend on timing.
class Crew {
 public:
  explicit Crew(int workers);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// Returns when all is done. `work` must not throw.
  void run(std::size_t count, const std::function<void(std::size_t)>& work);
  std::size_t workers() const { return workers_; }

 private:
  void share(std::size_t worker);

  std::size_t workers_;
  std::size_t count_ = 0;
  const std::function<void(std::size_t)>* work_ = nullptr;  // null: threads exit
  std::barrier<> gate_;
  std::vector<std::jthread> threads_;  // all workers except the caller
};

/// Calls use(k, part) for k in [begin, end), in so many parts that work at the same time.
/// A part ends at its first error; rethrows that of the first k that has one.
void in_parts(Crew& crew, std::size_t begin, std::size_t end, std::size_t parts,
              const std::function<void(std::size_t k, std::size_t part)>& use);

}  // namespace tress::simulation
