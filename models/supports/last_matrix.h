#pragma once

#include <span>
#include <utility>
#include <vector>

#include "contract/forms/loaded_tangent.h"

namespace tress::models {

/// Arguments of the last matrix of a system that factors others in between. The next
/// solution needs the former matrix, which is then factored again.
class LastMatrix {
 public:
  /// Arguments of a matrix.
  struct Arguments {
    double t = 0;                         // s
    std::vector<double> q, v, a, lambda;  // state and multipliers
    std::vector<double> springs;          // of linearize_loaded()
    std::vector<SectionLoad> loads;       // of linearize_loaded()
    Weights w;                            // weights of the derivatives
  };

  /// Takes the arguments of a matrix that is factored now, and returns them.
  const Arguments& take(double t, In q, In v, In a, In lambda, Weights w, In springs = {},
                        std::span<const SectionLoad> loads = {}) {
    last_.t = t;
    last_.w = w;
    for (const auto& [to, from] :
         {std::pair{&last_.q, q}, std::pair{&last_.v, v}, std::pair{&last_.a, a},
          std::pair{&last_.lambda, lambda}, std::pair{&last_.springs, springs}}) {
      to->assign(from.begin(), from.end());
    }
    last_.loads.assign(loads.begin(), loads.end());
    replaced_ = false;
    return last_;
  }

  /// Another matrix is factored from now on.
  void replace() { replaced_ = !last_.q.empty(); }

  /// Calls `other`, which takes another matrix.
  template <class Other>
  Status replaced_by(const Other& other) {
    Arguments before = last_;
    const Status status = other();
    last_ = std::move(before);
    replace();
    return status;
  }

  /// Calls factor(Arguments) if the matrix was replaced.
  template <class Factor>
  Status restore(const Factor& factor) {
    return std::exchange(replaced_, false) ? factor(last_) : Status::ok;
  }

 private:
  Arguments last_;
  bool replaced_ = false;
};

}  // namespace tress::models
