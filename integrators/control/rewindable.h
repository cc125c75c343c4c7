#pragma once

#include "contract/integrator.h"

namespace tress::integrators {

/// A method that can repeat a part of a run after its system was changed from outside; an
/// optional capability.
class Rewindable {
 public:
  virtual ~Rewindable() = default;
  /// Remembers the present state, time and step control.
  virtual void mark() = 0;
  /// Goes on from mark(), after any outcome, with the system as it is now; the caller has
  /// recalled its memory. Steps taken since then do not count any more, their work does.
  virtual void rewind() = 0;
};

}  // namespace tress::integrators
