#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "contract/forms/point_accelerations.h"
#include "integrators/formulation/dynamics.h"
#include "models/joints/joined_system.h"
#include "models/strand/geometry.h"
#include "tests/models/supports/held_strand.h"

/// Strands of the catalogue with joints.
namespace tress::testing_support {

/// The strand with a free root that begins at rest at `root`.
inline Strand freed(Strand strand, const StrandPlace& root) {
  FreeRoot& made = strand.free_root.emplace();
  made.position = root.x;
  made.frame = root.frame;
  return strand;
}

/// The strand of these settings; with `root`, one whose root is free and begins there.
inline Strand strand_at(const std::string& model, const ModelSettings& settings,
                        const std::optional<StrandPlace>& root = {}) {
  Strand made = models::strand(parameters_of(model, settings));
  return root ? freed(std::move(made), *root) : made;
}

/// The place of the tip of a clamped strand at the start.
inline StrandPlace tip_of(const Strand& strand) {
  const StrandPlace root{strand.root.position, strand.root.frame};
  return models::joints(strand, models::ShapeOf::initial, root).back();
}

/// A strand as a system that joints can hold.
inline std::unique_ptr<SupportedSystem> joinable(const std::string& model,
                                                 const ModelSettings& settings,
                                                 const Strand& strand,
                                                 std::vector<Support> supports = {}) {
  const Parameters parameters = parameters_of(model, settings);
  return std::make_unique<SupportedSystem>(
      find_model(model).on_strand(strand, parameters, models::strand_effects(parameters)),
      std::move(supports));
}

/// A joint of two points.
inline models::Joint joint_of(models::JointKind kind, models::StrandPoint a,
                              models::StrandPoint b) {
  models::Joint made;
  made.kind = kind;
  made.a = a;
  made.b = b;
  return made;
}

/// Strands with joints.
inline std::unique_ptr<models::JoinedSystem> joined(
    std::vector<std::unique_ptr<SupportedSystem>> strands,
    const std::vector<models::Joint>& joints) {
  return std::make_unique<models::JoinedSystem>(
      std::move(strands), joints, std::vector<std::string>(joints.size(), "the joint"));
}

/// Accelerations of all points of a system that begins at rest, with their forces of
/// constraints. Points of strand k begin at first[k].
inline std::vector<double> accelerations_at_start(System& system) {
  Options options;
  if (system.layout().constraints > 0) options.formulation = Formulation::index3;
  integrators::Dynamics dynamics(system, options);
  std::vector<double> q = zeros(system), v = q, a = q,
                      lambda(std::size_t(system.layout().constraints));
  system.initial_state(q, v);
  EXPECT_EQ(dynamics.accelerate(0, q, v, a, lambda), Status::ok);
  const auto of_strand = [](System& one, In q1, In v1, In a1) {
    std::vector<double> x(3 * std::size_t(one.material_points()->count()));
    point_accelerations(one)->accelerations(0, q1, v1, a1, x);
    return x;
  };
  auto* const block = dynamic_cast<models::JoinedSystem*>(&system);
  if (block == nullptr) return of_strand(system, q, v, a);
  std::vector<double> all;
  std::size_t first = 0;
  for (std::size_t k = 0; k < block->strands(); ++k) {
    System& one = block->held(k).strand();
    const auto n = std::size_t(one.layout().coordinates);
    const auto part = [&](const std::vector<double>& of) {
      return In(of).subspan(first, n);
    };
    const std::vector<double> x = of_strand(one, part(q), part(v), part(a));
    all.insert(all.end(), x.begin(), x.end());
    first += n;
  }
  return all;
}

}  // namespace tress::testing_support
