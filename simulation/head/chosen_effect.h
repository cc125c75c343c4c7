#pragma once

#include <memory>
#include <string_view>
#include <utility>

#include "models/effects/effect.h"

namespace tress::simulation {

/// An effect on a strand that may give way to another one of its kind between steps.
class ChosenEffect final : public models::Effect {
 public:
  /// Acts as `usual` until another effect is chosen.
  explicit ChosenEffect(std::unique_ptr<const models::Effect> usual)
      : usual_(std::move(usual)) {}

  /// Null: the usual one again.
  void choose(std::unique_ptr<const models::Effect> other) { other_ = std::move(other); }

  /// Returns the name of the effect that acts now.
  std::string_view name() const override { return now().name(); }
  /// Returns the needs of the effect that acts now.
  models::Needs needs() const override { return now().needs(); }
  void add_load(double t, const models::Points& p, InOut f) const noexcept override {
    now().add_load(t, p, f);
  }
  void add_derivatives(double t, const models::Points& p, double pos, double vel,
                       InOut blocks) const noexcept override {
    now().add_derivatives(t, p, pos, vel, blocks);
  }
  void add_both(double t, const models::Points& p, double pos, double vel, InOut f,
                InOut blocks) const noexcept override {
    now().add_both(t, p, pos, vel, f, blocks);
  }
  double potential(double t, const models::Points& p) const noexcept override {
    return now().potential(t, p);
  }
  double power(double t, const models::Points& p) const noexcept override {
    return now().power(t, p);
  }
  double next_breakpoint(double t) const noexcept override {
    return now().next_breakpoint(t);
  }

 private:
  const models::Effect& now() const { return other_ ? *other_ : *usual_; }

  std::unique_ptr<const models::Effect> usual_, other_;
};

}  // namespace tress::simulation
