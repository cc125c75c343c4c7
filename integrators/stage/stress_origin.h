#pragma once

#include <algorithm>
#include <vector>

#include "contract/forms/stress_form.h"
#include "integrators/formulation/dynamics.h"

namespace tress::integrators {

/// Origin of the stresses in Newton's matrices of systems with a StressForm. They come
/// first from the last state of the motion, then from Newton's corrections, so that an
/// edge that turns within an iteration does not appear stretched. Without such a form: no
/// effect.
class StressOrigin {
 public:
  /// Works on the system of `dynamics`, which must outlive it.
  explicit StressOrigin(Dynamics& dynamics)
      : form_(dynamics.system().stress_form()),
        q_left_(size(dynamics.n())),
        q_corrected_(q_left_) {}

  /// Returns true if the system has a StressForm.
  bool exists() const { return form_ != nullptr; }
  /// The state from which the next solution goes on.
  void leave(double t, In q) noexcept {
    if (form_ == nullptr) return;
    t_left_ = t;
    left_ = true;
    std::ranges::copy(q, q_left_.begin());
  }
  /// A solution is a state to go on from, once leave() has been called.
  void found(double t, In q) noexcept {
    if (left_) leave(t, q);
  }
  /// Before the first matrix of an iteration.
  void hold() noexcept {
    if (left_) form_->take_stresses(t_left_, q_left_, StressForm::Stresses::held);
  }
  /// The next correction starts at q.
  void correct_from(In q) noexcept {
    if (form_ != nullptr) std::ranges::copy(q, q_corrected_.begin());
  }
  /// Before the matrices that follow a correction.
  void follow(double t) noexcept {
    if (form_ != nullptr) {
      form_->take_stresses(t, q_corrected_, StressForm::Stresses::followed);
    }
  }

 private:
  StressForm* form_;  // null: none
  double t_left_ = 0;
  bool left_ = false;                         // at t_left_ and q_left_
  std::vector<double> q_left_, q_corrected_;  // q before the last correction
};

}  // namespace tress::integrators
