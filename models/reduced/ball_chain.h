#pragma once

#include "models/reduced/ball_link.h"
#include "models/reduced/reduced_system.h"

namespace tress::models {

/// Chains of rigid links, instantiated in articulated_chain.cpp.
extern template class ReducedSystem<BallLink, 1>;
extern template class ReducedSystem<BallLink, 2>;
extern template class ReducedSystem<BallLink, 3>;
extern template class ExactTangent<BallLink, 1>;
extern template class ExactTangent<BallLink, 2>;
extern template class ExactTangent<BallLink, 3>;

}  // namespace tress::models
