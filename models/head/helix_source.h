#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "models/head/head.h"
#include "models/head/helix_launch.h"

namespace tress::models {

/// Description of a batch of super-helices for a device, in the units of the batch. Its
/// state is that of Head::keep(): the unknowns of each element, then their rates.
class HelixSource {
 public:
  virtual ~HelixSource() = default;

  /// Returns the effects or options that the device's code lacks; nothing if it can step
  /// the strands.
  virtual std::optional<HeadRefusal> refused_by_device() const = 0;

  struct Shape {
    int elements, points;
    bool twist;
    HeadNumber number;
  };
  virtual Shape shape() const = 0;
  /// Writes helix_fixed(elements) numbers for each strand of a block.
  virtual void fixed(std::size_t block, std::span<double> each) const = 0;
  virtual HeadMotion motion_at(double t) const = 0;
  virtual double time_unit() const = 0;  // s
};

}  // namespace tress::models
