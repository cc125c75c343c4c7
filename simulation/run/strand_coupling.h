#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "contract/integrator.h"
#include "models/effects/control_mesh.h"
#include "models/effects/strand_interaction.h"

namespace tress::simulation {

/// Coupling of strands, each or several advanced by a method of their own. A step is
/// before_step(); all systems advance, each followed by prepare(); after_step();
/// exchange(). Points are those of all strands, strand after strand, 3 numbers each.
class StrandCoupling {
 public:
  virtual ~StrandCoupling() = default;

  /// Returns the effect of the others on a strand while it advances; null: nothing.
  virtual std::unique_ptr<const models::Effect> effect(std::size_t /*strand*/) const {
    return {};
  }
  /// Adds the next system and the method that advances it; both must outlive this.
  virtual void add(System& /*system*/, Integrator& /*method*/,
                   const Options& /*options*/) {}

  /// Takes the positions of points before a step.
  virtual void before_step(In /*x*/, const Loop& /*loop*/) {}
  /// System k has advanced by h: a chance to do what costs least while it is near in
  /// memory. Safe for different ones at once.
  virtual void prepare(std::size_t /*k*/, double /*h*/) {}
  /// All have advanced by h to t. Not ok: failure() tells why.
  virtual Status after_step(double /*t*/, double /*h*/, In /*x*/, In /*u*/,
                            const Loop& /*loop*/) {
    return Status::ok;
  }
  /// Strands, ascending, that after_step() has given a new state.
  virtual std::span<const std::size_t> moved() const { return {}; }
  /// Returns what ended the last after_step(); empty if it ended well.
  virtual std::string failure() const { return {}; }
  /// Takes the points from which strands see each other in the next step.
  virtual void exchange(In /*x*/, In /*u*/, const Loop& /*loop*/) {}

  /// Work of its own since restore().
  virtual Stats stats() const { return {}; }
  /// All that steps change; restore() goes on from there, or starts if it is empty.
  virtual std::vector<double> memory() const { return {}; }
  /// Restores what memory() returned, or starts if it is empty.
  virtual void restore(In /*memory*/) {}
};

/// Strands see the others where they were at the start of the step.
class LaggedInteraction final : public StrandCoupling {
 public:
  /// Constructs the interaction with these arguments.
  template <class... Parts>
  explicit LaggedInteraction(Parts&&... parts) : law(std::forward<Parts>(parts)...) {}

  std::unique_ptr<const models::Effect> effect(std::size_t strand) const override {
    return law.effect(strand);
  }
  void exchange(In x, In u, const Loop& loop) override { law.update(x, u, loop); }

  models::StrandInteraction law;  // Forces between strands that touch.
};

/// The control mesh of a wisp: its springs pull where strands were at the start of the
/// step.
class MeshCoupling final : public StrandCoupling {
 public:
  /// Constructs the mesh with these arguments.
  template <class... Parts>
  explicit MeshCoupling(Parts&&... parts) : mesh(std::forward<Parts>(parts)...) {}

  std::unique_ptr<const models::Effect> effect(std::size_t strand) const override {
    return mesh.effect(strand);
  }
  void exchange(In x, In u, const Loop& /*loop*/) override { mesh.update(x, u); }
  std::vector<double> memory() const override { return mesh.memory(); }
  /// Restores what memory() returned.
  void restore(In memory) override { mesh.recall(memory); }

  models::ControlMesh mesh;  // Springs between strands.
};

}  // namespace tress::simulation
