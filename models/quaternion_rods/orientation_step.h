#pragma once

#include "models/quaternion_rods/quaternion_rod.h"

namespace tress::models {

/// Orientation of one edge, q of norm 1, at which the pull on the edge balances its
/// joints [Hsu et al. 2025, Stable Cosserat Rods]. All other unknowns are held fixed, and
/// inertia is left out. With joints of the isotropic energy 2 K |conj(p) q - r|^2, r at
/// rest, q minimises
///
///     -pull . t(q) - b . q,    b = sum 4 K p r.
///
/// The first term is -q^T B q, where B has the eigenvalues +-|pull|. Then (lambda - 2 B)
/// q = b and, by the projections b+ and b- of b on the eigenspaces,
///
///     q = b+/m + b-/(m + 4 |pull|),    |b+|^2/m^2 + |b-|^2/(m + 4 |pull|)^2 = 1,
///
/// for which the paper takes the bound m = |b|. Joints of other energies have different
/// stiffness about different axes, and friction at rate stiffness c/h. They enter with
/// their largest K, b . q as above and their own slope across q for b. The fixed point of
/// the step is the balance of the given energy.
class OrientationStep {
 public:
  /// The edge of q is behind the joint, or before it.
  enum class Side { before, behind };

  /// Constructs a step from `now`, of norm 1; pull (J): see Edge::pull.
  OrientationStep(const Quaternion& now, const Vec& pull) : now_(now), pull_(pull) {}
  /// x, rate: both quaternions of the joint, of norm 1, and their rates.
  void add(const QuaternionJoint& joint, double h, const double* x, const double* rate,
           Side side);
  /// Returns the orientation after the step.
  Quaternion taken() const;

 private:
  Quaternion now_;
  Vec pull_;
  double hold_ = 0;             // b . q
  Quaternion slope_{0, Vec{}};  // of the joints by q
  bool jointed_ = false;
};

}  // namespace tress::models
