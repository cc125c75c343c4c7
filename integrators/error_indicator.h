#pragma once

#include "contract/integrator.h"

namespace tress::integrators {

/// What a method knows of its own error at no cost worth mentioning. A capability of some
/// methods, not a part of every one.
class ErrorIndicator {
 public:
  virtual ~ErrorIndicator() = default;
  /// The largest of all steps since start(), of q over System::scale.
  virtual double largest_indicator() const = 0;
};

/// One step that is wrong by a tenth of an unknown's scale: what the run says after it is
/// more than 10 % wrong, however calmly it ends.
inline constexpr double unresolved = 0.1;

/// 0 where the method has none.
inline double indicator_of(const Integrator& method) {
  const auto* own = dynamic_cast<const ErrorIndicator*>(&method);
  return own != nullptr ? own->largest_indicator() : 0;
}

}  // namespace tress::integrators
