#pragma once

#include <memory>

#include "models/head/lane_kernel.h"
#include "simulation/head/make_head.h"

namespace tress::simulation {

/// A head of any model in lanes by any method of blocks (integrators/block): it owns the
/// strands. Lanes do not mix, so results are the same bits for any number of lanes,
/// threads and blocks in a call.
std::unique_ptr<models::Head> stepping_head(
    std::unique_ptr<models::LaneKernel<double>> kernel, const HeadOptions& options);
/// Makes such a batch in single precision.
std::unique_ptr<models::Head> stepping_head(
    std::unique_ptr<models::LaneKernel<float>> kernel, const HeadOptions& options);

}  // namespace tress::simulation
