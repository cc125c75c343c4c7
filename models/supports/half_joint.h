#pragma once

#include "models/strand/rod_joint.h"
#include "models/supports/held_section.h"

namespace tress::models {

/// Elastic joint of half an edge between a wall and the last edge of a strand, for models
/// whose edges do not bend. It is the counterpart of the joint at a clamped root. With c
/// the rotation of HeldSection and the coefficients of a RodJoint:
///
///     U = sum_k stiffness_k (c_k - lead_k)^2/2,    friction_k on c'_k.
///
/// With a hinge, the joint has no stress about the axis of the hinge. Its stiffness is
/// that of a section as stiff in every direction across the tangent.
///
/// c is 0 where the half edge has its natural shape. A clamp with this joint is accurate
/// to second order in the length of the edges. To hold the direction of the last edge
/// itself would be accurate to first order.
class HalfJoint {
 public:
  /// Takes the coefficients of the joint; its rest value is not used. `begin`: the
  /// section at the start, seen from the wall (Support::begin).
  HalfJoint(HeldSection section, const RodJoint& joint, const Frame& begin = {})
      : section_(std::move(section)), joint_(joint), begin_(begin) {}

  /// Returns the held components of c less those of the start, rad; others are 0.
  Vec rotation(double t, In q);
  /// Moves the rest value of c, for searches that approach the wall.
  void lead(const Vec& by) { lead_ = by; }

  /// r += the generalised forces of the joint.
  void add_force(double t, In q, In v, InOut r);
  /// s += w.pos dr/dq + w.vel dr/dv.
  void add_tangent(double t, In q, In v, Weights w, InOut s);
  /// Returns the moment of the joint on the section, with its derivatives.
  SectionLoad load(double t, In q, In v);
  /// Returns the elastic energy, J.
  double energy(double t, In q);
  /// Returns the rate of the elastic energy, W.
  double energy_rate(double t, In q, In v);
  /// Returns the path whose frame is the wall.
  const RootMotion& path() const { return section_.path(); }

 private:
  Vec held(const Vec& c) const;
  Vec stress(const SectionGap& gap) const;

  HeldSection section_;
  RodJoint joint_;
  Frame begin_;
  Vec lead_;
  std::vector<double> zero_;
};

}  // namespace tress::models
