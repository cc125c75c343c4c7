#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/forms/bordered_form.h"
#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/joint_forces.h"
#include "contract/forms/material_points.h"
#include "contract/forms/moving_history.h"
#include "contract/forms/stress_form.h"
#include "contract/forms/support_forces.h"
#include "contract/forms/turning_bodies.h"
#include "linear/dense_lu.h"
#include "models/effects/body.h"
#include "models/groom/strand_block.h"
#include "models/supports/dense_tangent.h"
#include "models/turning/turning_rows.h"

namespace tress::models {

/// A strand, or several as one system, with the bodies that they turn. The coordinates
/// are those of the strand, then the angle theta of each body about its axis:
///
///     I theta'' + c theta' - M - m(q, q', theta, theta') = 0,
///
/// with the moment of inertia I, the damping c of the bearing, the prescribed moment M
/// and the moment m of the contact forces (TurningBody). The equations are solved
/// together, so a light body is as stable as a heavy one.
///
/// The matrix is that of the strand with a border: a column and a row for each body. The
/// border has the derivatives of the contact forces, mapped by the strand's own residual
/// with these as loads. In models whose points are not linear in the coordinates, the
/// derivative of the points' velocities by the coordinates is a central difference along
/// the motion. A matrix costs one solve and 3 to 7 residuals for each body more.
///
/// Supports, joints and constraints are those of the strand (TurningRows).
class TurningSystem final : public System,
                            public TurningBodies,
                            public BorderedForm,
                            public SupportForces,
                            public JointForces,
                            private SparseForm,
                            private Energetics,
                            private ExplicitForm,
                            private MaterialPoints,
                            private MovingHistory,
                            private StressForm {
 public:
  /// The bodies are effects on the strand and must outlive it. A strand with constraints
  /// must have a BorderedForm. Throws InputError if it has exact contact.
  TurningSystem(std::unique_ptr<System> strand, std::vector<const TurningBody*> bodies);

  Layout layout() const override {
    return {static_cast<int>(all_), strand_->layout().constraints};
  }
  Traits traits() const override { return strand_->traits(); }
  void initial_state(Out q, Out v) const override;
  void scale(Out q_typ, Out v_typ) const override;
  Status residual(double t, In q, In v, In a, Out r) noexcept override;
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    return linearize_bordered(t, q, v, a, {}, w);
  }
  bool bordered() const override { return rows_.has_value(); }
  Status linearize_bordered(double t, In q, In v, In a, In lambda,
                            Weights w) noexcept override;
  Status solve(In b, Out x) noexcept override;
  double next_breakpoint(double t) const override { return strand_->next_breakpoint(t); }
  std::string not_finite(double t, In q, In v) override {
    place(q, v);
    return strand_->not_finite(t, of_strand(q), of_strand(v));
  }
  /// Full, from solutions with S: for methods that need entries.
  SparseForm* sparse_form() override;
  ConstraintForm* constraint_form() override { return rows_ ? &*rows_ : nullptr; }
  ExplicitForm* explicit_form() override {
    return strand_->explicit_form() == nullptr ? nullptr : this;
  }
  StressForm* stress_form() override {
    return strand_->stress_form() == nullptr ? nullptr : this;
  }
  Energetics* energetics() override {
    return strand_->energetics() == nullptr ? nullptr : this;
  }
  MaterialPoints* material_points() override {
    return strand_->material_points() == nullptr ? nullptr : this;
  }
  History* history() override { return this; }

  /// Returns the strand without the bodies.
  System& strand() const { return *strand_; }

  std::size_t bodies() const override { return bodies_.size(); }
  Turn turn(In q, In v, std::size_t body) const override {
    return {q[strand_size_ + body], v[strand_size_ + body]};
  }
  OfBodies energy_of_bodies(double t, In q, In v) override;

  std::size_t supports() const override {
    return supports_ == nullptr ? 0 : supports_->supports();
  }
  Status support_forces(double t, In q, In v, Out forces, Out moments) override;
  void support_motion(double t, Out x, Out u, Out omega) const override;
  double moment_power(double t, In q, In v, const Vec& turning) override;
  bool natural_moves() const override {
    return supports_ != nullptr && supports_->natural_moves();
  }
  double natural_power(double t, In q) override;
  NaturalWork natural_work(double from, In q_from, double to, In q_to) override;
  std::size_t joints() const override {
    return joints_ == nullptr ? 0 : joints_->joints();
  }
  Status joint_forces(double t, In q, In v, Out forces, Out moments) override;

