#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contract/forms/bordered_form.h"
#include "contract/forms/energetics.h"
#include "contract/forms/loaded_tangent.h"
#include "contract/forms/moving_history.h"
#include "contract/forms/stress_form.h"
#include "contract/forms/support_forces.h"
#include "models/supports/added_forces.h"
#include "models/supports/assembled_solver.h"
#include "models/supports/dense_tangent.h"
#include "models/supports/last_matrix.h"
#include "models/supports/natural_motion.h"
#include "models/supports/support_rows.h"
#include "models/supports/supported_compliance.h"

namespace tress::models {

/// Moments and natural strains over time that drive a strand.
struct StrandDrives {
  std::vector<PointMoment> moments{};  // moments on its sections
  NaturalMotion natural{};             // natural strains over time
};

class SupportedSystem;

/// Returns the power (W) of natural strains that move: the derivative of the potential
/// energy by time at fixed places. `potential`() is that of the strains set last.
double power_of_natural(std::span<SupportedSystem* const> strands, double t,
                        const std::function<double()>& potential);
/// Returns the work of natural strains between two times. `potential`(end) is that of the
/// strains set last at the places of the start or of the end.
NaturalWork work_of_natural(std::span<SupportedSystem* const> strands, double from,
                            double to, const std::function<double(bool)>& potential);

/// A strand whose points and sections are held by supports or loaded by moments: the
/// strand's own equations with AddedForces and the constraints of SupportRows. Its
/// natural strains may follow a NaturalMotion. Methods drive it in every formulation that
/// they have for systems with constraints; without constraints, as they drive the strand.
///
/// S is the strand's own, with the derivatives of the added forces and the constraints:
///
///     strand                  matrix
///     has a SparseForm        its sparse matrix
///     takes loads             LoadedTangent in O(n): forces of supports and added
///                             forces are loads. Methods that need entries get a
///                             DenseTangent
///     any other               a DenseTangent
///
/// The power of supports belongs to Energetics::power. At a state, let a and a' be the
/// accelerations with and without supports and added forces. U is the energy of joints
/// and springs. E_t is the derivative of the elastic energy by time at fixed coordinates,
/// where natural strains move. Kinetic energy is quadratic in v, so
///
///     power = (power of the strand alone) + dT/dv . (a - a') + dU/dt + E_t,
///
/// which has the work of the supports and the change of the work of a moving root.
class SupportedSystem final : public System,
                              public SupportForces,
                              public BorderedForm,
                              private SparseForm,
                              private StressForm,
                              private Energetics,
                              private MovingHistory {
 public:
  /// Throws InputError naming the support, or the moment, if the strand cannot be held
  /// or loaded so.
  SupportedSystem(std::unique_ptr<System> strand, std::vector<Support> supports,
                  StrandDrives drives = {});

  /// The state from which runs begin, and what the strand remembers of its way there.
  /// Without it: that of the strand.
  void begin_at(In q, In v);
  /// Returns true if begin_at() has moved the strand from its own start.
  bool begins_elsewhere() const;
  /// Returns the strand without its supports.
  System& strand() { return *strand_; }
  /// Returns the constraints.
  SupportRows& rows() { return rows_; }
  /// Returns the moments on the sections.
  const std::vector<MomentOnSection>& moments() const { return forces_.moments(); }
  /// Returns the natural strains over time.
  const NaturalMotion& natural() const { return drives_.natural; }
  /// Sets the natural strains of time t.
  void prepare(double t) {
    if (drives_.natural.any()) drives_.natural.set(*strains_, t);
  }
  /// Sets those of time t, continued by `ahead` (s) as they change at t.
  void prepare_beyond(double t, double ahead) {
    if (drives_.natural.any()) drives_.natural.set_beyond(*strains_, t, ahead);
  }

  Layout layout() const override { return {strand_->layout().coordinates, rows_.rows()}; }
  Traits traits() const override { return strand_->traits(); }
  void initial_state(Out q, Out v) const override;
  void scale(Out q_typ, Out v_typ) const override { strand_->scale(q_typ, v_typ); }
  Status residual(double t, In q, In v, In a, Out r) noexcept override;
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    return linearize_bordered(t, q, v, a, {}, w);
  }
  Status solve(In b, Out x) noexcept override;
  bool bordered() const override { return loaded_ != nullptr && rows_.rows() > 0; }
  Status linearize_bordered(double t, In q, In v, In a, In lambda,
                            Weights w) noexcept override {
    return linearize_with_springs(t, q, v, a, lambda, w, {});
  }
  /// Returns true if linearize_with_springs() takes springs.
  bool takes_springs() const { return loaded_ != nullptr; }
  /// linearize_bordered() with w.pos times springs on the coordinates (n; none: empty)
  /// and under additional loads, for strands that take loads.
  Status linearize_with_springs(double t, In q, In v, In a, In lambda, Weights w,
                                In springs,
                                std::span<const SectionLoad> loads = {}) noexcept;
  double next_breakpoint(double t) const override;
  std::string not_finite(double t, In q, In v) override {
    return strand_->not_finite(t, q, v);
  }
  SparseForm* sparse_form() override {
    SparseForm& own = of_strand();
    return changed() ? this : &own;
  }
  ConstraintForm* constraint_form() override { return &rows_; }
  ComplianceForm* compliance_form() override;
  StressForm* stress_form() override {
    return strand_->stress_form() == nullptr ? nullptr : this;
  }
  Energetics* energetics() override {
    return strand_->energetics() == nullptr ? nullptr : this;
  }
  MaterialPoints* material_points() override { return strand_->material_points(); }
  History* history() override { return strand_->history() == nullptr ? nullptr : this; }

