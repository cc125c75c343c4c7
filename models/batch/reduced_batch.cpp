#include "models/batch/reduced_batch.h"

#include "models/reduced/arc.h"
#include "models/reduced/articulated_chain.h"
#include "models/reduced/ball_link.h"
#include "models/reduced/force_transport.h"
#include "models/reduced/super_helix.h"

namespace tress::models {
namespace {

/// `alone` makes a single strand; `PlanarKernel` is the kernel for one unknown per
/// segment.
template <template <class, int> class Mechanics, template <class> class Kernel,
          template <class> class PlanarKernel = Kernel>
std::unique_ptr<System> make_batch(std::span<const Strand> strands, Unknown unknown,
                                   const ReducedOptions& given,
                                   std::vector<Effects> effects,
                                   decltype(super_helix) alone) {
  const ReducedOptions options = with_same_points(strands, unknown, given);
  PackedStrands all = packed(strands, unknown, options, effects);
  std::vector<std::unique_ptr<System>> systems;
  for (std::size_t s = 0; s < strands.size(); ++s) {
    systems.push_back(alone(strands[s], options, std::move(effects[s])));
  }
  const auto make = [&]<class K, int dofs>() {
    return std::make_unique<ReducedBatch<Mechanics, K, dofs>>(std::move(all),
                                                              std::move(systems));
  };
  switch (options.dofs) {
    case 1:
      return make.template operator()<PlanarKernel<Pack>, 1>();
    case 2:
      return make.template operator()<Kernel<Pack>, 2>();
    default:
      return make.template operator()<Kernel<Pack>, 3>();
  }
}

}  // namespace

std::unique_ptr<System> super_helix_batch(std::span<const Strand> strands,
                                          const ReducedOptions& options,
                                          std::vector<Effects> effects) {
  return make_batch<RecursiveMechanics, HelixOf, ArcOf>(
      strands, Unknown::curvature, options, std::move(effects), super_helix);
}

std::unique_ptr<System> articulated_chain_batch(std::span<const Strand> strands,
                                                const ReducedOptions& options,
                                                std::vector<Effects> effects) {
  return make_batch<RecursiveMechanics, BallLinkOf>(
      strands, Unknown::joint_angle, options, std::move(effects), articulated_chain);
}

std::unique_ptr<System> force_transport_batch(std::span<const Strand> strands,
                                              const ReducedOptions& options,
                                              std::vector<Effects> effects) {
  return make_batch<TransportMechanics, BallLinkOf>(
      strands, Unknown::joint_angle, options, std::move(effects), force_transport);
}

}  // namespace tress::models
