#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/hard_cases/hard_case.h"

namespace tress::experiments::hard_cases {

/// Where the tip goes by the same equations at a much finer step, and how far that is
/// from the same at twice that step, over the length; `why`, where there is none.
struct Reference {
  std::vector<double> tip;  // (3 samples)
  double gap = 0;
  std::string why;  // empty: there is one

  static constexpr int samples = 8;
};

/// References that rows in processes of their own share: the first that asks computes,
/// the others wait. Made before the processes are, in memory that all of them see.
class References {
 public:
  explicit References(std::size_t count);
  ~References();
  References(const References&) = delete;
  References& operator=(const References&) = delete;

  /// Number `index`, by `compute` unless it is known. Who waits longer than `patience_s`
  /// goes without: who computed has been killed.
  Reference get(std::size_t index, double patience_s,
                const std::function<Reference()>& compute);

 private:
  struct Slot;
  std::size_t count_;
  Slot* slots_;
};

}  // namespace tress::experiments::hard_cases
