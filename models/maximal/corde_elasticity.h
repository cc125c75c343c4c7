#pragma once

#include "models/maximal/corde_energy.h"
#include "models/maximal/elasticity.h"

namespace tress {

/// Internal forces of corde.h, coordinates z = (x_0, ..., x_n, q_0, ..., q_{n-1}).
class CordeElasticity final : public Elasticity {
 public:
  /// `joints`: between neighbouring edges; with `walled` the one at the clamp first.
  CordeElasticity(std::vector<CordeEdge> edges, std::vector<RodJoint> joints,
                  bool walled);

  std::vector<std::vector<int>> groups() const override;
  void add_force(const Placement& p, InOut f) noexcept override;
  void add_tangent(const Placement& p, double pos, double vel,
                   GroupSum& s) noexcept override;
  double energy(const Placement& p) noexcept override;
  double power(const Placement& p) noexcept override;
  Vec spin(const Placement& p, In inertia) noexcept override;

 private:
  struct Edge;
  struct Joint;

  bool clamp(std::size_t joint) const { return walled_ && joint == 0; }
  /// Place in z of the quaternion of an edge.
  std::size_t at(std::size_t edge) const { return quaternions_ + 4 * edge; }
  /// Edge behind a joint; the one before is its neighbour, or the clamp.
  std::size_t behind(std::size_t joint) const { return walled_ ? joint : joint + 1; }

  Edge edge(const Placement& p, std::size_t i) const noexcept;
  Joint joint(const Placement& p, std::size_t j) const noexcept;
  void edge_tangent(const Edge& edge, double pos, double vel,
                    double (&h)[7][7]) const noexcept;
  void joint_tangent(const Joint& joint, double pos, double vel,
                     double (&h)[8][8]) const noexcept;

  std::vector<CordeEdge> edge_data_;
  std::vector<RodJoint> joint_data_;
  bool walled_;
  std::size_t quaternions_;  // first one in z
};

}  // namespace tress
