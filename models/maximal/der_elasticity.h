#pragma once

#include "math/pack.h"
#include "models/maximal/edge_reference.h"
#include "models/maximal/elasticity.h"
#include "models/maximal/joint_strain.h"
#include "models/maximal/rod_edge.h"
#include "models/maximal/rod_joint.h"

namespace tress::models {

/// Stretching, bending and twisting of a discrete rod (der.cpp), coordinates z = (x_0,
/// ..., x_n, theta_0, ..., theta_{n-1}).
class DerElasticity final : public Elasticity, private NaturalStrains {
 public:
  struct EdgeData {
    Frame reference;
    double length;   // at rest, m
    double stretch;  // EA/l, N/m; 0: held by constraints
  };
  /// `joints`: between neighbouring edges; if `walled`, the clamp's joint comes first.
  DerElasticity(std::vector<EdgeData> edges, std::vector<RodJoint> joints, bool walled,
                Tangent tangent);

  std::vector<std::vector<int>> groups() const override;
  void add_force(const Placement& p, InOut f) noexcept override;
  void add_tangent(const Placement& p, double pos, double vel,
                   GroupSum& s) noexcept override;
  double energy(const Placement& p) noexcept override;
  double power(const Placement& p) noexcept override;
  Vec spin(const Placement& p, In inertia) noexcept override;
  std::optional<Frame> end_frame(const Placement& p) noexcept override;
  bool rebase(const RootPose& root, InOut z, InOut rate) override;
  void carry(InOut z, InOut rate, InOut second) const override;
  void reset() override;
  std::vector<double> memory() const override;
  void recall(In memory) override;
  NaturalStrains* natural_strains() override { return this; }
  bool takes_stresses() const override { return tangent_ == Tangent::exact && stiff_; }

 private:
  std::vector<double> natural() const override {
    return of_joints(joint_data_, &RodJoint::rest);
  }
  void set_natural(In values) override {
    for (std::size_t j = 0; j < joint_data_.size(); ++j) {
      joint_data_[j].rest = load3(&values[3 * j]);
    }
    placed_ = false;
  }
  std::vector<double> natural_stiffness() const override {
    return of_joints(joint_data_, &RodJoint::stiffness);
  }

  struct Edge {
    EdgeTurn turn;
    Frame frame;
    Vec spin;    // world components, rad/s
    Vec moment;  // exerted by the joints on the edge
  };
  struct Joint {
    JointStrain strain;
    Vec rate;    // rate of the strains
    Vec stress;  // elastic and friction
  };
  /// Matrix over (e, theta) of the edges before and behind a joint; one pack per row for
  /// each edge.
  using Matrix = Pack[8][2];

  bool clamp(std::size_t joint) const { return walled_ && joint == 0; }
  /// Edge before a joint; undefined for the clamp's joint.
  std::size_t before(std::size_t joint) const { return walled_ ? joint - 1 : joint; }
  std::size_t after(std::size_t joint) const { return walled_ ? joint : joint + 1; }
  double theta(In z, std::size_t edge) const { return z[angles_ + edge]; }

  /// Computes edges_ and joints_ unless they belong to this placement already: a step
  /// needs forces and tangent of the same one.
  void place(const Placement& p) noexcept;
  bool placed_at(const Placement& p) noexcept;  // and remembers p
  void forget_turns();
  const Frame& frame_before(const Placement& p, std::size_t joint) const {
    return clamp(joint) ? p.root.frame : edges_[before(joint)].frame;
  }
  void joint_tangent(const Placement& p, std::size_t joint, double pos, double vel,
                     Matrix& s) const noexcept;
  void add_slope_of_friction(const Placement& p, std::size_t joint, double pos,
                             Matrix& s) const noexcept;
  /// Tension (N) in the tangent's terms of second order.
  double tension(const Placement& p, std::size_t edge) const noexcept;
  void add_edge_tangent(const Placement& p, std::size_t edge, double pos,
                        Pack (&h)[4]) const noexcept;

  std::vector<EdgeData> edges_at_start_, edge_data_;
  std::vector<Replaced> replaced_;
  std::vector<RodJoint> joint_data_;
  std::vector<double> twist_;  // per joint, after the last accepted step: see wound()
  bool walled_;
  Tangent tangent_;
  bool friction_, stiff_;  // whether joints have friction, edges stretch
  std::size_t angles_;     // first angle in z
  std::vector<Edge> edges_;
  std::vector<Joint> joints_;
  std::vector<double> placed_z_, placed_rate_;
  RootPose placed_root_;
  bool placed_ = false;  // at these, with the present references
};

}  // namespace tress::models
