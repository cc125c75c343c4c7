#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "contract/parameters.h"
#include "models/contact/contact_law.h"
#include "models/contact/guide_mesh.h"
#include "models/contact/point_grid.h"
#include "models/effects/effect.h"

namespace tress::models {

/// The table [effects.control_mesh] of a scene.
std::span<const Parameter> control_mesh_parameters();

/// Guide hairs tied into a mesh that represents the dense hair between them [Chang, Jin &
/// Yu 2002]. The mesh connects the strands' material points:
///
/// Static links, breakable springs between the points of neighbouring guides (GuideMesh),
/// d from one to the other and u its rate:
///
///     F = -(k (r - r0) + c d.u/r) d/r,   r^2 = |d|^2 + soft^2
///
/// k and c are per length, times the length that a link stands for. A link that is longer
/// than at rest by more than the threshold at the end of a step is gone until restart.
///
/// Strips of triangles between neighbouring guides. The nearest triangle of a strip
/// pushes and drags a point of a third guide, as a strand does (ContactLaw). With d the
/// vector from the nearest place on the triangle and u the velocity relative to that
/// place,
///
///     F = w (1 - |t.t'|) l ContactLaw(d, u)
///
/// with l the length that the point carries. t and t' are the directions of the hair
/// there and in the strip, along which they merge. The strip's density is w = min(1,
/// e0/e) with e its width. It fades to 0 as e goes from half the largest width to the
/// largest width. The corners take the reaction by the place's weights. Contacts, their
/// places and the factor of ContactLaw are computed at every update(), once for all
/// strands.
///
/// The paper gives springs in the frame of the nearest segments and friction mu F_N; we
/// use lengths, which conserve angular momentum, and the drag of ContactLaw. The formulas
/// of density, the default values and the choice of neighbours are ours.
///
/// Each strand sees the others where they were at the last update (lagged): exchanged
/// momentum sums to zero up to the first order in the step. None of the load is in
/// potential(), as for StrandInteraction.
///
/// A model's points need not be the material ones. Places of material points are
/// interpolated between the model's points by the lengths that these carry. That is exact
/// for nodes, and within curvature times 1/300 of a segment's square for four Gauss
/// points; the tip is at the last point. Derivatives are lumped at the points that hold a
/// place (row sums). They are exact where one point holds it, otherwise those of a motion
/// that the strand's points share, no softer.
///
/// update() is O(points + triangles), a load O(points of the strand + links and contacts
/// on it).
class ControlMesh {
 public:
  /// segments[k]: lengths of the segments of strand k, root to tip, m. Throws InputError
  /// if a strand has fewer than two, or the table's law is invalid.
  ControlMesh(const Parameters& parameters, std::vector<std::vector<double>> segments);

  /// Before the first update(): makes the mesh of strands that are at rest at x, 3
  /// numbers a point, strand after strand.
  void tie(In x);
  /// At the start and after every step, with the velocities v: breaks links and finds
  /// contacts.
  void update(In x, In v);

  /// Refers to *this, which must outlive it and not move. No load before update(). One
  /// thread at a time per effect; other threads may use others.
  std::unique_ptr<const Effect> effect(std::size_t strand) const;

  /// Returns the links and triangles of the mesh.
  const GuideMesh& mesh() const { return mesh_; }
  /// Returns the number of broken links.
  std::size_t broken() const { return broken_count_; }
  /// Returns the number of contacts with triangles.
  std::size_t contacts() const { return bonds_.size() - mesh_.links.size(); }
  /// Returns the energy of the links that hold, at the last update, J.
  double energy() const;

  /// Numbers of broken links; recall() restores it, and everything else follows from the
  /// next update().
  std::vector<double> memory() const;
  /// Restores the broken links; their numbers are from memory().
  void recall(In memory);

 private:
  class OnStrand;

  /// A force F(d, u) on d = sum share x of up to four points, share F on each.
  struct Bond {
    std::array<int, 4> point;
    std::array<double, 4> share;
    int ends;
    double apart;   // of a link at rest, m
    double factor;  // length that it stands for, of a contact with its density, m
  };
  struct Slopes {
    std::array<double, 9> by_gap, by_rate;
  };
  /// A point near a triangle of a strip.
  struct Near {
    int point, triangle;
    double square;  // of the distance
    std::array<double, 3> weight;
  };

  bool is_link(std::size_t bond) const { return bond < mesh_.links.size(); }
  Vec force(std::size_t bond, const Vec& d, const Vec& u) const;
  Slopes slopes(std::size_t bond, const Vec& d, const Vec& u) const;
  double longer(const GuideMesh::Link& link) const;
  void find_contacts();
  void look(std::size_t triangle, double density, const Box& box,
            std::vector<Near>& near) const;
  void add_contact(const Near& near, double density);
  double density(const GuideMesh::Triangle& triangle) const;
  Vec direction(int point) const;
  void list(std::size_t bond, std::vector<std::vector<int>>& of_strands) const;

  double width_, stiffness_, damping_, break_;
  ContactLaw law_;
  bool strips_act_;
  std::vector<std::vector<double>> segments_;
  GuideMesh mesh_;
  std::vector<double> x_, v_;  // of the last update
  std::vector<Bond> bonds_;    // links, then contacts
  std::vector<char> broken_;   // of links
  std::size_t broken_count_ = 0;
  std::vector<std::vector<int>> links_of_, contacts_of_;  // of each strand
  PointGrid grid_;
};

}  // namespace tress::models
