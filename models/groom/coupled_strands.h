#pragma once

#include <memory>
#include <vector>

#include "contract/forms/contact_form.h"
#include "contract/forms/energetics.h"
#include "contract/forms/history.h"
#include "contract/forms/moving_history.h"
#include "contract/forms/stress_form.h"
#include "contract/parameters.h"
#include "contract/system.h"
#include "models/coupling/coupled_solver.h"
#include "models/groom/strand_block.h"
#include "models/groom/strand_contacts.h"

namespace tress::models {

/// All strands of a scene as one System, coupling = monolithic:
///
///     r = (r_1, ..., r_S) - P^T f,    x = P q + prescribed(t)
///
/// with f the contact forces on the material points x (StrandContacts). The forces act in
/// both directions at the current state and are exactly opposite, so linear momentum is
/// conserved. Drag acts across the gap, not along it, so angular momentum is not
/// conserved. The tangent has the strands' tangents on its diagonal and those of the
/// contacts between strands, and is factored sparse by KLU. The mass alone (w.vel = w.pos
/// = 0) couples no strands, and each strand solves with its own. The pattern follows the
/// pairs of segments that may touch. accept() returns true if they have changed, since
/// the factors are then invalid. There is no SparseForm, whose pattern would be fixed.
/// Contacts of points that move more than an eighth of the law's reach within one step
/// may be missed in that step. Before a start from a state other than the initial one,
/// accept() it.
class CoupledStrands final : public StrandBlock,
                             private MovingHistory,
                             private ContactForm,
                             private StressForm {
 public:
  /// Throws InputError, naming the strand, unless each has a sparse tangent, no
  /// constraints (their multipliers need a fixed pattern) and material points that are
  /// fixed means of coordinates (MaterialPoints::mean).
  CoupledStrands(std::vector<std::unique_ptr<System>> strands, const ContactLaw& law);
  /// Constructs the system from the values of strand_interaction_parameters().
  CoupledStrands(std::vector<std::unique_ptr<System>> strands,
                 const Parameters& parameters);

  Status residual(double t, In q, In v, In a, Out r) noexcept override;
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override;
  Status solve(In b, Out x) noexcept override;
  History* history() override { return this; }
  ContactForm* contact_form() override { return held_contacts_.empty() ? nullptr : this; }
  StressForm* stress_form() override { return stressed_.empty() ? nullptr : this; }

  /// Returns the contacts between strands.
  const StrandContacts& contacts() const { return *contacts_; }
  /// The part of energy() that belongs to the contacts, J.
  double contact_potential(double t, In q, In v);

 private:
  bool accept(double t, InOut q, InOut v) override;
  bool carry(double t, InOut q, InOut v, InOut a) const override {
    return carry_strands(t, q, v, a);
  }
  std::string not_smooth() const override { return strands_not_smooth(); }
  void reset() override;
  std::vector<double> memory() const override;
  void recall(In memory) override;
  std::size_t tracked() const override;
  void places(double t, In q, In v, Out x) noexcept override;
  void slides(double t, In q, In v, Out u) noexcept override;
  void begin(double t, double tau, In q0, In v0, In x0) noexcept override;
  double improve(double t, In q, In v) noexcept override;
  double drive() const noexcept override;
  void extrapolate() noexcept override;
  double approach(double t, In q, In v) noexcept override;
  void release() noexcept override;
  bool rebounds() const override;
  std::vector<double> multipliers() const override;
  void set_multipliers(In values) override;
  void take_stresses(double t, In q, Stresses stresses) noexcept override;
  Energy energy(double t, In q, In v) override;
  double power(double t, In q, In v) override;
  std::optional<Mean> mean(int point) override;

  /// Calls act(k, its contacts, their part of `all`) of every strand with contacts.
  template <class Values, class Act>
  void each_tracked(Values all, Act act) {
    for (const std::size_t k : held_contacts_) {
      ContactForm& own = *strand(k).contact_form();
      act(k, own, all.first(own.tracked()));
      all = all.subspan(own.tracked());
    }
  }
  void check_and_join(std::size_t k);
  void place(double t, In q, In v) noexcept;
  void place_at_start();
  void couple();

  std::vector<Mean> means_;                 // all points, over all coordinates
  std::vector<std::size_t> held_contacts_;  // strands with a ContactForm
  std::vector<std::size_t> stressed_;       // strands with a StressForm
  std::unique_ptr<StrandContacts> contacts_;
  std::vector<double> x_, u_;                       // all points
  std::vector<std::vector<double>> strand_values_;  // tangents
  std::unique_ptr<CoupledSolver> solver_;
  Status factored_ = Status::retry;
  bool uncoupled_ = false;  // each strand's own mass is factored
};

}  // namespace tress::models
