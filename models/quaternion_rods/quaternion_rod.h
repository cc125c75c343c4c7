#pragma once

#include <functional>
#include <memory>
#include <string>

#include "math/quaternion.h"
#include "models/maximal/maximal_system.h"
#include "models/maximal/rod_joint.h"
#include "models/maximal/strained.h"

namespace tress::models {

/// Bending and twisting between neighbouring quaternions x = (q_j, q_{j+1}) of a rod, or
/// between a clamp's frame and the first: strains 2 vec(conj(q_j) q_{j+1}) minus those at
/// rest.
/// A Part of strained.h.
struct QuaternionJoint {
  static constexpr int strains = 3, coordinates = 8;
  double rest[strains], stiffness[strains], friction[strains];

  explicit QuaternionJoint(const RodJoint& joint) {
    store3(joint.rest, rest);
    store3(joint.stiffness, stiffness);
    store3(joint.friction, friction);
  }
  template <class T>
  void strain(const T* x, T* s) const {
    store3(turn_between(load_quaternion(x), load_quaternion(x + 4)), s);
    for (int k = 0; k < strains; ++k) s[k] = s[k] - T(rest[k]);
  }
  void gradient(const double* x, double (&g)[strains][coordinates]) const;
  void add_second(const double* x, const double* stress,
                  double (&h)[coordinates][coordinates]) const;
};

/// Internal forces of a rod with a quaternion for every edge, coordinates z = (x_0, ...,
/// x_n, q_0, ..., q_{n-1}). `Edge` holds the strains of a single edge: a Part over
/// (x_{i+1} - x_i, q_i). Instantiated for CordeEdge and CosseratEdge.
template <class Edge>
class QuaternionRod final : public Elasticity,
                            private StrainForm,
                            private NaturalStrains {
 public:
  /// `joints`: between neighbouring edges; if `walled`, the clamp's joint comes first.
  QuaternionRod(std::vector<Edge> edges, std::vector<QuaternionJoint> joints,
                bool walled);

  std::vector<std::vector<int>> groups() const override;
  void add_force(const Placement& p, InOut f) noexcept override;
  void add_tangent(const Placement& p, double pos, double vel,
                   GroupSum& s) noexcept override;
  double energy(const Placement& p) noexcept override;
  double power(const Placement& p) noexcept override;
  Vec spin(const Placement& p, In inertia) noexcept override;
  std::optional<Frame> end_frame(const Placement& p) noexcept override;
  StrainForm* strain_form() override { return this; }
  bool takes_stresses() const override { return true; }
  NaturalStrains* natural_strains() override { return this; }

 private:
  std::vector<double> natural() const override {
    return of_joints([](const QuaternionJoint& joint) { return joint.rest; });
  }
  void set_natural(In values) override {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      std::copy_n(&values[3 * j], 3, joints_[j].rest);
    }
  }
  std::vector<double> natural_stiffness() const override {
    return of_joints([](const QuaternionJoint& joint) { return joint.stiffness; });
  }
  template <class Member>
  std::vector<double> of_joints(Member member) const {
    std::vector<double> all;
    for (const QuaternionJoint& joint : joints_) {
      all.insert(all.end(), member(joint), member(joint) + 3);
    }
    return all;
  }

  /// Coordinates of one part and their rates.
  template <class Part>
  struct Local {
    double x[Part::coordinates], rate[Part::coordinates];
  };

  std::vector<ComplianceForm::Block> strain_blocks() const override;
  void strain(std::size_t k, const RootPose& root, const double* z,
              ComplianceForm::Value& value) noexcept override;
  void add_second(std::size_t k, const RootPose& root, const double* z, In stress,
                  ComplianceForm::Second& h) noexcept override;
  std::vector<ComplianceForm::Orientation> orientations() const override;
  void orient(std::size_t k, const RootPose& root, double h, const double* origin,
              const double* z, double* q) noexcept override;
  void wall_strain(const RootPose& root, const double* z,
                   ComplianceForm::Value& value) const noexcept;
  void edge_strain(std::size_t i, const double* z,
                   ComplianceForm::Value& value) const noexcept;

  bool clamp(std::size_t joint) const { return walled_ && joint == 0; }
  /// Index in z of the quaternion of an edge.
  std::size_t at(std::size_t edge) const { return quaternions_ + 4 * edge; }
  /// Edge behind a joint; before it is the previous edge, or the clamp.
  std::size_t behind(std::size_t joint) const { return walled_ ? joint : joint + 1; }
  /// Joint before an edge, unless it is the first of a rod without a wall.
  std::size_t before(std::size_t edge) const { return walled_ ? edge : edge - 1; }
  Local<Edge> edge(const Placement& p, std::size_t i) const noexcept;
  Local<QuaternionJoint> joint(const Placement& p, std::size_t j) const noexcept;

  std::vector<Edge> edges_;
  std::vector<QuaternionJoint> joints_;
  bool walled_;
  std::size_t quaternions_;  // first one in z
};

/// A chain with nodes at the segments' ends, masses lumped there, and a quaternion of
/// inertia 4 rho (I1 + I2 + rotary A l^2) l for every edge. `edge_of` makes the Edge of a
/// segment. Throws InputError naming `model` unless the strand is a chain.
template <class Edge>
std::unique_ptr<System> quaternion_rod(const Strand& strand, const std::string& model,
                                       const std::function<Edge(const Segment&)>& edge_of,
                                       double rotary, Effects effects, LinearKind solver);

}  // namespace tress::models
