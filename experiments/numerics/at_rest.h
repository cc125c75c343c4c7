#pragma once

#include <memory>
#include <vector>

#include "models/catalogue.h"

namespace tress::experiments {

/// A strand in equilibrium under its weight.
struct AtRest {
  std::unique_ptr<System> system;
  std::vector<double> q;
};

/// Newton's iteration on r(q) = 0 at v = a = 0, from the initial state, with gravity
/// raised in steps to the value in `parameters`; for models without constraints and with
/// an exact tangent. Throws std::runtime_error when it does not converge.
AtRest at_rest(const ModelEntry& model, const Parameters& parameters);

}  // namespace tress::experiments
