#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "math/mat3.h"

namespace tress::models {

/// Contacts between points of bodies whose velocities respond linearly to forces: u = W r
/// + b with the laws of contact_force() at every contact. W has one dense block per body,
/// its compliance. Solved by block Gauss-Seidel over contacts, each exactly [Jourdan,
/// Alart & Jean 1998; Daviet, Bertails-Descoubes & Boissieux 2011]. With more contacts
/// than unknowns W is singular and the sweeps slow down or stall; each local problem
/// therefore keeps near its last force by `proximal` times its own compliance [Acary &
/// Brogliato 2008, section 13.4], which leaves the solution as it is.
///
/// A visit of a contact costs O(points of its bodies), about 0.2 us at 10 points each.
class ContactProblem {
 public:
  /// A point of a body, and its weight in the contact's velocity.
  struct End {
    int body = 0, point = 0;
    double weight = 0;
  };
  struct Contact {
    std::array<End, 4> ends;
    double friction;  // Coulomb's coefficient
    Mat3 axes;        // normal, two tangents
    Vec free;         // velocity without any force of this problem, in these axes, m/s
    Vec force;        // a guess, then the solution, in these axes, N
    Mat3 local;       // set by solve()
  };
  struct Outcome {
    int sweeps = 0;
    double violation = 0;  // the largest of all contacts, m/s
  };

  void clear();
  /// Returns its number. compliance: velocities (m/s) of its points per force (N) on each
  /// point, 3x3 blocks, point by point of the forces.
  int add_body(std::vector<Mat3> compliance, int points);
  void add(const Contact& contact) { contacts_.push_back(contact); }

  /// Contacts of points that nothing moves hold no forces. Until no other contact
  /// violates the laws by more than `tolerance` (m/s), or so many sweeps.
  Outcome solve(double proximal, double tolerance, int most_sweeps);

  std::span<const Contact> contacts() const { return contacts_; }
  /// With the forces, in the contact's axes, m/s.
  Vec velocity(const Contact& contact) const;
  std::size_t bodies() const { return bodies_.size(); }
  /// By how much the forces change the velocities of a body's points, m/s, and the forces
  /// on them, N.
  std::span<const Vec> change(std::size_t body) const { return bodies_[body].change; }
  std::span<const Vec> forces(std::size_t body) const { return bodies_[body].forces; }

 private:
  struct Body {
    std::vector<Mat3> compliance;
    std::vector<Vec> change, forces;  // of its points, m/s and N
  };

  void push(const Contact& contact, const Vec& force);
  double worst() const;

  std::vector<Body> bodies_;
  std::vector<Contact> contacts_;
};

}  // namespace tress::models
