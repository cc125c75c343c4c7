#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "models/head/head.h"
#include "models/head/helix_launch.h"

namespace tress::models {

/// A head of super-helices as a device is told of it, in the head's own units. Its state
/// is what Head::keep() says: of each element the unknowns, then their rates.
class HelixSource {
 public:
  virtual ~HelixSource() = default;

  /// What acts on its strands and is not in the device's code; nothing if it can step
  /// them.
  virtual std::optional<HeadRefusal> refused_by_device() const = 0;

  struct Shape {
    int elements, points;
    bool twist;
    HeadNumber number;
  };
  virtual Shape shape() const = 0;
  /// Of each strand of a block helix_fixed(elements) numbers.
  virtual void fixed(std::size_t block, std::span<double> each) const = 0;
  virtual HeadMotion motion_at(double t) const = 0;
  virtual double time_unit() const = 0;  // s
};

}  // namespace tress::models
