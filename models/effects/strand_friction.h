#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "contract/parameters.h"
#include "models/contact/contact_problem.h"
#include "models/contact/pieces/piece_search.h"
#include "models/effects/obstacle.h"

namespace tress::models {

/// The table [effects.strand_friction] of a scene.
std::span<const Parameter> strand_friction_parameters();

/// Exact contact with friction (Signorini and Coulomb) between strands, between parts of
/// one strand and with rigid bodies. Forces act as impulses at the ends of steps [Moreau
/// 1999; Jean 1999]. Strands have first moved without contact. The forces are such that
/// no pair of segments has passed through another or is nearer than their radii.
/// Positions and velocities after them are
///
///     x = x* + h W r,   u = u* + W r,   W = h J S^-1 J^T   (of each strand)
///
/// S is the matrix of the strand's own step, so forces act as if they had been among its
/// loads. Each pair of segments has its contact where its axes would cross, or at the
/// nearest points of their ends of steps (PieceTouch). If an end has since slipped around
/// the other segment, the contact is where they first touched. The forces on the four
/// points about a contact sum to zero. Places along strands touch obstacles as well, at
/// the planes that are tangent to these (Obstacle::Plane). Where forces drive other pairs
/// into each other at the new positions (place()), these pairs are added and all are
/// solved again. Deviations of points from straight lines within a step are left to the
/// next step.
///
/// Use: begin(), then while find(): respond() for stale() strands, solve(), and place()
/// for moved() ones. forces() are then to be applied to touching() ones. O(segments) for
/// the search, O(touching) for the rest.
class StrandFriction {
 public:
  /// Parameters of the contact.
  struct Law {
    double friction;   // Coulomb's coefficient
    double thickness;  // distance of axes that touch, m; 0: the sum of radii
    bool own;          // parts of one strand touch each other too
    double tolerance;  // largest violation, m/s
    int sweeps;        // at most
  };
  /// Constructs the contacts of strands without branches between their material points.
  StrandFriction(const Parameters& parameters,
                 std::span<const PieceSearch::Strand> strands,
                 std::vector<std::shared_ptr<const Obstacle>> obstacles);

  /// A step of h (s) that ends at time t, from points `from` to where they are without
  /// contact, with the velocities u there; 3 numbers each, strand after strand.
  void begin(double t, double h, In from, In to, In u);
  /// Looks for pairs that touch with the forces found so far. False: none beyond those.
  bool find(const Loop& loop);
  /// Strands whose compliance at points_of() is to be given before solve().
  std::span<const std::size_t> stale() const { return stale_; }
  /// Points of a strand, from its root, that contacts act on; ascending.
  const std::vector<int>& points_of(std::size_t strand) const {
    return strands_[strand].touched;
  }
  /// Velocities (m/s) of those points per force (N) on each, row-major 3x3 blocks: those
  /// of the force on the first point, of the second ...
  void respond(std::size_t strand, In compliance);
  /// Finds the forces of all contacts.
  void solve(const Loop& loop);
  /// Strands on which solve() has found other forces than before, ascending.
  std::span<const std::size_t> moved() const { return moved_; }
  /// Sets the positions of all points of a strand with the forces found, 3 numbers each.
  void place(std::size_t strand, In x);

  /// Returns the strands with contacts in the step, or in the recalled state, ascending.
  /// forces() returns the forces (N) on points_of() in the step.
  std::span<const std::size_t> touching() const { return touching_; }
  /// Returns the forces on points_of() of a strand, N.
  In forces(std::size_t strand) const { return strands_[strand].forces; }
  /// f += the forces on all points of a strand, 3 numbers each, N.
  void add_loads(std::size_t strand, InOut f) const;

  /// Returns the part of the available friction that the contacts of each point use, for
  /// all strands: 0 without any, below 1 where it sticks, 1 where it slides.
  std::vector<double> friction_used() const;

