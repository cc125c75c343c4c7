#pragma once

#include <memory>
#include <vector>

#include "contract/parameters.h"
#include "contract/system.h"
#include "linear/block_matrix.h"
#include "linear/linear_solver.h"
#include "models/groom/strand_contacts.h"

namespace tress::models {

/// All strands of a scene as one System, coupling = monolithic: q, v and r are those of
/// the strands one after the other, and
///
///     r = (r_1, ..., r_S) - P^T f,    x = P q + prescribed(t)
///
/// with f the contact forces on the material points x (StrandContacts), in both
/// directions at the current state and exactly opposite, so linear momentum is conserved;
/// drag acts across the gap, not along it, so angular momentum is not. The tangent has
/// the strands' tangents on its diagonal and those of the contacts between strands, and
/// is factored sparse by KLU; the mass alone (w.vel = w.pos = 0) couples no strands, and
/// each strand solves with its own. The pattern follows the pairs of segments that may
/// touch: accept() returns true if they have changed, since the factors are then invalid;
/// there is no SparseForm, whose pattern would be fixed. Contacts of points that move
/// more than an eighth of the law's reach within one step may be missed in that step.
/// Before a start from a state other than the initial one, accept() it.
class CoupledStrands final : public System, private Energetics, private MaterialPoints {
 public:
  /// Throws InputError, naming the strand, unless each has a sparse tangent, no
  /// constraints (their multipliers need a fixed pattern) and material points that are
  /// fixed means of coordinates (MaterialPoints::mean).
  CoupledStrands(std::vector<std::unique_ptr<System>> strands, const ContactLaw& law);
  /// From the values of strand_interaction_parameters().
  CoupledStrands(std::vector<std::unique_ptr<System>> strands,
                 const Parameters& parameters);

  Layout layout() const override { return {first_.back(), 0}; }
  Traits traits() const override;
  void initial_state(Out q, Out v) const override;
  void scale(Out q_typ, Out v_typ) const override;
  Status residual(double t, In q, In v, In a, Out r) noexcept override;
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override;
  Status solve(In b, Out x) noexcept override;
  bool accept(double t, InOut q, InOut v) override;
  void reset() override;
  std::vector<double> memory() const override;
  void recall(In memory) override;
  double next_breakpoint(double t) const override;
  std::string not_finite(double t, In q, In v) override;

  /// Null unless all strands have Energetics.
  Energetics* energetics() override;
  MaterialPoints* material_points() override { return this; }

  const StrandContacts& contacts() const { return *contacts_; }
  /// The part of energy() that belongs to the contacts, J.
  double contact_potential(double t, In q, In v);

 private:
  Energy energy(double t, In q, In v) override;
  std::optional<Momentum> momentum(double t, In q, In v) override;
  double power(double t, In q, In v) override;
  int count() const override { return static_cast<int>(means_.size()); }
  void positions(double t, In q, Out x) override;
  void velocities(double t, In q, In v, Out u) override;
  std::optional<double> stretch(double t, In q) override;
  std::optional<Mean> mean(int point) override;

  std::size_t strands() const { return strands_.size(); }
  /// The entries of strand k.
  template <class Span>
  Span part(Span all, std::size_t k) const {
    const auto from = static_cast<std::size_t>(first_[k]);
    return all.subspan(from, static_cast<std::size_t>(first_[k + 1]) - from);
  }
  void check_and_join(System& strand, std::size_t k);
  void place(double t, In q, In v) noexcept;
  void build_matrix();
  void add_contacts(Weights w) noexcept;

  std::vector<std::unique_ptr<System>> strands_;
  std::vector<int> first_{0};        // coordinates before each strand; all
  std::vector<int> first_point_{0};  // material points before each strand; all
  std::vector<Mean> means_;          // all points, over all coordinates
  std::unique_ptr<StrandContacts> contacts_;
  std::vector<double> x_, u_;  // all points

  Pattern coupling_;  // pattern of the contacts' part of the tangent
  std::vector<double> coupling_values_;
  std::vector<std::vector<double>> strand_values_;
  std::unique_ptr<BlockMatrix> matrix_;  // a block per strand, then the coupling
  std::unique_ptr<LinearSolver> solver_;
  Status factored_ = Status::retry;
  bool uncoupled_ = false;  // each strand's own mass is factored
};

}  // namespace tress::models
