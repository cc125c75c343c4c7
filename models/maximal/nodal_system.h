#pragma once

#include <memory>
#include <vector>

#include "contract/forms/contact_form.h"
#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/material_points.h"
#include "contract/forms/teleports.h"
#include "contract/jacobian_choice.h"
#include "contract/pattern.h"
#include "contract/system.h"
#include "linear/linear_solver.h"
#include "math/dual.h"
#include "models/effects/effect.h"
#include "models/held/held_contacts.h"
#include "models/maximal/staggered_rod.h"

namespace tress::models {

/// The parts of the system of kirchhoff_nodal.cpp.
struct NodalParts {
  StaggeredRod rod;                     // discretisation
  RootMotion root;                      // motion of the root
  std::vector<double> node_length;      // length seen by effects, m
  std::vector<double> node_arc;         // arc length from the root at rest, m
  std::vector<double> start;            // curvatures at t = 0
  double curvature = 1, rate = 1;       // typical sizes, 1/m and 1/s
  Jacobian jacobian = Jacobian::exact;  // terms of the Jacobian
  Effects effects;                      // effects on the nodes
};

/// Kirchhoff's equations in curvatures behind the contract of contract/system.h.
class NodalSystem final : public System,
                          public Teleports,
                          private ExplicitForm,
                          private Energetics,
                          private MaterialPoints {
 public:
  /// Takes the parts of a strand.
  explicit NodalSystem(NodalParts parts);

  Layout layout() const override { return {static_cast<int>(parts_.start.size()), 0}; }
  Traits traits() const override { return {.constant_mass = true}; }
  void initial_state(Out q, Out v) const override;
  void scale(Out q_typ, Out v_typ) const override;
  Status residual(double t, In q, In v, In a, Out r) noexcept override;
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override;
  Status solve(In b, Out x) noexcept override;
  double next_breakpoint(double t) const override {
    return std::min(parts_.root.next_breakpoint(t),
                    models::next_breakpoint(parts_.effects, t));
  }
  double next_teleport(double t) const override { return parts_.root.next_teleport(t); }
  /// Curvatures are relative to the root.
  void teleport(double t, InOut /*q*/, InOut /*v*/) override { follow(t); }
  void follow(double t) override { parts_.root.since = t; }
  std::string not_finite(double t, In q, In v) override;

  ExplicitForm* explicit_form() override { return this; }
  Energetics* energetics() override { return this; }
  MaterialPoints* material_points() override { return this; }
  ContactForm* contact_form() override { return held_contacts_.form(); }

 private:
  /// Number of simultaneous directions, chosen to fill the registers.
  static constexpr int directions = 8;
  using Number = Dual<directions>;

  Status acceleration(double t, In q, In v, Out a) noexcept override;
  Energy energy(double t, In q, In v) override;
  double power(double t, In q, In v) override;
  int count() const override { return static_cast<int>(motion_.x.size()); }
  void positions(double t, In q, Out x) override;
  void velocities(double t, In q, In v, Out u) override;
  /// Lengths are no unknowns.
  std::optional<double> stretch(double, In) override { return 0; }

  void place(double t, In q, In v) noexcept;
  Points points(Needs wanted) noexcept;
  void load(double t) noexcept;
  void load_slopes(double t) noexcept;
  void differentiate(const StaggeredRod& rod, const RootPose& root) noexcept;
  void exact_tangent(double t, In q, In v, Weights w) noexcept;
  Status stiff_tangent(Weights w) noexcept;
  void find_leading_terms();

  NodalParts parts_;
  HeldContacts held_contacts_;
  Needs needs_;
  RootPose pose_;  // at the last requested time
  StaggeredMotion<double> motion_;
  StaggeredMotion<Number> moved_;
  std::vector<Number> q_, v_, a_;
  std::vector<double> x_, u_, tangent_, load_;             // per node, as seen by effects
  std::vector<double> load_by_x_, load_by_v_, load_by_t_;  // (9 nodes)
  std::vector<double> zero_;
  Pattern pattern_;
  std::vector<double> leading_by_q_,
      leading_by_v_;  // derivatives of -a on the pattern, elastic Jacobian
  std::vector<double> values_;
  Weights factored_;  // weights of the elastic Jacobian in solver_
  std::unique_ptr<LinearSolver> solver_;
};

}  // namespace tress::models
