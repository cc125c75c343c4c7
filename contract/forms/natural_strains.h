#pragma once

#include <vector>

#include "contract/system.h"

namespace tress {

/// The strains s_k(q) at which a system's elasticity is free of stress, an optional form
/// of systems whose elastic energy has such a part:
///
///     E = sum_k stiffness_k (s_k(q) - natural_k)^2/2 + ...,
///     dr/dnatural_k = -stiffness_k ds_k/dq,
///
/// so that the residual is affine in them. Strains have model-specific units u, their
/// stiffness J/u^2. They are part of the system, not of its state: reset() and recall()
/// keep them.
class NaturalStrains {
 public:
  virtual ~NaturalStrains() = default;
  /// Empty if this system has none.
  virtual std::vector<double> natural() const = 0;
  /// Sets the natural strains, in the order of natural().
  virtual void set_natural(In values) = 0;
  /// Positive, one for each.
  virtual std::vector<double> natural_stiffness() const = 0;
  /// Whether s_k is coordinate k, for all coordinates.
  virtual bool strains_are_coordinates() const { return false; }
};

/// Null if the system has none.
inline NaturalStrains* natural_strains(System& system) {
  auto* form = dynamic_cast<NaturalStrains*>(&system);
  return form == nullptr || form->natural().empty() ? nullptr : form;
}

}  // namespace tress
