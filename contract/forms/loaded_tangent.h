#pragma once

#include <span>

#include "contract/system.h"
#include "math/matrix3.h"

namespace tress {

/// A force and a moment on the section at a point of a strand, world components. The
/// force does not change with the rotation of the section.
struct SectionLoad {
  int point = 0;               // of MaterialPoints
  Vec force;                   // N
  Vec moment;                  // N m, about the point
  Matrix3<double> by_turn{};   // derivative of the moment by a rotation, N m
  Matrix3<double> by_spin{};   // derivative of the moment by the angular velocity, N m s
  Matrix3<double> by_place{};  // derivative of the force by the position, N/m
  Matrix3<double> by_velocity{};  // derivative of the force by the velocity, N s/m
};

/// S(w) of a strand under additional loads on its points, an optional capability.
class LoadedTangent {
 public:
  virtual ~LoadedTangent() = default;
  /// Returns true if linearize_loaded() takes loads; fixed for life.
  virtual bool takes_loads() const = 0;
  /// Prepares System::solve() with the S(w) of the residual r - J^T loads, J = du/dv,
  /// plus w.pos times springs on the coordinates (n; none: empty). Same cost as
  /// linearize().
  virtual Status linearize_loaded(double t, In q, In v, In a, Weights w,
                                  std::span<const SectionLoad> loads,
                                  In springs) noexcept = 0;
};

/// Returns the form; null if the system takes no loads.
inline LoadedTangent* loaded_tangent(System& system) {
  auto* const form = dynamic_cast<LoadedTangent*>(&system);
  return form != nullptr && form->takes_loads() ? form : nullptr;
}

}  // namespace tress