  /// Returns the outcome of the step: sweeps, and the final violation of the laws, m/s.
  const ContactProblem::Outcome& outcome() const { return outcome_; }
  /// Returns the largest violation that is allowed, m/s.
  double tolerance() const { return law_.tolerance; }
  /// Place where strands touched in the step, and the force on the first one (N).
  struct Touch {
    std::size_t first_strand, second_strand;  // the strands that touch
    double first, second;                     // arc length at the start of the step, m
    Vec force;                                // force on the first strand
  };
  /// Returns all places where strands touched in the step.
  std::vector<Touch> touches() const;

  /// The largest T.u/(mu N) of the step's contacts, m/s: friction does work on a slide
  /// where it is positive. Of contacts that the tolerance does not let open. It is below
  /// five times the tolerance in every step.
  double drive() const;

  /// Pairs of segments that touched in the step.
  std::size_t contacts() const { return known_.all.size(); }

  /// Returns the largest overlap of touching strands at the ends of steps so far, m. It
  /// exceeds the thickness if they have passed through each other.
  double deepest() const { return deepest_; }

  /// deepest() and the forces of the last step, from which the next one starts: pairs and
  /// vectors. Empty: those of a new run.
  std::vector<double> memory() const;
  /// Restores what memory() returned.
  void recall(In memory);

 private:
  /// A pair of pieces, or a place on a piece (at.s) and an obstacle, of which `second`
  /// then is the code().
  struct Known : PieceSearch::Found {
    Vec force;              // in the contact's axes, N
    Vec world;              // the same there
    Obstacle::Plane plane;  // of an obstacle
    int contact = -1;       // of the problem; -1: none yet

    void start_from(const Vec& last, const Vec& normal);
  };
  /// Largest number of parts of a piece that are tested, at the end of each.
  static constexpr int most_parts = 15;
  static int code(std::size_t obstacle, int part) {
    return -1 - (most_parts + 1) * static_cast<int>(obstacle) - part;
  }
  static std::size_t code_obstacle(int code) {
    return static_cast<std::size_t>((-1 - code) / (most_parts + 1));
  }
  struct OnPoints {
    std::array<std::size_t, 4> point;
    std::array<double, 4> weight;
    std::size_t count;
  };
  struct Touched {
    std::vector<int> touched;  // its points
    std::vector<int> place;    // of each of its points among them, -1: none
    ContactProblem::Compliance compliance;
    std::vector<double> forces;  // on them, N
    int body = -1;               // of the problem
    bool stale = false;          // it is touched at points that its body does not know
    bool moved = false;          // by other forces than before
  };

  std::size_t strand_of(int piece) const { return search_.strand_of(piece); }
  bool one_place(const Known& a, const Known& b) const;
  /// Contacts ordered by pair, and where those of each piece as the first one begin.
  struct Ordered {
    std::vector<Known> all;
    std::vector<std::size_t> first;

    void list(std::size_t pieces);
    std::span<const Known> of(int piece) const;
    const Known* of(int piece, int second) const;
  };
  const Known* seen(const Known& found, std::span<const Known> some) const;
  bool is_known(const Known& found) const;
  void admit(const PieceSearch::Found& found);
  void look(const Obstacle::Step& step, std::size_t obstacle, std::size_t strand,
            std::vector<Known>& found) const;
  void find_on_obstacles(const Loop& loop);
  OnPoints on_points(const Known& known) const;
  void touch_points();
  void set_contacts(const Loop& loop);
  void measure_depth();
  ContactProblem::Contact contact(const Known& known) const;
  void take_forces(Touched& strand);

  Law law_;
  PieceSearch search_;
  std::vector<Touched> strands_;
  double t_ = 0, h_ = 0;
  int rounds_ = 0;
  std::vector<double> u_;
  Ordered known_;             // of this step
  Ordered before_;            // of the last one
  std::vector<Known> found_;  // by this search
  std::size_t recent_ = 0;    // of found_: the first that may share a joint with the next
  std::vector<std::shared_ptr<const Obstacle>> obstacles_;
  std::vector<int> parts_;                        // of a piece, by obstacle
  std::vector<std::vector<Known>> on_obstacles_;  // of each strand, found last
  std::vector<std::size_t> stale_, touching_, moved_;
  ContactProblem problem_;
  ContactProblem::Outcome outcome_;
  double deepest_ = 0;
};

}  // namespace tress::models
