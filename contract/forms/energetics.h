#pragma once

#include <array>
#include <optional>

#include "contract/basics.h"

namespace tress {

struct Energy {
  double kinetic = 0;    // J
  double potential = 0;  // J
  double total() const { return kinetic + potential; }
};

struct Momentum {
  std::array<double, 3> linear{};   // kg m/s
  std::array<double, 3> angular{};  // kg m^2/s, about the origin
};

class Energetics {
 public:
  virtual ~Energetics() = default;
  virtual Energy energy(double t, In q, In v) = 0;
  /// Empty: the model does not compute its momentum.
  virtual std::optional<Momentum> momentum(double, In, In) { return {}; }
  /// Power (W) of all forces that `energy` does not account for; negative for drag.
  virtual double power(double t, In q, In v) = 0;
};

}  // namespace tress
