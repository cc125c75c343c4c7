#pragma once

#include "contract/integrator.h"

namespace tress::integrators {

/// Error indicator that a method provides at negligible cost; an optional capability.
class ErrorIndicator {
 public:
  virtual ~ErrorIndicator() = default;
  /// Largest value of all steps since start(), for q over System::scale.
  virtual double largest_indicator() const = 0;
};

/// Error of one step of a tenth of an unknown's scale: results after such a step are more
/// than 10 % wrong, even if the run ends normally.
inline constexpr double unresolved = 0.1;

/// 0 if the method has none.
inline double indicator_of(const Integrator& method) {
  const auto* own = dynamic_cast<const ErrorIndicator*>(&method);
  return own != nullptr ? own->largest_indicator() : 0;
}

}  // namespace tress::integrators
