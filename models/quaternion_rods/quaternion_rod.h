#pragma once

#include <memory>

#include "contract/forms/compliance_form.h"
#include "models/maximal/maximal_system.h"
#include "models/maximal/strained.h"
#include "models/maximal/strand_elimination.h"
#include "models/quaternion_rods/quaternion_elimination.h"
#include "models/quaternion_rods/rod_kind.h"

namespace tress::models {

/// Internal forces of a rod with a quaternion for every edge, coordinates z = (x_0, ...,
/// x_n, q_0, ..., q_{n-1}). `Edge` holds the strains of a single edge: a Part over
/// (x_{i+1} - x_i, q_i). Instantiated for CordeEdge and CosseratEdge.
template <class Edge>
class QuaternionRod final : public Elasticity,
                            private StrandElimination,
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
  std::optional<EndTurn> end_turn(bool tip) const override {
    return EndTurn{.quaternion = static_cast<int>(at(tip ? edges_.size() - 1 : 0))};
  }
  void displace(const Displacement& by, InOut z, InOut rate) override;
  StrandElimination* elimination() override { return walled_ ? this : nullptr; }
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

  bool factor(const Placement& p, Weights w, const Others& others) noexcept override;
  void solve(In b, Out x) noexcept override;
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
  /// h = pos df/dx + vel df/d(rate).
  void edge_tangent(const Placement& p, std::size_t i, double pos, double vel,
                    double (&h)[7][7]) const noexcept;
  void joint_tangent(const Placement& p, std::size_t j, double pos, double vel,
                     double (&h)[8][8]) const noexcept;

  std::vector<Edge> edges_;
  std::vector<QuaternionJoint> joints_;
  bool walled_;
  std::size_t quaternions_;  // first one in z
  std::vector<QuaternionElimination<double>::Factor> factors_;
};

/// Coordinates of the frames of edges.
inline constexpr Parameter coordinates_parameter{
    .name = "coordinates",
    .help =
        "coordinates of the frames: quaternions with a penalty on their norms, or "
        "rotation vectors",
    .choices = "quaternion|rotation_vector"};
/// Renewal of the references of rotation vectors.
inline constexpr Parameter renewal_parameter{
    .name = "renewal_angle_rad",
    .help =
        "angle of a rotation vector beyond which references are renewed (rad); 0: "
        "after every step",
    .number = 1,
    .min = 0,
    .max = 3};

/// A rod of this kind with the model's options. Throws InputError naming the model unless
/// the strand is a chain, and on effects that its coordinates do not have.
template <class Edge>
std::unique_ptr<System> quaternion_rod(const Strand& strand,
                                       const QuaternionRodKind<Edge>& kind,
                                       Effects effects, const Parameters& options);

}  // namespace tress::models
