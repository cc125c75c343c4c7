#pragma once

#include <vector>

#include "contract/forms/compliance_form.h"
#include "contract/forms/natural_strains.h"
#include "contract/forms/stress_form.h"
#include "models/maximal/groups.h"
#include "models/motion/root_motion.h"
#include "models/motion/teleport.h"

namespace tress::models {

/// Origin of stresses (StressForm): all coordinates z and the clamp there.
struct StressOrigin {
  RootPose root;          // clamp at the origin
  std::vector<double> z;  // coordinates at the origin
  /// Stresses in the next tangents.
  StressForm::Stresses stresses = StressForm::Stresses::held;

  /// Returns the stress of a stiffness whose strain at the origin is `strain`. `change`
  /// is the product of the gradient there with the change of z since.
  double stress(double stiffness, double strain, double change) const {
    const bool follow = stresses == StressForm::Stresses::followed;
    return stiffness * (follow ? strain + change : strain);
  }
};

/// State of a strand of redundant coordinates for its internal forces: all coordinates
/// z = [held; q], those prescribed by the clamp first, their rates, and the clamp.
struct Placement {
  const RootPose& root;  // clamp
  In z, rate;            // coordinates and their rates
  /// Origin of stresses in the second-order terms of tangents; null: this state.
  const StressOrigin* origin = nullptr;
};

/// Stress in the tangent's terms of second order of a spring along the edge before node
/// i + 1, from the origin of p.
inline double length_stress(double stiffness, double rest, const Placement& p,
                            std::size_t i) {
  const auto along = [i](In z) { return load3(&z[3 * i + 3]) - load3(&z[3 * i]); };
  const Vec from = along(p.origin->z);
  const double length = norm(from);
  return p.origin->stress(stiffness, length - rest,
                          dot(from, along(p.z)) / length - length);
}

/// The energy and friction of an Elasticity in terms of strains s(z, clamp), for the
/// ComplianceForm of contract/system.h.
class StrainForm {
 public:
  virtual ~StrainForm() = default;
  /// Blocks in order along the strand from the root; coordinates are indices into z.
  virtual std::vector<ComplianceForm::Block> strain_blocks() const = 0;
  /// Strain of block k at z, the values of its coordinates. The drift is the rate due to
  /// a turning clamp.
  virtual void strain(std::size_t k, const RootPose& root, const double* z,
                      ComplianceForm::Value& value) noexcept = 0;
  /// Adds second derivatives as ComplianceForm::add_second, over all coordinates of the
  /// block.
  virtual void add_second(std::size_t k, const RootPose& root, const double* z, In stress,
                          ComplianceForm::Second& h) noexcept = 0;
  /// Returns the orientations of the ComplianceForm; coordinates are indices into z.
  virtual std::vector<ComplianceForm::Orientation> orientations() const { return {}; }
  /// z, origin: the coordinates of orientation k. `q`: its four of z, to be moved.
  virtual void orient(std::size_t /*k*/, const RootPose& /*root*/, double /*h*/,
                      const double* /*origin*/, const double* /*z*/,
                      double* /*q*/) noexcept {}
};

/// Coordinates that turn the section at an end of a strand. The direction e from its
/// first node to the second, or from the last but one to the last, turns it as well.
struct EndTurn {
  int angle = -1;       // index in z of an angle about e (rod_edge.h); -1: none
  Frame reference{};    // of the angle, on this side of an accepted step
  int quaternion = -1;  // index in z of four numbers that are the frame; -1: none
};

class StrandElimination;  // models/maximal/strand_elimination.h

/// Internal forces of a strand: an elastic energy E(z, clamp) and friction. Groups are
/// sets of coordinates (indices into z) coupled by one term; the tangent is delivered as
/// one square matrix per group, in the order of groups().
class Elasticity {
 public:
  virtual ~Elasticity() = default;
  /// Returns the groups of coordinates.
  virtual std::vector<std::vector<int>> groups() const = 0;
  /// f += dE/dz + friction.
  virtual void add_force(const Placement& p, InOut f) noexcept = 0;
  /// s += pos df/dz + vel df/d(rate).
  virtual void add_tangent(const Placement& p, double pos, double vel,
                           GroupSum& s) noexcept = 0;
  /// Returns the elastic energy, J.
  virtual double energy(const Placement& p) noexcept = 0;
  /// Power (W) of friction (negative) and of a turning clamp.
  virtual double power(const Placement& p) noexcept = 0;
  /// Angular momentum (kg m^2/s) of coordinates other than positions, with this inertia;
  /// 0 if the model neglects it.
  virtual Vec spin(const Placement&, In /*inertia*/) noexcept { return {}; }
  /// Largest |length/rest - 1|, for nodes that are not on the curve (see MaximalStrand).
  virtual double stretch(const Placement&) noexcept { return 0; }
  /// Frame of the last edge, or of the section at the tip. Empty: there is none.
  virtual std::optional<Frame> end_frame(const Placement&) noexcept { return {}; }
  /// Returns the coordinates that turn the section at the tip, or at a free root. Empty:
  /// not known.
  virtual std::optional<EndTurn> end_turn(bool /*tip*/) const { return {}; }
  /// After an accepted step: may move reference frames, and with them z and its rate.
  /// True if the equations changed.
  virtual bool rebase(const RootPose& /*root*/, InOut /*z*/, InOut /*rate*/) {
    return false;
  }
  /// Carries all coordinates, as MovingHistory::carry().
  virtual void carry(InOut /*z*/, InOut /*rate*/, InOut /*second*/) const {}
  /// Carries the coordinates other than positions, and all that is remembered, at a
  /// teleport. Positions and their rates have been carried.
  virtual void displace(const Displacement& /*by*/, InOut /*z*/, InOut /*rate*/) {}
  /// Jumps of forces that rebase() has seen since reset().
  struct Jumps {
    long count = 0;         // number of jumps
    std::size_t joint = 0;  // of the first; joint k begins edge k
  };
  /// Returns the jumps since reset().
  virtual Jumps jumps() const { return {}; }
  virtual void reset() {}                                    // undoes every rebase()
  virtual std::vector<double> memory() const { return {}; }  // as History::memory()
  /// Restores what memory() returned.
  virtual void recall(In /*memory*/) {}
  /// Whether tangents look at Placement::origin.
  virtual bool takes_stresses() const { return false; }
  /// Null if S cannot be eliminated along the strand, and must be assembled.
  virtual StrandElimination* elimination() { return nullptr; }
  /// Null if the energy is not a function of strains.
  virtual StrainForm* strain_form() { return nullptr; }
  /// Null if it has no natural strain for every direction in which the strand bends.
  virtual NaturalStrains* natural_strains() { return nullptr; }
};

}  // namespace tress::models
