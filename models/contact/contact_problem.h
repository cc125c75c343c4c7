#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "contract/basics.h"
#include "math/mat3.h"
#include "math/pack.h"
#include "models/contact/box_pairs.h"
#include "models/contact/joint_contacts.h"

namespace tress::models {

/// Axes of a contact: its normal (of length 1), two tangents.
Mat3 axes_about(const Vec& normal);

/// Contacts between points of bodies whose velocities respond linearly to forces: u = W r
/// + b, with the laws of contact_force() at every contact. W has one dense block per
/// body, its compliance. Solved by block Gauss-Seidel over contacts, each exactly
/// [Jourdan, Alart & Jean 1998; Daviet, Bertails-Descoubes & Boissieux 2011]. With more
/// contacts than unknowns W is singular and the sweeps slow down or stall. Each local
/// problem therefore keeps near its last force by `proximal` times its own compliance
/// [Acary & Brogliato 2008, section 13.4]. The solution does not depend on this term.
///
/// Every few sweeps the contacts of the two bodies that violate the laws most are solved
/// at once (JointContacts). A few contacts that support each other would need hundreds of
/// sweeps to settle.
///
/// Many contacts are divided into up to four parts of neighbours, on any threads. Those
/// between two parts are visited after those within parts, two pairs of parts at a time.
/// The division depends on the contacts only, so the result does not depend on the
/// threads.
///
/// A visit of a contact costs O(points of its bodies), about 0.1 us at 10 points each. A
/// contact that has settled is not visited until the velocities of its bodies change, and
/// not solved again until its own velocity changes. The violation at the end is that of
/// all contacts.
///
/// Contacts may be added to a solved problem, and bodies may be touched at other points.
/// The next solution starts from the last one; its cost is that of new contacts and of
/// those that they disturb.
class ContactProblem {
 public:
  /// A point of a body, and its weight in the contact's velocity.
  struct End {
    int body = 0, point = 0;  // body, and point of it
    double weight = 0;        // weight of the point's velocity
  };
  /// Contact between points of bodies.
  struct Contact {
    std::array<End, 4> ends;  // two on one body, and two on another or the same one
    double friction;          // Coulomb's coefficient
    Mat3 axes;                // normal, two tangents
    Vec free;    // velocity without any force of this problem, in these axes, m/s
    Vec force;   // a guess, then the solution, in these axes, N
    Mat3 local;  // set by solve()
  };
  /// Compliance of a body: velocities (m/s) of its points per force (N) on each point.
  class Compliance {
   public:
    Compliance() = default;
    /// Row-major 3x3 blocks, point by point of the forces.
    explicit Compliance(In blocks) { set(blocks); }
    /// Sets the blocks.
    void set(In blocks);

   private:
    friend class ContactProblem;
    std::size_t points_ = 0;
    // By point and component of the force: all points. The fourth lane is not used.
    std::vector<Pack> columns_;
  };
  /// Result of solve().
  struct Outcome {
    int sweeps = 0;        // sweeps over all contacts
    double violation = 0;  // the largest of all contacts, m/s
  };

  /// Removes all bodies and contacts.
  void clear();
  /// Returns its number. The compliance must outlive the use of the problem.
  int add_body(const Compliance& compliance);
  /// Renews a body whose compliance is now that of other points: its contacts must be
  /// set() again.
  void renew_body(int body);
  /// Adds a contact.
  void add(const Contact& contact);
  /// Adds `count` contacts, to be set before solve().
  void add(std::size_t count);
  /// Safe for different contacts at once. The force of one that was solved stays.
  void set(std::size_t number, const Contact& contact);

  /// Solves until no contact violates the laws by more than `tolerance` (m/s), or for
  /// `most_sweeps` sweeps. Contacts of points that nothing moves hold no forces and do
  /// not count.
  Outcome solve(double proximal, double tolerance, int most_sweeps,
                const Loop& loop = one_by_one);
  /// Ends a solution that was not found: reduces friction that does work on a slide until
  /// no T.u exceeds `tolerance` mu N. A few times round by as much as stops a contact's
  /// own work, then by all of it, so that it ends. Returns the violation, m/s.
  double stop_driving(double tolerance, const Loop& loop = one_by_one);