  std::size_t supports() const override { return rows_.supports().size(); }
  Status support_forces(double t, In q, In v, Out forces, Out moments) override;
  void support_motion(double t, Out x, Out u, Out omega) const override;
  /// Computes the forces and moments of support_forces() for these multipliers of all
  /// constraints.
  void loads_of(double t, In q, In v, In lambda, Out forces, Out moments);
  /// Returns the rate of the elastic energy of half joints and springs, W.
  double added_energy_rate(double t, In q, In v) { return forces_.energy_rate(t, q, v); }
  double moment_power(double t, In q, In v, const Vec& turning) override;
  bool natural_moves() const override { return drives_.natural.any(); }
  double natural_power(double t, In q) override;
  NaturalWork natural_work(double from, In q_from, double to, In q_to) override;
  /// Returns the potential energy at the natural strains that were set last, J.
  double potential_as_set(double t, In q);

  // For searches that lead the strand onto its supports.
  /// Writes the rotations (rad) of the half joints less those of the start, (3 joints).
  void joint_rotations(double t, In q, Out c) {
    prepare(t);
    forces_.joint_rotations(t, q, c);
  }
  /// Returns the number of half joints.
  std::size_t joints() const { return forces_.joints(); }
  /// Moves the rest values of the half joints, (3 joints) rad; 0 at first.
  void lead_joints(In by) { forces_.lead_joints(by); }

 private:
  SparseForm& of_strand();
  const Pattern& pattern() const override {
    return dense_ ? dense_->pattern() : strand_->sparse_form()->pattern();
  }
  Status values(double t, In q, In v, In a, Weights w, Out s) noexcept override;
  Energy energy(double t, In q, In v) override;
  std::optional<Momentum> momentum(double t, In q, In v) override {
    return strand_->energetics()->momentum(t, q, v);
  }
  double power(double t, In q, In v) override;

  bool accept(double t, InOut q, InOut v) override {
    return strand_->history()->accept(t, q, v);
  }
  void reset() override;
  std::vector<double> memory() const override { return strand_->history()->memory(); }
  void recall(In memory) override { strand_->history()->recall(memory); }
  bool carry(double t, InOut q, InOut v, InOut a) const override {
    return tress::carry(*strand_, t, q, v, a);
  }
  std::string not_smooth() const override { return tress::not_smooth(*strand_); }

  void take_stresses(double t, In q, Stresses stresses) noexcept override {
    prepare(t);
    strand_->stress_form()->take_stresses(t, q, stresses);
  }

  /// Whether the matrix or the residual is not the strand's own.
  bool changed() const { return forces_.any() || drives_.natural.any(); }
  Status factor(double t, In q, In v, In a, In lambda, Weights w, In springs,
                std::span<const SectionLoad> loads) noexcept;
  Status solve_factored(In b, Out x) noexcept {
    return in_assembled_ ? assembled_->solve(b, x) : strand_->solve(b, x);
  }
  double product(Eigen::Index row, const double* x) const;
  Status hold(double t, In q, In v);
  void multipliers(int rows, std::vector<double>& lambda) const;

  std::unique_ptr<System> strand_;
  SupportRows rows_;
  LoadedTangent* loaded_;              // null: the strand takes no loads
  std::optional<DenseTangent> dense_;  // made when of_strand() is needed
  StrandDrives drives_;                // the moments move to forces_
  AddedForces forces_;
  NaturalStrains* strains_;
  std::optional<SupportedCompliance> compliant_;  // made by compliance_form()
  std::optional<AssembledSolver> assembled_;  // of forces on a strand that takes no loads
  bool in_assembled_ = false;                 // whether it has the last matrix
  std::vector<SectionLoad> loads_;            // scratch of factor()
  LastMatrix last_;                           // which hold() and values() replace
  std::vector<double> begin_q_, begin_v_, begin_memory_;
  // Of hold(), at its state.
  std::vector<double> gradient_, acceleration_, bias_, zero_, v_typ_;
  double short_time_;           // s, of the step that replaces a singular mass matrix
  Eigen::MatrixXd responses_;   // S^-1 G^T
  Eigen::MatrixXd compliance_;  // G S^-1 G^T
  Eigen::VectorXd needed_;      // change of g'' that the multipliers must cause
};

}  // namespace tress::models
