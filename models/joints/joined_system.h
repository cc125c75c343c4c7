#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "contract/forms/bordered_form.h"
#include "contract/forms/joint_forces.h"
#include "contract/forms/loaded_tangent.h"
#include "contract/forms/moving_history.h"
#include "contract/forms/stress_form.h"
#include "contract/forms/support_forces.h"
#include "linear/bordered.h"
#include "linear/dense_lu.h"
#include "models/bodies/body_system.h"
#include "models/groom/strand_block.h"
#include "models/joints/joined_rows.h"
#include "models/supports/last_matrix.h"

namespace tress::models {

/// Strands that joints connect, as one system: the strands' own equations with the forces
/// of springs and elastic halves (JointPair) and the constraints of JoinedRows. Methods
/// drive it in every formulation that they have for systems with constraints.
///
/// The matrix is S = diag(S_1, ..., S_K) + U V^T. Block k is that of strand k under the
/// constant loads of its joints. Strands that take loads have it by LoadedTangent in
/// O(n), others as a sparse matrix with the second derivatives of their constraints. U
/// and V have the derivatives of the joints' loads by the motion of both ends, three
/// columns for each joint with a spring or a rotation (Sherman-Morrison-Woodbury).
/// Constraints are eliminated by Bordered. With m constraints and c columns, a matrix
/// costs (m + c) solves of all strands, and a dense factorisation of m and c.
class JoinedSystem final : public StrandBlock,
                           public BorderedForm,
                           public SupportForces,
                           public JointForces,
                           private SparseForm,
                           private MovingHistory,
                           private StressForm {
 public:
  /// `where`: of each joint, in messages. The last `bodies` strands are BodySystems; they
  /// are the first ends of joints. Throws InputError naming a joint that the models do
  /// not admit.
  JoinedSystem(std::vector<std::unique_ptr<SupportedSystem>> strands,
               const std::vector<Joint>& joints, const std::vector<std::string>& where,
               std::size_t bodies = 0);

  /// Returns the constraints.
  JoinedRows& rows() { return *rows_; }
  /// Returns a strand with its supports.
  SupportedSystem& held(std::size_t k) const { return *held_[k]; }
  /// Returns the number of the strand that is this body; empty: none.
  std::optional<std::size_t> member_of(const DrivenBody& effect) const;
  /// Returns the body that is strand k; null: it is a strand.
  BodySystem* body(std::size_t k) const;
  /// Returns the first coordinate of strand k.
  std::size_t first_coordinate(std::size_t k) const { return first_of(k); }
  /// Returns the power of the joints on bodies, W.
  double power_into_bodies(double t, In q, In v);
  /// Makes S exact, for derivatives of runs: those of joints with friction, and of slack
  /// springs, are bounded or left out in runs.
  void be_exact();
  /// The state from which runs begin.
  void begin_at(In q, In v);

  Layout layout() const override {
    return {StrandBlock::layout().coordinates, rows_->rows()};
  }
  Status residual(double t, In q, In v, In a, Out r) noexcept override;
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    return linearize_bordered(t, q, v, a, {}, w);
  }
  Status solve(In b, Out x) noexcept override;
  bool bordered() const override { return rows_->rows() > 0; }
  Status linearize_bordered(double t, In q, In v, In a, In lambda,
                            Weights w) noexcept override;
  /// Full, from solutions with S: for methods that need entries.
  SparseForm* sparse_form() override;
  ConstraintForm* constraint_form() override {
    return rows_->rows() > 0 ? rows_.get() : nullptr;
  }
  StressForm* stress_form() override { return stressed_.empty() ? nullptr : this; }
  History* history() override { return this; }

  std::size_t supports() const override;
  Status support_forces(double t, In q, In v, Out forces, Out moments) override;
  void support_motion(double t, Out x, Out u, Out omega) const override;
  double moment_power(double t, In q, In v, const Vec& turning) override;
  bool natural_moves() const override;
  double natural_power(double t, In q) override;
  NaturalWork natural_work(double from, In q_from, double to, In q_to) override;
  std::size_t joints() const override { return joints_.size(); }
  Status joint_forces(double t, In q, In v, Out forces, Out moments) override;

 private:
  /// Block of a strand that takes no loads.
  struct Assembled {
    SparseForm* form = nullptr;  // null: the strand takes loads
    std::unique_ptr<LinearSolver> solver{};
    std::vector<double> values{};
  };

  const Pattern& pattern() const override { return full_->pattern(); }
  Status values(double t, In q, In v, In a, Weights w, Out s) noexcept override;
  Energy energy(double t, In q, In v) override;
  double power(double t, In q, In v) override;
  bool accept(double t, InOut q, InOut v) override { return accept_strands(t, q, v); }
  bool carry(double t, InOut q, InOut v, InOut a) const override {
    return carry_strands(t, q, v, a);
  }
  std::string not_smooth() const override { return strands_not_smooth(); }
  void reset() override;
  std::vector<double> memory() const override { return memory_of_strands(); }
  void recall(In memory) override { recall_strands(memory); }
  void take_stresses(double t, In q, Stresses stresses) noexcept override;

  void make_joints(const std::vector<Joint>& joints,
                   const std::vector<std::string>& where);
  std::size_t first_of(std::size_t k) const { return static_cast<std::size_t>(first(k)); }
  void hang_loads(double t, In q, In v, In lambda);
  Status factor_strand(std::size_t k, double t, In q, In v, In a, In lambda,
                       Weights w) noexcept;
  Status factor(double t, In q, In v, In a, In lambda, Weights w) noexcept;
  Status couple(double t, In q, In v, In lambda, Weights w) noexcept;
  Status solve_strands(InOut x) noexcept;
  Status solve_factored(InOut x) noexcept;
  /// Sets the natural strains of time t.
  void prepare(double t);
  Status hold(double t, In q, In v) noexcept;
  double potential_as_set(double t, In q);

  std::vector<SupportedSystem*> held_;
  std::vector<JointPair> joints_;
  std::vector<StrandPoint> ends_;  // a and b of each joint
  std::unique_ptr<JoinedRows> rows_;
  std::vector<Assembled> assembled_;             // of each strand
  std::vector<std::vector<SectionLoad>> loads_;  // on each strand, by its joints
  std::vector<std::size_t> stressed_;            // strands with a StressForm
  LastMatrix last_;                              // which hold() and values() replace
  std::optional<DenseTangent> full_;             // made when it is needed
  // U, V, S^-1 U over the blocks, and 1 + V^T S^-1 U.
  Eigen::MatrixXd u_, v_, responses_, inner_;
  Eigen::VectorXd inner_x_;
  std::optional<DenseLu> inner_lu_;
  bool coupled_ = false;  // the last factor() has U and V
  // Of hold(), at its state.
  std::unique_ptr<Bordered> eliminated_;
  std::vector<double> gradient_, lambda_, acceleration_, alone_, zero_, v_typ_, scratch_;
};

/// Returns a strand as one with supports, which it may be already.
std::unique_ptr<SupportedSystem> as_supported(std::unique_ptr<System> strand);

}  // namespace tress::models
