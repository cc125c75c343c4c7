#pragma once

#include "contract/jacobian_choice.h"
#include "math/pack.h"
#include "models/maximal/edge_reference.h"
#include "models/maximal/elasticity.h"
#include "models/maximal/kernel/der_forces.h"
#include "models/maximal/strand_elimination.h"
#include "models/strand/rod_joint.h"

namespace tress::models {

/// Stretching, bending and twisting of a discrete rod (der.cpp), coordinates z = (x_0,
/// ..., x_n, theta_0, ..., theta_{n-1}), by the kernel that heads use (kernel/): forces
/// and, of clamped strands, S by elimination. Other strands, and constraints, need S
/// assembled: from the same derivatives by rotations of edges.
class DerElasticity final : public Elasticity,
                            private NaturalStrains,
                            private StrandElimination,
                            private TransposedElimination {
 public:
  /// An edge at rest.
  struct EdgeData {
    Frame reference;  // frame at rest
    double length;    // at rest, m
    double stretch;   // EA/l, N/m; 0: held by constraints
  };
  /// `joints`: between neighbouring edges; if `walled`, the clamp's joint comes first.
  DerElasticity(std::vector<EdgeData> edges, std::vector<RodJoint> joints, bool walled,
                Jacobian jacobian);

  std::vector<std::vector<int>> groups() const override;
  void add_force(const Placement& p, InOut f) noexcept override;
  void add_tangent(const Placement& p, double pos, double vel,
                   GroupSum& s) noexcept override;
  double energy(const Placement& p) noexcept override;
  double power(const Placement& p) noexcept override;
  Vec spin(const Placement& p, In inertia) noexcept override;
  std::optional<Frame> end_frame(const Placement& p) noexcept override;
  std::optional<EndTurn> end_turn(bool tip) const override {
    const std::size_t edge = tip ? edge_data_.size() - 1 : 0;
    return EndTurn{static_cast<int>(angles_ + edge), edge_data_[edge].reference};
  }
  bool rebase(const RootPose& root, InOut z, InOut rate) override;
  void carry(InOut z, InOut rate, InOut second) const override;
  void displace(const Displacement& by, InOut z, InOut rate) override;
  void reset() override;
  std::vector<double> memory() const override;
  /// Restores what keep() wrote.
  void recall(In memory) override;
  StrandElimination* elimination() override { return walled_ ? this : nullptr; }
  NaturalStrains* natural_strains() override { return this; }
  bool takes_stresses() const override { return jacobian_ == Jacobian::exact && stiff_; }

 private:
  std::vector<double> natural() const override {
    return of_joints(joint_data_, &RodJoint::rest);
  }
  void set_natural(In values) override {
    for (std::size_t j = 0; j < joint_data_.size(); ++j) {
      joint_data_[j].rest = load3(&values[3 * j]);
    }
    forget();
  }
  std::vector<double> natural_stiffness() const override {
    return of_joints(joint_data_, &RodJoint::stiffness);
  }

  bool factor(const Placement& p, Weights w, const Others& others) noexcept override;
  void solve(In b, Out x) noexcept override;
  TransposedElimination* transposed() override {
    return jacobian_ == Jacobian::exact ? this : nullptr;
  }
  void solve_transposed(In b, Out x) noexcept override;
  void add_by_rates(InOut f) noexcept override;
  void place_transposed(const Placement& p, In x) noexcept override;
  std::vector<double> constants() const override;
  void add_by_constants(InOut by) noexcept override;

  /// An edge at a placement, and the joint before it.
  struct Edge : DerExactPlaced<double> {
    DerMotion<double> motion;
    Vec strain;  // less that at rest
    Vec rate;    // of the strain
    double twist = 0;
    DerForces<double, true>::ByLengthening by_lengthening;
    double sigma = 0;  // of solve()
    // Of the solution of solve_transposed().
    Vec relative;            // rotation, less that of the edge before
    double lengthening = 0;  // lengthening
    /// Change of the strain.
    Vec strain_change() const;
  };
  using Edges = std::vector<Edge>;
  /// Edges, and where they were computed.
  struct Placed {
    explicit Placed(std::size_t count) : edges(count), at(4 * count + 3) {}
    Edges edges;
    LastPlacement at;
  };
  using Stiff = DerStiffElimination<double>;
  using Exact = DerExactElimination<double>;
  /// Matrix over (e, theta) of the edges before and behind a joint; one pack per row for
  /// each edge.
  using Matrix = Pack[8][2];

  /// Joint before an edge; the first edge of a free strand has none.
  const RodJoint* joint(std::size_t edge) const {
    const std::size_t j = walled_ ? edge : edge - 1;  // wraps around
    return j < joint_data_.size() ? &joint_data_[j] : nullptr;
  }
  double theta(In z, std::size_t edge) const { return z[angles_ + edge]; }

  /// The edges at a placement, computed unless they are known: Newton's method needs
  /// matrix and force of the same.
  const Edges& place(const Placement& p) noexcept;
  /// Computes the edges that a matrix needs.
  void place(const Placement& p, Weights w, Placed& to) noexcept;
  template <bool with_tangent, bool exact>
  void place_as(const Placement& p, Weights w, Placed& to) noexcept;
  /// Returns the moment of all joints on an edge.
  Vec moment(const Edges& edges, std::size_t i) const;
  void forget();
  void forget_turns();
  void joint_tangent(const Edges& edges, std::size_t i, Matrix& s) const noexcept;
  /// Tension (N) in the tangent's terms of second order.
  double tension(const Placement& p, const Edges& edges, std::size_t i) const noexcept {
    if (p.origin == nullptr) return edges[i].tension;
    return length_stress(edge_data_[i].stretch, edge_data_[i].length, p, i);
  }
  void add_edge_tangent(const Placement& p, const Edges& edges, std::size_t i, double pos,
                        Pack (&h)[4]) const noexcept;
  template <class Elimination>
  bool eliminate(const Placement& p, Weights w, const Others& others,
                 std::vector<typename Elimination::Factor>& factors) noexcept;
  template <class Elimination>
  void solve_by(std::vector<typename Elimination::Factor>& factors, In b, Out x) noexcept;
  template <class Elimination>
  double substitute(std::vector<typename Elimination::Factor>& factors, double sign,
                    InOut x) noexcept;
  void correct(double most, InOut x) noexcept;
  double substitute_transposed(double sign, InOut x) noexcept;

  std::vector<EdgeData> edges_at_start_, edge_data_;
  std::vector<Replaced> replaced_;
  std::vector<RodJoint> joint_data_;
  std::vector<double> twist_;  // of the joint before every edge, after the last accepted
                               // step: see wound()
  bool walled_;
  Jacobian jacobian_;
  bool friction_, stiff_;  // whether joints have friction, edges stretch
  std::size_t angles_;     // first angle in z
  Placed factored_, now_;  // of factor(), and of anything else
  const Placed* latest_ = nullptr;
  std::vector<Stiff::Factor> stiff_factors_;
  std::vector<Exact::Factor> exact_factors_;
};

}  // namespace tress::models
