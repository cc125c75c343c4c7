#pragma once

#include <memory>
#include <vector>

#include "models/effects/effect.h"

namespace tress::simulation {

/// A force of contact on a strand.
struct ContactForce {
  std::size_t strand;  // index of the strand
  std::size_t effect;  // in the scene's order
  Vec place;           // m
  Vec force;           // N
};

/// Effect that stores the last potential energy it returned. After a query of a model's
/// energy, the part of each effect is known. Contact forces at the points where the model
/// has them act are available on demand. One per strand.
class Metered final : public Effect {
 public:
  /// Meters this effect.
  explicit Metered(std::shared_ptr<const Effect> effect) : effect_(std::move(effect)) {}

  double last() const { return last_->potential; }  // J
  /// Whether queries of the energy look for contact forces too.
  void look(bool forces) const { last_->look = forces; }
  /// Returns the places (m) of the last query that recorded forces, 3 numbers each;
  /// forces() returns the forces (N).
  In places() const { return last_->places; }
  /// Returns the forces of the last query that recorded them (N), 3 numbers each.
  In forces() const { return last_->forces; }

  /// Returns the name of the effect.
  std::string_view name() const override { return effect_->name(); }
  /// Returns the needs of the effect.
  Needs needs() const override { return effect_->needs(); }
  void add_load(double t, const Points& p, InOut f) const noexcept override {
    effect_->add_load(t, p, f);
  }
  std::optional<Vec> uniform_acceleration() const noexcept override {
    return effect_->uniform_acceleration();
  }
  std::optional<Viscosity> viscosity() const noexcept override {
    return effect_->viscosity();
  }
  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override {
    effect_->add_derivatives(t, p, pos, vel, blocks);
  }
  void add_direction_derivatives(double t, const Points& p, double factor,
                                 InOut blocks) const noexcept override {
    effect_->add_direction_derivatives(t, p, factor, blocks);
  }
  void add_couplings(double t, const Points& p,
                     std::vector<Coupling>& all) const override {
    effect_->add_couplings(t, p, all);
  }
  double potential(double t, const Points& p) const noexcept override {
    if (last_->look) see_forces(t, p);
    return last_->potential = effect_->potential(t, p);
  }
  double power(double t, const Points& p) const noexcept override {
    return effect_->power(t, p);
  }
  double next_breakpoint(double t) const noexcept override {
    return effect_->next_breakpoint(t);
  }
  std::optional<double> penetration(double t, In x) const override {
    return effect_->penetration(t, x);
  }
  double surface_speed(double t, In x, double near) const override {
    return effect_->surface_speed(t, x, near);
  }
  std::optional<Outline> outline(double t) const override { return effect_->outline(t); }
  bool contact() const override { return effect_->contact(); }
  /// Returns a copy for one strand whose energy is also recorded by this effect.
  std::unique_ptr<Effect> for_strand(std::size_t points) const override {
    std::shared_ptr<Effect> own = effect_->for_strand(points);
    if (own == nullptr) return {};
    auto metered = std::make_unique<Metered>(own);
    metered->last_ = last_;
    metered->holds_ = std::move(own);
    return metered;
  }
  /// Returns the multipliers of the effect; null if it has none.
  Multipliers* multipliers() override {
    return holds_ == nullptr ? nullptr : holds_->multipliers();
  }

 private:
  struct Last {
    double potential = 0;
    bool look = false;
    std::vector<double> places, forces;
  };

  void see_forces(double t, const Points& p) const {
    std::vector<double> load(3 * static_cast<std::size_t>(p.count));
    effect_->add_load(t, p, load);
    last_->places.clear();
    last_->forces.clear();
    for (std::size_t i = 0; i < load.size(); i += 3) {
      if (norm(load3(&load[i])) == 0) continue;
      for (std::size_t c = i; c < i + 3; ++c) {
        last_->places.push_back(p.x[c]);
        last_->forces.push_back(load[c]);
      }
    }
  }

  std::shared_ptr<const Effect> effect_;
  std::shared_ptr<Effect> holds_;  // effect_, if it holds contact forces
  std::shared_ptr<Last> last_ = std::make_shared<Last>();
};

}  // namespace tress::simulation
