#pragma once

#include <memory>
#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/forms/contact_form.h"
#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/material_points.h"
#include "contract/forms/sparse_form.h"
#include "contract/pattern.h"
#include "contract/system.h"
#include "models/constrained/constraint_set.h"
#include "models/effects/effect.h"
#include "models/held/held_contacts.h"

namespace tress::models {

/// The parts of a particle system. Example, a two-link pendulum:
///
///     ParticleScene scene;
///     const Node pivot = scene.add_anchor({0, 0, 0});
///     const Node a = scene.add_particle(1.0, {1, 0, 0});
///     const Node b = scene.add_particle(1.0, {2, 0, 0});
///     scene.constraints.push_back(distance(pivot, a, 1.0));
///     scene.constraints.push_back(distance(a, b, 1.0));
///     scene.effects.push_back(std::make_unique<Gravity>(Vec{0, 0, -9.81}));
///     ParticleSystem system(std::move(scene));
///
/// Add particles and constraints in the order of their connection: see constraint_set.h.
/// Modules: joints.h, on_curve.h, angles.h, or the caller's own.
struct ParticleScene {
  /// A particle and its start.
  struct Particle {
    double mass;    // kg, > 0
    Vec x, v;       // at t = 0, m and m/s
    double length;  // strand length carried, m, on which drag acts
  };
  /// A massless parameter and its start.
  struct MasslessParameter {
    double s, rate;  // at t = 0
  };

  /// Adds a particle and returns its node.
  Node add_particle(double mass, Vec x, Vec v = {}, double length = 0);
  /// Adds a massless parameter and returns its node.
  Node add_parameter(double s, double rate = 0);
  /// Adds a fixed anchor (m) and returns its node.
  Node add_anchor(Vec x);
  Node add_anchor(std::shared_ptr<const Curve> motion);  // time in s is its parameter

  std::vector<Particle> particles;            // particles in order
  std::vector<MasslessParameter> parameters;  // massless parameters in order
  std::vector<Anchor> anchors;                // anchors in order
  Constraints constraints;                    // constraints between them
  Effects effects;                            // effects on the particles
  double typical_speed = 0;  // m/s; at least the fastest particle's; 0: extent per second
};

/// Particles with any constraints and effects ("tinkertoys"):
///
///     r = M a - f(t, x, v),   M = diag(m_i I3, 0 for parameters),
///     S(w) = w.acc M - w.pos df/dx - w.vel df/dv   (3x3 blocks of the effects).
///
/// q = (x_1, ..., x_N, s_1, ...) in m (parameters in their curve's unit). Effects see the
/// particles through Points, of which only the needed fields are computed; without
/// effects f = 0 costs nothing. residual is O(N), linearize and solve invert 3x3 blocks.
/// With parameters M is singular: traits().regular_mass is false and linearize returns
/// `fatal`. The KKT matrix is regular: use a constrained formulation, which reads
/// sparse_form() and constraint_form(). power() omits the work of moving anchors, which
/// depends on the multipliers.
class ParticleSystem final : public System,
                             private SparseForm,
                             private ExplicitForm,
                             private Energetics,
                             private MaterialPoints {
 public:
  /// Throws InputError if there are no particles, a mass is not positive, a number is not
  /// finite, or the state violates the constraints.
  explicit ParticleSystem(ParticleScene scene);

  Layout layout() const override;
  Traits traits() const override;
  void initial_state(Out q, Out v) const override;
  void scale(Out q_typ, Out v_typ) const override;
  Status residual(double t, In q, In v, In a, Out r) noexcept override;
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override;
  Status solve(In b, Out x) noexcept override;
  double next_breakpoint(double t) const override {
    return models::next_breakpoint(scene_.effects, t);
  }
  std::string not_finite(double t, In q, In v) override;

  SparseForm* sparse_form() override { return this; }
  ExplicitForm* explicit_form() override;
  ConstraintForm* constraint_form() override;
  Energetics* energetics() override { return this; }
  MaterialPoints* material_points() override { return this; }
  ContactForm* contact_form() override { return held_contacts_.form(); }

 private:
  const Pattern& pattern() const override { return pattern_; }
  Status values(double t, In q, In v, In a, Weights w, Out s) noexcept override;
  Status acceleration(double t, In q, In v, Out a) noexcept override;
  Energy energy(double t, In q, In v) override;
  double power(double t, In q, In v) override;
  int count() const override { return particles_; }
  void positions(double t, In q, Out x) override;
  void velocities(double t, In q, In v, Out u) override;
  std::optional<Mean> mean(int point) override {
    return Mean{.count = 1, .coordinate = {3 * point}, .weight = {1}};
  }

  void validate() const;
  void build_pattern();
  void check_initial_state();
  Points points(In q, In v) const;
  void load(double t, In q, In v) noexcept;
  void blocks(double t, In q, In v, Weights w) noexcept;

  ParticleScene scene_;
  HeldContacts held_contacts_;
  int particles_;
  int coordinates_;
  double extent_;  // m, > 0
  double speed_;   // m/s, > 0
  Needs needs_;
  ConstraintSet constraints_;
  Pattern pattern_;
  std::vector<int> block_;  // (9 particles) indices of the 3x3 blocks in pattern_
  std::vector<double> mass_, length_;
  std::vector<double> load_;     // (3 particles)
  std::vector<double> blocks_;   // (9 particles) S(w), row-major
  std::vector<double> inverse_;  // (9 particles)
};

}  // namespace tress::models
