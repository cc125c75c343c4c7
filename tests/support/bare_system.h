#pragma once

#include "contract/forms/history.h"
#include "contract/system.h"

namespace tress::testing_support {

/// The equations of a system and what it remembers of its steps, without its other forms:
/// with no StressForm, tangents have the stresses of their own state.
class BareSystem : public System {
 public:
  explicit BareSystem(System& original) : original_(original) {}
  Layout layout() const override { return original_.layout(); }
  Traits traits() const override { return original_.traits(); }
  void initial_state(Out q, Out v) const override { original_.initial_state(q, v); }
  void scale(Out q, Out v) const override { original_.scale(q, v); }
  Status residual(double t, In q, In v, In a, Out r) noexcept override {
    return original_.residual(t, q, v, a, r);
  }
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    return original_.linearize(t, q, v, a, w);
  }
  Status solve(In b, Out x) noexcept override { return original_.solve(b, x); }
  History* history() override { return original_.history(); }

 private:
  System& original_;
};

}  // namespace tress::testing_support
