#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulation/rest/held_shape.h"
#include "simulation/run/stepped_system.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/scene.h"
#include "simulation/scene/support_table.h"
#include "simulation/scene_changes/strand_options.h"

namespace tress::simulation {

/// A strand of a scene and what acts on it in addition to the scene's effects.
struct StrandToMake {
  const Strand& strand;             // stiffer(), if it is held
  Effects between = {};             // on it alone, as those between strands
  const HeldShape* held = nullptr;  // what holds it at rest, if its rest is inverse
  std::size_t number = 0;           // in the scene
};

/// Makes the strands of a scene as systems with their effects, guards and integrators,
/// for a World and for a batch of strands. Keeps no reference to the scene.
class StrandMaker {
 public:
  /// Reads the scene's model, method, options and effects.
  explicit StrandMaker(const Scene& scene);

  const Effects& effects() const { return effects_; }  // make_effects()
  /// Returns the model of the scene.
  const ModelEntry& model() const { return *model_; }
  /// Returns the integrator of the scene.
  const IntegratorEntry& method() const { return *method_; }
  /// Returns the integrator's options.
  const Options& options() const { return options_; }

  /// Returns the supports of the scene.
  const SceneSupports& supports() const { return supports_; }
  /// Returns the joints of the scene.
  const SceneJoints& joints() const { return joints_; }

  /// Makes a strand as a system of its own, on its supports, without integrator.
  /// `number`: the strand's number in messages.
  SteppedSystem one(const StrandToMake& strand, std::size_t number) const;
  /// Makes a group of strands as one system with their joints.
  SteppedSystem joined(std::span<const StrandToMake> strands,
                       const SceneJoints::Group& group) const;
  /// Several of equal discretisation as one system; empty: the model has no such form for
  /// them.
  std::optional<SteppedSystem> together(std::span<const StrandToMake> strands,
                                        std::size_t first) const;
  /// The scene's effects on a strand, each in a meter, and the model made with them.
  std::unique_ptr<System> metered(
      const StrandToMake& strand,
      std::vector<std::shared_ptr<const Metered>>& meters) const;
  /// One guard of strands that are this system, if the scene has guards.
  void add_guard(SteppedSystem& system, std::span<const StrandToMake> strands,
                 std::size_t first) const;

 private:
  Effects effects_on(const StrandToMake& strand) const;
  std::vector<GuardedStrand> guarded(std::span<const StrandToMake> strands) const;
  Effects acting(const StrandToMake& strand,
                 std::vector<std::shared_ptr<const Metered>>& meters) const;

  const ModelEntry* model_;
  StrandOptions model_options_;
  const IntegratorEntry* method_;
  Options options_;
  Effects effects_;
  std::vector<std::optional<std::size_t>> only_;  // EffectChoice::strand of each
  SceneSupports supports_;
  SceneJoints joints_;
  bool guard_;
};

}  // namespace tress::simulation
