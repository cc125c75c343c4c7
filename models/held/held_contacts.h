#pragma once

#include <memory>
#include <vector>

#include "contract/forms/contact_form.h"
#include "models/effects/effect.h"
#include "models/held/taken_contacts.h"

namespace tress::models {

/// The ContactForm of a strand: its effects that hold contact forces.
class HeldContacts final : private ContactForm {
 public:
  /// Function that computes the points of a state.
  using PointsAt = TakenContacts::PointsAt;

  /// Replaces effects that hold contact forces in `effects` by copies for this strand
  /// with `points` points.
  HeldContacts(Effects& effects, std::size_t points, PointsAt points_at);

  /// Null if there are none.
  ContactForm* form() { return held_.empty() ? nullptr : this; }

 private:
  std::size_t tracked() const override;
  void places(double t, In q, In v, Out x) noexcept override;
  void slides(double t, In q, In v, Out u) noexcept override;
  void begin(double t, double tau, In q0, In v0, In x0) noexcept override;
  double improve(double t, In q, In v) noexcept override;
  double drive() const noexcept override;
  void extrapolate() noexcept override;
  double approach(double t, In q, In v) noexcept override;
  void release() noexcept override;
  bool rebounds() const override;
  Complementarity* complementarity() override;
  std::vector<double> multipliers() const override;
  void set_multipliers(In values) override;

  /// Calls act(multipliers, their values) of every effect.
  template <class Values, class Act>
  void each(Values all, Act act) const {
    for (const auto& effect : held_) {
      Multipliers& own = *effect->multipliers();
      act(own, all.first(own.tracked()));
      all = all.subspan(own.tracked());
    }
  }

  std::vector<std::shared_ptr<Effect>> held_;
  PointsAt points_at_;
  std::unique_ptr<TakenContacts> taken_;  // once they were asked for
};

}  // namespace tress::models
