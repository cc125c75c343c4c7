#pragma once

#include <functional>
#include <vector>

#include "models/effects/effect.h"

namespace tress::models {

/// The ContactForm of a strand: its effects that hold contact forces.
class HeldContacts final : private ContactForm {
 public:
  /// The strand's points at a state, with all that its effects need; valid until the next
  /// call.
  using PointsAt = std::function<Points(double t, In q, In v)>;

  /// Replaces such effects in `effects` by copies for this strand of so many points.
  HeldContacts(Effects& effects, std::size_t points, PointsAt points_at);

  /// Null if there are none.
  ContactForm* form() { return held_.empty() ? nullptr : this; }

 private:
  void begin(double t, double tau, In q0, In v0) noexcept override;
  double improve(double t, In q, In v) noexcept override;
  double approach(double t, In q, In v) noexcept override;
  void release() noexcept override;
  bool rebounds() const override;
  std::vector<double> multipliers() const override;
  void set_multipliers(In values) override;

  std::vector<std::shared_ptr<Effect>> held_;
  PointsAt points_at_;
};

}  // namespace tress::models
