#pragma once

#include <array>
#include <optional>

#include "contract/basics.h"

namespace tress {

/// Mechanical energy of a system.
struct Energy {
  double kinetic = 0;    // J
  double potential = 0;  // J
  /// Returns the sum of kinetic and potential energy, J.
  double total() const { return kinetic + potential; }
};

/// Momentum of a system.
struct Momentum {
  std::array<double, 3> linear{};   // kg m/s
  std::array<double, 3> angular{};  // kg m^2/s, about the origin
};

/// Energies and momentum of a system, for output and tests of balances.
class Energetics {
 public:
  virtual ~Energetics() = default;
  /// Returns the energy at a state.
  virtual Energy energy(double t, In q, In v) = 0;
  /// Empty: the model does not compute its momentum.
  virtual std::optional<Momentum> momentum(double, In, In) { return {}; }
  /// Power (W) of all forces that `energy` does not account for; negative for drag.
  virtual double power(double t, In q, In v) = 0;
};

}  // namespace tress
