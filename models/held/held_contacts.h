#pragma once

#include <memory>
#include <vector>

#include "models/effects/effect.h"
#include "models/held/taken_contacts.h"

namespace tress::models {

/// The ContactForm of a strand: its effects that hold contact forces.
class HeldContacts final : private ContactForm {
 public:
  using PointsAt = TakenContacts::PointsAt;

  /// Replaces such effects in `effects` by copies for this strand of so many points.
  HeldContacts(Effects& effects, std::size_t points, PointsAt points_at);

  /// Null if there are none.
  ContactForm* form() { return held_.empty() ? nullptr : this; }

 private:
  void begin(double t, double tau, In q0, In v0) noexcept override;
  double improve(double t, In q, In v) noexcept override;
  std::size_t cases(double t, In q, In v) noexcept override;
  void extrapolate() noexcept override;
  double approach(double t, In q, In v) noexcept override;
  void release() noexcept override;
  bool rebounds() const override;
  Complementarity* complementarity() override;
  std::vector<double> multipliers() const override;
  void set_multipliers(In values) override;

  std::vector<std::shared_ptr<Effect>> held_;
  PointsAt points_at_;
  std::unique_ptr<TakenContacts> taken_;  // once they were asked for
};

}  // namespace tress::models