  /// Returns the contacts with their forces.
  std::span<const Contact> contacts() const { return contacts_; }
  /// With the forces, in the contact's axes, m/s.
  Vec velocity(const Contact& contact) const;
  /// Returns the number of bodies.
  std::size_t bodies() const { return used_; }
  /// Returns the change of the velocity of a body's point by the forces, m/s; forces()
  /// returns the forces on its points, N.
  Vec change(std::size_t body, std::size_t point) const;
  /// Returns the forces on a body's points, N.
  std::span<const Vec> forces(std::size_t body) const { return bodies_[body].forces; }

 private:
  struct Body {
    const Compliance* compliance = nullptr;
    std::vector<Pack> change;  // of its points, m/s
    std::vector<Vec> forces;   // N
    long pushes = 0;           // so often its velocities have changed
    bool renewed = true;       // its change holds no forces yet

    void respond_as(const Compliance& given);
  };
  /// State of a contact in solve().
  struct Solved {
    /// Changes of one body by a contact.
    struct Pushed {
      Body* body = nullptr;           // body that the contact pushes
      std::size_t first = 0;          // of columns, in columns_
      const Pack* columns = nullptr;  // changes of all points by unit forces along axes
      long pushes = -1;               // of the body when the contact had settled
    };
    std::array<Pushed, 2> bodies;  // the second is null if both are one
    Contact* contact = nullptr;
    std::array<const Pack*, 4> change{};  // of the velocities of its ends
    bool given = true;                    // since the last solution
    bool solved = false;                  // its force is in the changes of its bodies
    bool judged = false;                  // what it violates was computed when it settled
    Mat3 near{};                          // its compliance with the proximal term
    Vec seen;         // its velocity at the last visit, with the force found then, m/s
    double left = 0;  // by how much another solution would have changed that, m/s
    double violation = 0;  // when it was judged, m/s

    void wake();
  };
  /// Contacts that share no body with those of parts that are visited at once.
  struct Part {
    std::vector<Solved*> contacts;
    std::vector<Solved*> busy;
    double violation = 0;           // at the visits of the last sweep
    std::size_t visits = 0;         // of it, to contacts that had not settled
    const Solved* worst = nullptr;  // violates the laws most
  };

  /// Violation of the laws by contacts that are solved at once, m/s.
  struct Joint {
    double violation = std::numeric_limits<double>::infinity();
    bool all = false;  // there are no others
  };

  static void one_by_one(std::size_t count,
                         const std::function<void(std::size_t)>& work) {
    for (std::size_t i = 0; i < count; ++i) work(i);
  }
  static bool settled(const Solved& solved);
  static void settle(Solved& solved);
  static Vec velocity(const Solved& solved);
  void link();
  void divide();
  void each_part(const Loop& loop, const std::function<void(Part&)>& act);
  void combine(Solved& solved, double proximal);
  static void push_guess(Solved& solved);
  static void push(const Solved::Pushed& on, const Vec& force);
  static void push(const Solved& solved, const Vec& force);
  Vec change(const Contact& contact) const;
  double visit(Solved& solved, double quiet);
  void sweep(Part& part, double quiet);
  Mat3 response(const Contact& contact, const Solved& to) const;
  std::vector<const Solved*> about_the_worst() const;
  Joint solve_jointly(const Loop& loop, double tolerance);
  double largest_seen() const;
  double worst(const Loop& loop, double tolerance);
  void sum_forces();

  std::vector<Body> bodies_;  // the first used_ are in use
  std::size_t used_ = 0;
  std::vector<Contact> contacts_;
  std::vector<Solved> solved_;  // of each contact
  std::vector<Pack> columns_;   // of all; the first columns_used_ are in use
  std::size_t columns_used_ = 0;
  JointContacts joint_;
  // Those within parts, then those between two parts: pairs that share none in turn.
  std::vector<Part> parts_;
  std::vector<std::size_t> rounds_;  // parts that are visited at once, in turn
};

}  // namespace tress::models
