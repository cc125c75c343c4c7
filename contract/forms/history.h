#pragma once

#include <vector>

#include "contract/basics.h"

namespace tress {

/// State of a system that depends on past steps: reference frames, contact sets.
class History {
 public:
  virtual ~History() = default;
  /// Called once after every accepted step; may move frames or contact sets and adjust
  /// the state to them. True: the equations changed, multistep methods must restart.
  virtual bool accept(double t, InOut q, InOut v) = 0;
  /// Discards the effects of every accept(): coordinates regain the meaning that they
  /// have in initial_state().
  virtual void reset() = 0;
  /// All that accept() has changed since reset(). recall() restores it in an identically
  /// constructed system, which then continues as this one would.
  virtual std::vector<double> memory() const = 0;
  /// Restores what memory() returned.
  virtual void recall(In memory) = 0;
};

}  // namespace tress
