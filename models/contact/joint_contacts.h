#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "math/mat3.h"

namespace tress::models {

/// A few contacts that respond to each other, solved at once. Newton's method finds roots
/// of the functions of Alart and Curnier [Alart & Curnier 1991], which are forces that
/// obey the laws of contact_force(). With s = r - u/m, m = tr W_ii/3, a contact
///
///     is open where s_n <= 0:               r = 0
///     sticks where |s_t| <= mu s_n:         u = 0
///     slides along d = s_t/|s_t| otherwise: u_n = 0,  r_t = mu r_n d + (turning of d)
///
/// and each step solves these equations, linear except for the turning, for all contacts.
/// A proximal term of `proximal` m keeps r where W is singular. Converges in a few steps
/// from near a solution, otherwise possibly not at all: the caller judges by the
/// violation. A step costs O((3 contacts)^3).
class JointContacts {
 public:
  /// Contact with its unknown force.
  struct Contact {
    double friction;  // Coulomb's coefficient
    Vec free;         // velocity without these forces, m/s
    Vec force;        // a guess, then what solve() has found, N
  };

  /// Sets the number of contacts; all contacts and all blocks must be set before solve().
  void resize(std::size_t count);
  /// Returns the contacts.
  std::span<Contact> contacts() { return contacts_; }
  /// Velocity of contact i per force on contact j.
  Mat3& block(std::size_t i, std::size_t j) { return blocks_[i * contacts_.size() + j]; }

  /// Iterates until no contact violates the laws by more than `tolerance` (m/s), at most
  /// `most_steps` times. Returns the largest violation of the forces that contacts() then
  /// has: those of the best step, or the guess.
  double solve(double tolerance, int most_steps);

 private:
  /// Possible response of a contact: its force is sum_k a_k column_k. Its equations, one
  /// per unknown a_k, are row_k u + own_k a_k = known_k.
  struct Active {
    std::size_t contact, first;  // its first unknown
    int unknowns;
    Vec column[3], row[3];
    double own[3], known[3];
  };

  double violation();
  void linearize();
  bool step();

  std::vector<Contact> contacts_;
  std::vector<Mat3> blocks_;
  std::vector<Vec> velocity_, best_;
  std::vector<Active> active_;
};

}  // namespace tress::models
