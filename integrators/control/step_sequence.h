#pragma once

#include <cmath>

namespace tress::integrators {

/// The lengths of the last two steps of a method with memory in a run that may repeat a
/// step with another length (ErrorControlled).
class StepSequence {
 public:
  /// Start of a step, relative to the last one.
  enum class Start {
    again,  // where the last one did
    next,   // where the last one ended
    anew    // elsewhere, or after forget()
  };

  /// Notes a step of h (s) from t (s), and returns where it starts.
  Start begin(double t, double h) noexcept {
    constexpr double rounding = 1e-6;
    const auto near = [&](double time) { return std::abs(t - time) <= rounding * h_; };
    Start start = Start::anew;
    if (h_ > 0 && near(t_)) {
      start = Start::again;
    } else {
      if (h_ > 0 && near(t_ + h_)) start = Start::next;
      before_ = start == Start::next ? h_ : 0;
    }
    t_ = t;
    h_ = h;
    return start;
  }
  /// Forgets both steps.
  void forget() noexcept { h_ = 0; }

  /// Returns the length of the last step, s.
  double length() const { return h_; }
  /// Returns the length of the step before, s; 0: none.
  double before() const { return before_; }
  /// Returns the last step over the one before; 0: none.
  double ratio() const { return before_ > 0 ? h_ / before_ : 0; }

 private:
  double t_ = 0, h_ = 0;  // of the last step, h_ = 0: none
  double before_ = 0;
};

}  // namespace tress::integrators
