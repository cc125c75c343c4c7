#pragma once

#include <memory>

#include "models/effects/effect.h"

namespace tress::simulation {

/// An effect that stores the last potential energy it returned: after a query of a
/// model's energy, the part of each effect is known. One per strand.
class Metered final : public Effect {
 public:
  explicit Metered(std::shared_ptr<const Effect> effect) : effect_(std::move(effect)) {}

  double last() const { return *last_; }  // J

  std::string_view name() const override { return effect_->name(); }
  Needs needs() const override { return effect_->needs(); }
  void add_load(double t, const Points& p, InOut f) const noexcept override {
    effect_->add_load(t, p, f);
  }
  std::optional<Vec> uniform_acceleration() const noexcept override {
    return effect_->uniform_acceleration();
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
    return *last_ = effect_->potential(t, p);
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
  std::optional<Outline> outline(double t) const override { return effect_->outline(t); }
  /// Its energy is known to this one too.
  std::unique_ptr<Effect> for_strand(std::size_t points) const override {
    std::shared_ptr<Effect> own = effect_->for_strand(points);
    if (own == nullptr) return {};
    auto metered = std::make_unique<Metered>(own);
    metered->last_ = last_;
    metered->holds_ = std::move(own);
    return metered;
  }
  Multipliers* multipliers() override {
    return holds_ == nullptr ? nullptr : holds_->multipliers();
  }

 private:
  std::shared_ptr<const Effect> effect_;
  std::shared_ptr<Effect> holds_;  // effect_, if it holds contact forces
  std::shared_ptr<double> last_ = std::make_shared<double>(0.0);
};

}  // namespace tress::simulation
