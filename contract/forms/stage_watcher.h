#pragma once

#include "contract/basics.h"

namespace tress {

/// A system that is told the solutions of the stages of implicit methods, an optional
/// capability: derivatives of a run are evaluated at them (integrators/gradient).
class StageWatcher {
 public:
  virtual ~StageWatcher() = default;
  /// Called after each stage that was solved: r(t, q, v, a) = G^T lambda within Newton's
  /// tolerance.
  virtual void solved(double t, In q, In v, In a, In lambda) noexcept = 0;
  /// Called before that with exact contact: the arguments with which the solution was
  /// prepared by ContactForm::begin().
  virtual void prepared(double /*tau*/, In /*q0*/, In /*v0*/, In /*x0*/) noexcept {}
};

}  // namespace tress
