#pragma once

#include <functional>
#include <memory>

#include "contract/layers.h"

namespace tress::simulation {

/// A number of threads of oneTBB for loops, the caller among them, at most the number
/// of processors. Which of them calls what depends on timing: what is called must not.
/// A crew of one calls in turn.
class Crew {
 public:
  /// Starts a crew of this many threads, at most the number of processors.
  explicit Crew(int threads);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// Calls work(i) once for every i < count and returns when all is done. `work` must not
  /// throw.
  void run(std::size_t count, const std::function<void(std::size_t)>& work);
  /// Runs `work` with the number of the worker, which no two calls have at the same time:
  /// for memory that calls overwrite.
  void run(std::size_t count,
           const std::function<void(std::size_t i, std::size_t worker)>& work);
  /// Returns the number of threads.
  std::size_t workers() const { return workers_; }

 private:
  struct Arena;

  std::size_t workers_;
  std::unique_ptr<Arena> arena_;  // null: one worker
};

/// Calls use(k, part) for k in [begin, end), in `parts` parts that work at the same
/// time. A part ends at its first error; rethrows that of the first k that has one.
void in_parts(Crew& crew, std::size_t begin, std::size_t end, std::size_t parts,
              const std::function<void(std::size_t k, std::size_t part)>& use);

}  // namespace tress::simulation
