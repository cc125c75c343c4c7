#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "models/supports/half_joint.h"
#include "models/supports/natural_motion.h"
#include "models/supports/point_moment.h"
#include "models/supports/point_spring.h"

namespace tress::models {

/// Forces on the points and sections of a strand in addition to its own: half joints of
/// clamps, springs of compliant supports, and moments.
class AddedForces {
 public:
  /// `strand` must outlive them, and so must `natural`, which half edges follow. Throws
  /// InputError naming the support, or the moment, if the strand cannot bear it.
  AddedForces(System& strand, const std::vector<Support>& supports,
              std::vector<PointMoment> moments, const NaturalMotion& natural);

  /// Returns true if there are forces.
  bool any() const { return !joints_.empty() || !springs_.empty() || !moments_.empty(); }
  /// r -= the generalised forces.
  void add_to_residual(double t, In q, In v, InOut r);
  /// s += the derivatives of add_to_residual() with weights w.
  void add_tangent(double t, In q, In v, Weights w, InOut s);
  /// Appends all forces as loads.
  void append_loads(double t, In q, In v, std::vector<SectionLoad>& loads);
  /// Returns the elastic energy, J.
  double energy(double t, In q);
  /// Returns the rate of the elastic energy, W.
  double energy_rate(double t, In q, In v);
  /// Returns the power of the moments, W, seen from a frame that turns with `turning`.
  double power_of_moments(double t, In q, In v, const Vec& turning);
  /// Writes forces and moments of supports that springs and joints hold; leaves others
  /// as they are.
  void write_support_forces(double t, In q, In v, Out forces, Out moments);
  /// Returns the first time after t at which a moment is not smooth, s.
  double next_breakpoint(double t) const;

  // For searches that lead the strand onto its supports.
  /// Writes the rotations (rad) of the half joints less those of the start, (3 joints).
  /// Joints of compliant supports have 0: they may begin away from their walls.
  void joint_rotations(double t, In q, Out c);
  /// Returns the number of joints.
  std::size_t joints() const { return joints_.size(); }
  /// Moves the rest values of the joints, (3 joints) rad; 0 at first.
  void lead_joints(In by);

  /// Returns the springs of places, each with the number of its support.
  const std::vector<std::pair<std::size_t, PointSpring>>& springs() const {
    return springs_;
  }
  /// Returns the moments.
  const std::vector<MomentOnSection>& moments() const { return moments_; }
  /// Returns true if there are moments.
  bool has_moments() const { return !moments_.empty(); }
  /// r -= J^T m of the moments alone.
  void add_moments(double t, In q, InOut r);

 private:
  /// Joint of a support.
  struct Joint {
    std::size_t support;  // its number
    bool compliant;       // whether the support is compliant
    HalfJoint joint;
  };
  std::vector<Joint> joints_;
  std::vector<std::pair<std::size_t, PointSpring>> springs_;  // with their supports
  std::vector<MomentOnSection> moments_;
};

}  // namespace tress::models
