#pragma once

#include "contract/system.h"

namespace tress {

/// The matrix of a system with constraints whose own S(w) is eliminated along a strand
/// and not assembled, an optional capability. It replaces the SparseForm of implicit
/// methods, in O(n) for a fixed number of constraints.
class BorderedForm {
 public:
  virtual ~BorderedForm() = default;
  /// Returns true if the system has this form; fixed for life.
  virtual bool bordered() const = 0;
  /// Prepares System::solve() with S(w) - w.pos d(G^T lambda)/dq. `retry` where it cannot
  /// be factored.
  virtual Status linearize_bordered(double t, In q, In v, In a, In lambda,
                                    Weights w) noexcept = 0;
};

/// Returns the form; null if the system has none.
inline BorderedForm* bordered_form(System& system) {
  auto* const form = dynamic_cast<BorderedForm*>(&system);
  return form != nullptr && form->bordered() ? form : nullptr;
}

}  // namespace tress
