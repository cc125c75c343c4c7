#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "math/mat3.h"
#include "math/pack.h"
#include "models/contact/box_pairs.h"

namespace tress::models {

/// Contacts between points of bodies whose velocities respond linearly to forces: u = W r
/// + b with the laws of contact_force() at every contact. W has one dense block per body,
/// its compliance. Solved by block Gauss-Seidel over contacts, each exactly [Jourdan,
/// Alart & Jean 1998; Daviet, Bertails-Descoubes & Boissieux 2011]. With more contacts
/// than unknowns W is singular and the sweeps slow down or stall; each local problem
/// therefore keeps near its last force by `proximal` times its own compliance [Acary &
/// Brogliato 2008, section 13.4], which leaves the solution as it is.
///
/// Many contacts are divided into up to four parts of neighbours, on any threads, and the
/// contacts between the parts, which are visited after those within them: by the contacts
/// alone, so that the result does not depend on the threads.
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
    std::array<End, 4> ends;  // two on one body, and two on another or the same one
    double friction;          // Coulomb's coefficient
    Mat3 axes;                // normal, two tangents
    Vec free;    // velocity without any force of this problem, in these axes, m/s
    Vec force;   // a guess, then the solution, in these axes, N
    Mat3 local;  // set by solve()
  };
  struct Outcome {
    int sweeps = 0;
    double violation = 0;  // the largest of all contacts, m/s
  };

  void clear();
  /// Returns its number. compliance: velocities (m/s) of its points per force (N) on each
  /// point, 3x3 blocks, point by point of the forces.
  int add_body(std::span<const Mat3> compliance, int points);
  void add(const Contact& contact) { contacts_.push_back(contact); }

  /// Contacts of points that nothing moves hold no forces. Until no other contact
  /// violates the laws by more than `tolerance` (m/s), or so many sweeps.
  Outcome solve(double proximal, double tolerance, int most_sweeps,
                const Loop& loop = one_by_one);

  std::span<const Contact> contacts() const { return contacts_; }
  /// With the forces, in the contact's axes, m/s.
  Vec velocity(const Contact& contact) const;
  std::size_t bodies() const { return bodies_.size(); }
  /// By how much the forces change the velocities of a body's points, m/s, and the forces
  /// on them, N.
  Vec change(std::size_t body, std::size_t point) const;
  std::span<const Vec> forces(std::size_t body) const { return bodies_[body].forces; }

 private:
  struct Body {
    // The fourth lane is not used.
    std::vector<Pack> compliance;  // by point and component of the force: all points
    std::vector<Pack> change;      // of its points, m/s
    std::vector<Vec> forces;       // N
  };
  /// Contacts that share no body with those of other parts, but for the last one.
  struct Part {
    std::vector<Contact*> contacts, busy;
    double violation = 0;  // at the visits of the last sweep
  };
  struct Limits {
    double proximal, quiet;
  };

  static void one_by_one(std::size_t count,
                         const std::function<void(std::size_t)>& work) {
    for (std::size_t i = 0; i < count; ++i) work(i);
  }
  void divide();
  void each_part(const Loop& loop, const std::function<void(Part&)>& act);
  void begin(Contact& contact);
  void push(const Contact& contact, const Vec& force);
  double violation(const Contact& contact) const;
  double visit(Contact& contact, const Limits& limits);
  void sweep(Part& part, const Limits& limits);
  double worst(const Loop& loop);

  std::vector<Body> bodies_;
  std::vector<Contact> contacts_;
  std::vector<Part> parts_;
};

}  // namespace tress::models
