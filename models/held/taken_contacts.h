#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "contract/forms/contact_form.h"
#include "models/contact/contact_problem.h"
#include "models/effects/effect.h"

namespace tress::models {

/// The Complementarity of a strand's contacts with rigid bodies; their forces are those
/// of ContactProblem, about which the strand is one body with a point for each contact.
class TakenContacts final : public Complementarity {
 public:
  /// The strand's points at a state, with all that its effects need; valid until the next
  /// call.
  using PointsAt = std::function<Points(double t, In q, In v)>;

  /// `form` and `held`, its effects that hold contact forces, must outlive it.
  TakenContacts(ContactForm& form, std::span<const std::shared_ptr<Effect>> held,
                PointsAt points_at);

  std::size_t take(double t, In q, In v, In q_next, In v_next) noexcept override;
  void forces(Out f) const noexcept override;
  void set_forces(In f) noexcept override;
  void velocities(double t, In q, In v, Out u) noexcept override;
  void responses(In dv, Out du) noexcept override;
  double balance(In w, In u, double tolerance, InOut f) noexcept override;
  void let_go(bool found) noexcept override;

 private:
  /// Contact at the state about which its laws are linear.
  struct Taken {
    Multipliers* of;
    std::size_t point;
    Mat3 axes;
    Vec velocity, force;  // of the point, m/s, in the world; on it, N, in the axes
    double friction;
  };

  ContactForm& form_;
  std::span<const std::shared_ptr<Effect>> held_;
  PointsAt points_at_;
  std::vector<double> before_;  // multipliers before the first take(), empty: let go
  double t_ = 0;                // the state that the laws are linear about
  double since_ = by_time;      // last teleport before it
  std::vector<double> q_, v_;
  std::vector<Taken> taken_;
  std::vector<RigidTouch> touches_;  // scratch, as are those below
  std::vector<double> v_changed_, blocks_;
  ContactProblem::Compliance compliance_;
  ContactProblem problem_;
};

}  // namespace tress::models
