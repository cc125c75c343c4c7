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

  /// Sizes that select the device's kernel.
  struct Shape {
    int elements, points;  // elements of a strand, points of an element
    bool twist;            // whether elements twist
    HeadNumber number;     // number type
  };
  /// Returns the sizes.
  virtual Shape shape() const = 0;
  /// Writes helix_fixed(elements) numbers for each strand of a block.
  virtual void fixed(std::size_t block, std::span<double> each) const = 0;
  /// Returns the motion of the head at t (s).
  virtual HeadMotion motion_at(double t) const = 0;
  virtual double time_unit() const = 0;  // s
};

}  // namespace tress::models
