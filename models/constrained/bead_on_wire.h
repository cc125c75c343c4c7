#pragma once

#include <array>
#include <memory>
#include <span>

#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/material_points.h"
#include "contract/forms/sparse_form.h"
#include "contract/jacobian_choice.h"
#include "contract/parameters.h"
#include "contract/pattern.h"
#include "contract/system.h"
#include "models/constrained/curve.h"
#include "models/constrained/particles.h"
#include "models/effects/effect.h"

namespace tress::models {

/// Bead of mass m on a wire x = c(s) in parametric form: one coordinate s, no constraint
/// (the violation is zero because no g exists),
///
///     r = c'.(m (c' s'' + c'' s'^2) - f(t, x, x')),    x' = c' s',    M = m |c'|^2,
///
/// The Jacobian is the exact one (including c''') or the stiff one. The latter drops the
/// s and s' derivatives of the inertia terms m c'.(c' s'' + c'' s'^2) and keeps those of
/// the load. The implicit form (x, lambda) is a ParticleSystem with one module of
/// on_curve.h. Units: s in the curve's unit (rad for those built here). Every call is
/// O(1).
class BeadOnWire final : public System,
                         private SparseForm,
                         private ExplicitForm,
                         private Energetics,
                         private MaterialPoints {
 public:
  /// Bead, wire and start.
  struct Setup {
    std::shared_ptr<const Curve> curve;   // shape of the wire
    double mass = 1;                      // kg, > 0
    double length = 1;                    // m, strand length on which drag acts
    double start = 0;                     // s at t = 0
    double start_speed = 0;               // m/s along increasing s
    double extent = 1;                    // m, typical size
    double typical_speed = 1;             // m/s
    bool uniform = false;                 // |c'| is the same everywhere: M is constant
    Jacobian jacobian = Jacobian::exact;  // terms of the Jacobian
  };

  /// Throws InputError if mass <= 0 or c' = 0 at the start.
  BeadOnWire(Setup setup, Effects effects);

  Layout layout() const override { return {1, 0}; }
  Traits traits() const override { return {.constant_mass = setup_.uniform}; }
  void initial_state(Out q, Out v) const override;
  void scale(Out q_typ, Out v_typ) const override;
  Status residual(double t, In q, In v, In a, Out r) noexcept override;
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override;
  Status solve(In b, Out x) noexcept override;
  SparseForm* sparse_form() override { return this; }
  ExplicitForm* explicit_form() override { return this; }
  Energetics* energetics() override { return this; }
  MaterialPoints* material_points() override { return this; }

 private:
  struct State;

  const Pattern& pattern() const override { return pattern_; }
  Status values(double t, In q, In v, In a, Weights w, Out s) noexcept override;
  Status acceleration(double t, In q, In v, Out a) noexcept override;
  Energy energy(double t, In q, In v) override;
  double power(double t, In q, In v) override;
  int count() const override { return 1; }
  void positions(double t, In q, Out x) override;
  void velocities(double t, In q, In v, Out u) override;

  State state(In q, In v) const noexcept;
  Vec load(double t, const State& at) const noexcept;
  double tangent(double t, In q, In v, In a, Weights w) const noexcept;

  Setup setup_;
  Effects effects_;
  Needs needs_;
  Pattern pattern_{.rows = 1, .cols = 1, .start = {0, 1}, .row = {0}};
  double tangent_ = 0;
};

/// Returns the parameters of the model.
std::span<const Parameter> bead_on_wire_parameters();
/// Makes the model.
std::unique_ptr<System> make_bead_on_wire(const Parameters& parameters);

}  // namespace tress::models
