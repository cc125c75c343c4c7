#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "models/effects/effect.h"
#include "models/joints/joint.h"
#include "models/strand/strand.h"
#include "simulation/table/table.h"

namespace tress::models {
class SupportedSystem;
}

/// Joints of strands and bodies that a scene describes.
namespace tress::simulation {

/// A support on a body that strands drive. It is a joint of strand and body.
struct BodySupport {
  const Table* table = nullptr;  // [[supports]], in the tables of the scene
  std::size_t body = 0;          // number among the driven bodies
};
/// A support and the point that it holds.
struct PointOnBody {
  BodySupport support;     // its table and its body
  models::StrandPoint at;  // among the joined strands
};

/// Prepares the end of a joint at a point of a strand: the elastic half edge, and the
/// section of the rod at the start. A strand that has found its equilibrium has no moment
/// at an end.
void prepare_half(const models::Strand& strand, const models::SupportedSystem& held,
                  int point, models::RodJoint& half, std::optional<Frame>& begin);

/// Strands that are joined.
struct JoinedStrands {
  std::span<const models::Strand* const> strands;  // as the scene describes them
  std::span<const std::vector<double>> points;     // of each strand at the start
  std::vector<std::unique_ptr<models::SupportedSystem>>& held;  // bodies come last
  std::vector<models::Joint>& joints;  // those of supports on bodies come last
};

/// Adds the driven bodies among `effects` that carry supports, and a joint for each
/// support. Returns the number of these bodies. Throws InputError with the location of a
/// support that a driven body does not admit.
std::size_t add_body_joints(std::span<const PointOnBody> supports,
                            const models::Effects& effects, JoinedStrands to);

}  // namespace tress::simulation