 private:
  /// Arguments of the last linearize_bordered().
  struct Linearized {
    double t = 0;
    std::vector<double> q, v, a, lambda;
    Weights w;
  };
  template <class Span>
  Span of_strand(Span all) const {
    return all.first(strand_size_);
  }
  /// Sets the angles and the angular velocities of all bodies.
  void place(In q, In v) const;
  /// Calls act(), a residual of the strand, while the bodies record their loads.
  template <class Act>
  Status recorded(const Act& act) noexcept {
    for (const TurningBody* body : bodies_) body->record();
    const Status s = act();
    for (const TurningBody* body : bodies_) body->act();
    return s;
  }
  static InOut column(Eigen::MatrixXd& of, std::size_t k) {
    return {of.col(static_cast<Eigen::Index>(k)).data(),
            static_cast<std::size_t>(of.rows())};
  }
  double driving_moment(std::size_t k, double speed) const;
  /// Returns the kinetic energy of the bodies, J.
  double kinetic(In v) const;
  Status border(double t, In q, In v, Weights w) noexcept;
  double lift(In loads) const;
  Status pull(double t, In q, std::size_t k, In loads, Out to) noexcept;
  Status add_turning_points(double t, In q, In v, std::size_t k) noexcept;

  const Pattern& pattern() const override { return full_->pattern(); }
  Status values(double t, In q, In v, In a, Weights w, Out s) noexcept override;
  Status factor(double t, In q, In v, In a, In lambda, Weights w) noexcept;
  Status acceleration(double t, In q, In v, Out a) noexcept override;
  Energy energy(double t, In q, In v) override;
  /// Returns the momentum of the strand alone: the bearings carry momentum away.
  std::optional<Momentum> momentum(double t, In q, In v) override {
    return strand_->energetics()->momentum(t, of_strand(q), of_strand(v));
  }
  double power(double t, In q, In v) override;

  int count() const override { return points_->count(); }
  int before(int i) const override { return points_->before(i); }
  void positions(double t, In q, Out x) override;
  void velocities(double t, In q, In v, Out u) override;
  bool jacobian(double t, In q, Out j) override;
  bool pull_back(double t, In q, std::span<const int> points, In f, InOut b) override {
    return points_->pull_back(t, of_strand(q), points, f, of_strand(b));
  }
  std::optional<double> stretch(double t, In q) override {
    return points_->stretch(t, of_strand(q));
  }
  std::optional<Mean> mean(int point) override { return points_->mean(point); }
  std::optional<std::array<double, 9>> end_frame(double t, In q) override {
    return points_->end_frame(t, of_strand(q));
  }

  bool accept(double t, InOut q, InOut v) override;
  void reset() override;
  std::vector<double> memory() const override;
  void recall(In memory) override;
  bool carry(double t, InOut q, InOut v, InOut a) const override {
    return tress::carry(*strand_, t, of_strand(q), of_strand(v), of_strand(a));
  }
  std::string not_smooth() const override { return tress::not_smooth(*strand_); }
  void take_stresses(double t, In q, Stresses stresses) noexcept override {
    strand_->stress_form()->take_stresses(t, of_strand(q), stresses);
  }

  std::unique_ptr<System> strand_;
  std::vector<const TurningBody*> bodies_;
  MaterialPoints* points_;
  BorderedForm* constrained_;  // null: the strand has no constraints
  SupportForces* supports_;    // null: none
  JointForces* joints_;        // null: none
  std::optional<TurningRows> rows_;
  std::optional<DenseTangent> full_;  // made when it is needed
  std::size_t strand_size_, all_;
  bool linear_points_;  // points are means of coordinates
  double rate_ = 0;     // largest typical rate of a coordinate, 1/s
  std::vector<double> q_typ_, zero_;
  Linearized last_;         // of systems with constraints
  bool disturbed_ = false;  // values() has factored another matrix since
  // Of the last linearize().
  bool bordered_ = false;      // the strand and the bodies touch
  Eigen::MatrixXd column_;     // derivatives of the strand's residual by bodies
  Eigen::MatrixXd responses_;  // S^-1 of them
  Eigen::MatrixXd row_;        // derivatives of the bodies' residuals, a column each
  Eigen::VectorXd own_;        // of these by their own motion
  Eigen::MatrixXd inner_;      // Schur complement
  Eigen::VectorXd inner_x_;
  DenseLu lu_;
  TurningBody::Slopes slopes_;
  std::vector<double> r_, base_, shifted_, ahead_, behind_;  // scratch
};

/// Returns the strand, with the turning bodies among these effects if there are any.
std::unique_ptr<System> with_turning_bodies(std::unique_ptr<System> strand,
                                            const Effects& effects);
/// Returns the strands that are one system, with bodies or without; null for one strand.
const StrandBlock* block_of(const System& system);

}  // namespace tress::models
