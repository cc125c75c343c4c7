#pragma once

#include <vector>

#include "contract/forms/contact_form.h"
#include "integrators/gradient/watched_system.h"

namespace tress::integrators {

/// A point with a contact force.
struct ClosedContact {
  std::size_t id;   // of the point and the body: the same in every step
  double friction;  // coefficient of friction
  bool rebounds;    // its law is about the rebound speed
};

/// The closed contacts of a system with a Complementarity at the solution of a stage.
/// Between hold() and let_go() their forces are constant.
///
/// What a contact is follows from its law: the multiplier from its force, the friction
/// from the resistance to a fast slide, a rebound from the dependence on velocities.
class ClosedContacts {
 public:
  /// Velocities and forces in the axes of each contact, and its coefficient of friction.
  struct Values {
    std::vector<double> u, f, mu;  // m/s (3 contacts), N (3 contacts), (contacts)

    /// Makes all zero.
    void assign(std::size_t contacts);
    /// Adds `factor` times `other`.
    void add(double factor, const Values& other);
  };

  /// `system` must outlive it.
  explicit ClosedContacts(System& system);

  /// Holds the forces of a stage's solution, which must last until let_go().
  void hold(const WatchedSystem::Motion& end);
  /// Holds them for a step that begins elsewhere: arguments of ContactForm::begin().
  void hold(const WatchedSystem::Motion& end, In q0, In v0, In x0);
  /// The system computes forces again.
  void let_go();

  // Of the closed contacts, in order.
  /// Returns their number.
  std::size_t count() const { return closed_.size(); }
  /// Returns what is known of contact k.
  const ClosedContact& operator[](std::size_t k) const { return closed_[k]; }
  /// Returns whether another system has the same closed contacts with the same laws.
  bool same(const ClosedContacts& other) const;
  /// Computes the values at a state.
  void values(double t, In q, In v, Values& found);

  /// Removes all forces.
  void remove_forces();
  /// Leaves one component of one force, of 1 N.
  void leave_unit(std::size_t contact, std::size_t component);
  /// Restores the forces of hold().
  void restore_forces();

 private:
  void find_frictions();
  void find_multipliers();
  void find_rebounds(const WatchedSystem::Motion& end);

  ContactForm& form_;
  std::vector<double> v_typ_;
  Complementarity& law_;
  bool held_ = false;
  std::vector<std::size_t> index_;  // of the closed contacts among those taken
  std::vector<ClosedContact> closed_;
  std::vector<double> forces_;       // of those taken, at hold()
  std::vector<double> given_, all_;  // of those taken
  std::vector<double> v_;
  Values plus_, minus_;
};

}  // namespace tress::integrators
