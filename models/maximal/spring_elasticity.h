#pragma once

#include <memory>
#include <tuple>
#include <vector>

#include "contract/forms/compliance_form.h"
#include "models/maximal/angle_strain.h"
#include "models/maximal/elasticity.h"
#include "models/maximal/spring_strain.h"

namespace tress::models {

/// Energy k (s - rest)^2/2 and friction c s' of a strain s (spring_strain.h) over
/// neighbouring edges.
template <class Strain>
struct Spring {
  Strain strain;          // strain of the edges
  std::size_t first = 0;  // edge
  double stiffness = 0;   // k: N/m, or N m if s is dimensionless
  double friction = 0;    // c: unit of k times s
  double rest = 0;        // rest value of s
};

/// All springs of a chain of nodes z = (x_0, ..., x_n). Wall strains turn with the clamp.
using Springs =
    std::tuple<std::vector<Spring<Chord<1>>>, std::vector<Spring<Chord<2>>>,
               std::vector<Spring<Hinge>>, std::vector<Spring<Altitude>>,
               std::vector<Spring<WallBend>>, std::vector<Spring<WallAltitude>>,
               std::vector<Spring<BendAngle>>, std::vector<Spring<Dihedral>>,
               std::vector<Spring<WallDihedral>>>;

/// The terms included in df/dz. With g the gradient of s,
///
///     exact      k g g^T + (k (s - rest) + c s') H + c g (ds'/dz)^T
///     filtered   k g g^T + k max(0, 1 - rest/s) (J^T J - g g^T), s = |b|, J = db/dz:
///
/// filtered drops the transverse term of a spring under compression, and with it all
/// terms that could make the matrix indefinite or, with friction, unsymmetric.
enum class SpringJacobian { exact, filtered };

class SpringChain;

/// Internal forces of a strand of point masses and springs.
class SpringElasticity final : public Elasticity, private StrainForm {
 public:
  /// Takes the springs of a strand.
  SpringElasticity(Springs springs, SpringJacobian jacobian);
  ~SpringElasticity() override;

  std::vector<std::vector<int>> groups() const override;
  void add_force(const Placement& p, InOut f) noexcept override;
  void add_tangent(const Placement& p, double pos, double vel,
                   GroupSum& s) noexcept override;
  double energy(const Placement& p) noexcept override;
  double power(const Placement& p) noexcept override;
  std::optional<EndTurn> end_turn(bool) const override { return EndTurn{}; }
  /// Moves no frames, but compares angles with those of the last call. The force of a
  /// joint that is bent at rest has no limit where the joint is straight. That of a
  /// dihedral angle has none where the angle is half a turn from rest. Both jump there.
  bool rebase(const RootPose& root, InOut z, InOut rate) override;
  void displace(const Displacement&, InOut /*z*/, InOut /*rate*/) override {
    angles_.clear();
  }
  Jumps jumps() const override { return jumps_; }
  void reset() override {
    angles_.clear();
    jumps_ = {};
  }
  /// Restores what keep() wrote.
  void recall(In /*memory*/) override { angles_.clear(); }
  StrandElimination* elimination() override;
  StrainForm* strain_form() override { return this; }
  bool takes_stresses() const override {
    return jacobian_ == SpringJacobian::exact &&
           !(std::get<0>(springs_).empty() && std::get<1>(springs_).empty());
  }

 private:
  std::vector<ComplianceForm::Block> strain_blocks() const override;
  void strain(std::size_t k, const RootPose& root, const double* z,
              ComplianceForm::Value& value) noexcept override;
  void add_second(std::size_t k, const RootPose& root, const double* z, In stress,
                  ComplianceForm::Second& h) noexcept override;

  Springs springs_;
  SpringJacobian jacobian_;
  std::unique_ptr<SpringChain> chain_;  // null: springs that the kernel does not have
  /// A strain that can jump, at the last rebase().
  struct Angle {
    double value;  // of a dihedral angle
    Vec binormal;  // of a bend, whatever its length
  };
  std::vector<Angle> angles_;  // of those springs, in order; empty: not known
  Jumps jumps_;
  std::vector<std::size_t> along_;  // indices of all springs, from root to tip
};

}  // namespace tress::models
