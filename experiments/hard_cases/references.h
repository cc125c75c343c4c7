#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/hard_cases/hard_case.h"

namespace tress::experiments::hard_cases {

/// The tip's trajectory by the same equations at a much finer step, and its distance over
/// the length from that at twice the finer step; `why` if there is none.
struct Reference {
  std::vector<double> tip;  // (3 samples)
  double gap = 0;
  std::string why;  // empty: the reference exists

  static constexpr int samples = 8;
};

/// References shared by the processes of the rows: the first to ask computes, the others
/// wait. Created before the processes fork, in shared memory.
class References {
 public:
  explicit References(std::size_t count);
  ~References();
  References(const References&) = delete;
  References& operator=(const References&) = delete;

  /// Reference `index`, by `compute` unless it is known. A caller that waits longer than
  /// `patience_s` returns without one: the computing process has been killed.
  Reference get(std::size_t index, double patience_s,
                const std::function<Reference()>& compute);

 private:
  struct Slot;
  std::size_t count_;
  Slot* slots_;
};

}  // namespace tress::experiments::hard_cases
