#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/forms/bordered_form.h"
#include "contract/forms/driven_bodies.h"
#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/joint_forces.h"
#include "contract/forms/material_points.h"
#include "contract/forms/moving_history.h"
#include "contract/forms/stress_form.h"
#include "contract/forms/support_forces.h"
#include "linear/dense_lu.h"
#include "models/bodies/body_system.h"
#include "models/driven/driven_rows.h"
#include "models/groom/strand_block.h"
#include "models/joints/joined_system.h"
#include "models/supports/dense_tangent.h"
#include "models/supports/last_matrix.h"

namespace tress::models {

/// A strand, or several as one system, with the bodies that they drive. The coordinates
/// are those of the strand, then those of each body (BodySystem). Bodies to which strands
/// are joined are members of the JoinedSystem, its last ones; others follow it. Strand
/// and bodies are solved together, so a light body is as stable as a heavy one.
///
/// The matrix is that of strand and bodies, plus U V^T: the derivatives of the contact
/// forces, two columns for each coordinate of a body that is touched
/// (Sherman-Morrison-Woodbury). They are mapped by the strand's own residual with these
/// as loads. In models whose points are not linear in the coordinates, the derivative of
/// the points' velocities by the coordinates is a central difference along the motion. A
/// matrix costs two solves and 3 to 7 residuals for each such coordinate more.
///
/// Supports, joints and constraints are those of the strand (DrivenRows).
class DrivenSystem final : public System,
                           public DrivenBodies,
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
  /// must have a BorderedForm. `gravity`: acceleration of free bodies, m/s^2. Throws
  /// InputError if the strand has exact contact.
  DrivenSystem(std::unique_ptr<System> strand,
               const std::vector<const DrivenBody*>& bodies, const Vec& gravity);

  Layout layout() const override {
    return {static_cast<int>(all_), strand_->layout().constraints};
  }
  Traits traits() const override;
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
  Motion motion(In q, In v, std::size_t body) const override {
    return bodies_[body].system->motion(of_body(q, body), of_body(v, body));
  }
  OfBodies energy_of_bodies(double t, In q, In v) override;
  Vec mass_moment(In q) const override;

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
  /// A body.
  struct Driven {
    const DrivenBody* effect;
    BodySystem* system;
    std::size_t first, size;            // coordinates among all
    std::size_t column;                 // first one among those of all bodies
    std::optional<std::size_t> member;  // number in the JoinedSystem
  };
  template <class Span>
  Span of_strand(Span all) const {
    return all.first(strand_size_);
  }
  template <class Span>
  Span of_body(Span all, std::size_t k) const {
    return all.subspan(bodies_[k].first, bodies_[k].size);
  }
  /// Sets the motion of all bodies.
  void place(In q, In v) const;
  /// Calls act(), a residual of the strand, while the bodies record their loads.
  template <class Act>
  Status recorded(const Act& act) noexcept {
    for (const Driven& body : bodies_) body.effect->record();
    const Status s = act();
    for (const Driven& body : bodies_) body.effect->act();
    return s;
  }
  /// Calls act(body, its number) for each body that is no member of the JoinedSystem.
  template <class Act>
  Status each_loose(const Act& act) const noexcept {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      if (bodies_[k].member) continue;
      if (const Status s = act(*bodies_[k].system, k); s != Status::ok) return s;
    }
    return Status::ok;
  }
  static InOut column(Eigen::MatrixXd& of, std::size_t k) {
    return {of.col(static_cast<Eigen::Index>(k)).data(),
            static_cast<std::size_t>(of.rows())};
  }
  Status border(double t, In q, In v, Weights w) noexcept;
  Status border_of(std::size_t k, double t, In q, In v, Weights w) noexcept;
  double lift(In loads) const;
  Status pull(double t, In q, std::size_t k, In loads, InOut to) noexcept;
  Status add_turning_points(double t, In q, In v, std::size_t k, In rate,
                            InOut to) noexcept;
  Status couple() noexcept;
  Status solve_parts(InOut x) noexcept;

  const Pattern& pattern() const override { return full_->pattern(); }
  Status values(double t, In q, In v, In a, Weights w, Out s) noexcept override;
  Status factor(double t, In q, In v, In a, In lambda, Weights w) noexcept;
  Status acceleration(double t, In q, In v, Out a) noexcept override;
  Energy energy(double t, In q, In v) override;
  /// Returns the momentum of the strand and the free bodies: bearings carry momentum
  /// away.
  std::optional<Momentum> momentum(double t, In q, In v) override;
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
  bool carry(double t, InOut q, InOut v, InOut a) const override;
  std::string not_smooth() const override { return tress::not_smooth(*strand_); }
  void take_stresses(double t, In q, Stresses stresses) noexcept override {
    strand_->stress_form()->take_stresses(t, of_strand(q), stresses);
  }

  std::unique_ptr<System> strand_;
  JoinedSystem* joined_;  // the strand; null: it is another system
  std::vector<Driven> bodies_;
  std::vector<std::unique_ptr<BodySystem>> loose_;
  MaterialPoints* points_;
  BorderedForm* constrained_;  // null: the strand has no constraints
  SupportForces* supports_;    // null: none
  JointForces* joints_;        // null: none
  std::optional<DrivenRows> rows_;
  std::optional<DenseTangent> full_;  // made when it is needed
  std::size_t strand_size_, all_;
  bool linear_points_;  // points are means of coordinates
  std::vector<double> q_typ_, zero_;
  LastMatrix last_;  // of systems with constraints, which values() replaces
  // Of the last linearize(), where strand and bodies touch: column k of u_ has the
  // derivatives of the strand's residual by a coordinate of a body, that of v_ a 1 there;
  // of the second half, the opposite.
  bool coupled_ = false;
  Eigen::MatrixXd u_, v_;
  Eigen::MatrixXd responses_;  // S^-1 U
  Eigen::MatrixXd inner_;      // 1 + V^T S^-1 U
  Eigen::VectorXd inner_x_;
  DenseLu lu_;
  std::vector<Screw> screws_;
  DrivenBody::Slopes slopes_;
  std::vector<double> r_, base_, pulled_, shifted_;  // scratch
};

/// Returns the strand, with the driven bodies among these effects if there are any.
std::unique_ptr<System> with_driven_bodies(std::unique_ptr<System> strand,
                                           const Effects& effects);
/// Returns the strands that are one system, with bodies or without; null for one strand.
const StrandBlock* block_of(const System& system);

}  // namespace tress::models
