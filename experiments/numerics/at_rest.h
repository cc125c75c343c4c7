#pragma once

#include <memory>
#include <vector>

#include "models/catalogue.h"

namespace tress::experiments {

/// A strand in equilibrium with its weight.
struct AtRest {
  std::unique_ptr<System> system;
  std::vector<double> q;
};

/// Newton's iteration on r(q) = 0 at v = a = 0, from the initial state, with gravity
/// raised in steps up to what `parameters` say; for models without constraints whose
/// tangent is exact. Throws std::runtime_error when it does not converge.
AtRest at_rest(const ModelEntry& model, const Parameters& parameters);

}  // namespace tress::experiments
