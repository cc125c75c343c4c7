#pragma once

#include <memory>
#include <vector>

#include "models/contact/exact_contact.h"
#include "models/effects/rigid_body.h"

namespace tress::models {

/// Contact of the strand with a rigid body by ExactContact: what sticks does not move.
/// Points without length, and those that the root holds, receive no force. A compliant
/// surface has the potential and the power of Body; a rigid one has no potential, and
/// power is that of all its forces. Of one strand (for_strand). O(points).
class ExactBody final : public Effect, private Multipliers {
 public:
  /// Throws InputError as Body does, and on a restitution outside [0, 1] or of a
  /// compliant surface.
  ExactBody(BodyShape shape, const StrandPlace& place, const ExactContact& law,
            std::optional<RootMotion> head = {});

  std::string_view name() const override { return "body"; }
  Needs needs() const override {
    return {.position = true, .velocity = true, .derivatives = true};
  }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override;
  double potential(double t, const Points& p) const noexcept override;
  double power(double t, const Points& p) const noexcept override;
  std::optional<double> penetration(double t, In x) const override {
    return body_->penetration(t, x);
  }
  double surface_speed(double t, In x, double near) const override {
    return body_->surface_speed(t, x, near);
  }
  double next_breakpoint(double t) const noexcept override {
    return body_->next_breakpoint(t);
  }
  std::optional<Outline> outline(double t) const override { return body_->outline(t); }
  /// Returns shape, place and motion.
  const RigidBody& body() const { return *body_; }

  std::unique_ptr<Effect> for_strand(std::size_t points) const override;
  Multipliers* multipliers() override { return this; }
  /// Returns the obstacle of a rigid surface without restitution.
  std::shared_ptr<const Obstacle> obstacle() const override;

 private:
  bool rigid() const override { return law_.rigid; }
  void take(double t, const Points& p) noexcept override;
  void touches(double t, const Points& p,
               std::vector<RigidTouch>& to) const noexcept override;
  void set_force(double t, double since, std::size_t point, double normal,
                 const Vec& tangential) noexcept override;
  void give_back(const Points& p) noexcept override;
  std::size_t tracked() const noexcept override { return 3 * penalties_.size(); }
  void places(double t, const Points& p, Out x) const noexcept override;
  void slides(double t, const Points& p, Out u) const noexcept override;
  void begin(double t, double tau, const Points& p, In x0) noexcept override;
  double improve(double t, const Points& p) noexcept override;
  double drive() const noexcept override;
  void extrapolate() noexcept override;
  double approach(double t, const Points& p) noexcept override;
  void release() noexcept override;
  bool rebounds() const override { return law_.restitution > 0; }
  InOut values() noexcept override { return values_; }

  static Vec place(const BodyPose& now, const Points& p, std::size_t point);
  static bool touchable(const Points& p, std::size_t point);
  double reach(const Points& p, std::size_t point) const;
  ExactContact::Penalty penalty(const Points& p, std::size_t point) const;
  HeldContact held(std::size_t point) const;
  void hold(std::size_t point, const HeldContact& contact);
  template <RigidBody::With with, class See>
  void for_touching(const BodyPose& now, const Points& p, See see) const;
  double other_penalty() noexcept;
  void set_penalties(const Points& p) noexcept;

  std::shared_ptr<const RigidBody> body_;  // of all strands
  ExactContact law_;
  // See Header in the source, then HeldContact of each point.
  std::vector<double> values_;
  std::vector<ExactContact::Penalty> penalties_;
  double violation_ = 0;  // m/s, before the last improve(); 0: none
  // At begin(): contacts that are open, and rest gaps.
  std::vector<bool> open_;
  std::vector<double> rest_gaps_;
  std::vector<bool> taken_;
  std::vector<double> leaves_;  // HeldContact::leaves, of this solution
  // Of multipliers by an improvement, N: the last one and the one before, 0: none.
  struct Change {
    double normal = 0;
    Vec tangential;

    double times(const Change& other) const {
      return normal * other.normal + dot(tangential, other.tangential);
    }
  };
  std::vector<Change> change_, change_before_;
};

}  // namespace tress::models
