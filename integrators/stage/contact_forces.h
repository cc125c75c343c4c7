#pragma once

#include <vector>

#include "contract/forms/contact_form.h"
#include "integrators/stage/stage_equations.h"

namespace tress::integrators {

/// Solves for the state and the forces of rigid contacts at once. Each iteration solves
/// the equations and the laws of contact, both linear about the last state [Josephy
/// 1979], with the damping of Damped. For systems with a Complementarity. Used with exact
/// contact where Newton's method fails with the current multipliers, from its guess and
/// from zero acceleration.
///
/// Cost: each correction needs a matrix, a residual, and a solve for each of the three
/// components of every contact. Two more residuals and solves are added, and again for
/// each halving. Contacts with more than two components per unknown are left to other
/// methods.
class ContactForces {
 public:
  /// Works on `equations` and `contacts`, which must outlive it; `tolerance` in m/s.
  ContactForces(StageEquations& equations, ContactForm& contacts, double tolerance)
      : equations_(equations),
        contacts_(contacts),
        tolerance_(tolerance),
        start_(equations.dynamics),
        step_(start_),
        next_(start_),
        response_(start_),
        free_(start_),
        q_next_(start_.a.size()),
        v_next_(start_.a.size()) {}

  /// x: guess in, solution out. `touched`: something may have been in contact.
  Status solve(Unknowns& x, bool& touched) noexcept;

 private:
  Status iterate(Complementarity& law, Unknowns& x, bool& touched) noexcept;
  Status find_compliance(Complementarity& law, const Unknowns& x,
                         std::size_t count) noexcept;
  Status balance(Complementarity& law, const Unknowns& x, Unknowns& step, double& size,
                 double& violation) noexcept;
  Status halve_until_smaller(Complementarity& law, double size, Unknowns& x) noexcept;
  void go(Complementarity& law, double part, Unknowns& x) noexcept;

  StageEquations& equations_;
  ContactForm& contacts_;
  double tolerance_;              // m/s
  Unknowns start_, step_, next_;  // of a correction, and the one after it
  Unknowns response_, free_;      // to a force, without one
  std::vector<double> q_next_, v_next_;
  // Forces of contacts and velocities that they cause, and the matrix between both.
  std::vector<double> force_, force_start_, force_step_, velocity_, change_, compliance_;
};

}  // namespace tress::integrators
