#include "models/batch/make_batch.h"
#include "models/reduced/arc.h"
#include "models/reduced/articulated_chain.h"
#include "models/reduced/ball_link.h"
#include "models/reduced/force_transport.h"
#include "models/reduced/super_helix.h"

namespace tress::models {

std::unique_ptr<System> super_helix_batch(std::span<const Strand> strands,
                                          const ReducedOptions& options,
                                          std::vector<Effects> effects) {
  return make_batch<RecursiveMechanics, ArcOf<Pack>, HelixOf<Pack>, HelixOf<Pack>>(
      strands, Unknown::curvature, options, std::move(effects), super_helix);
}

std::unique_ptr<System> articulated_chain_batch(std::span<const Strand> strands,
                                                const ReducedOptions& options,
                                                std::vector<Effects> effects) {
  return make_batch<RecursiveMechanics, BallLinkOf<Pack>, BallLinkOf<Pack>,
                    BallLinkOf<Pack>>(strands, Unknown::joint_angle, options,
                                      std::move(effects), articulated_chain);
}

std::unique_ptr<System> force_transport_batch(std::span<const Strand> strands,
                                              const ReducedOptions& options,
                                              std::vector<Effects> effects) {
  return make_batch<TransportMechanics, BallLinkOf<Pack>, BallLinkOf<Pack>,
                    BallLinkOf<Pack>>(strands, Unknown::joint_angle, options,
                                      std::move(effects), force_transport);
}

}  // namespace tress::models
