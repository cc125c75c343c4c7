#pragma once

#include "models/head/exact/exact_elimination.h"

namespace tress::models {

/// Newton's step of ReducedKernel's strands with all derivatives of the residual:
///
///     x = S^-1 r,   S = w.pos dr/dq + w.vel dr/dv + w.acc dr/da
///
/// The equations are those of models/reduced/exact_tangent.h. A frame's state is the
/// variation of its velocity (v, omega) and acceleration (a, alpha) in its own
/// components. In these, gravity, inertia and linear drag do not depend on displacements.
/// Where bodies load the part that hangs on an element, the state includes its
/// displacement (d, phi). For an element with the state s at its start, unknowns x and
/// the wrench w_tip on its tip
///
///     s_tip = A s + B x,    w = C s + D x + G w_tip,    r = R s + H x + J w_tip
///
/// The part that hangs on a tip responds with w_tip = L s_tip + beta
/// (models/reduced/tree/recursive_solver.h). Elimination of x from r = b passes to the
/// start
///
///     L' = C + G L A - Y R',  Y = (D + G L B) H'^-1,  R' = R + J L A,  H' = H + J L B
///     beta' = G beta + Y (b - J beta)
///
/// A and G are motions of a rigid body except for the effect of omega on accelerations,
/// so they act by cross products, in the components of the start. The x-columns are
/// derivatives of the element's tip and wrench by varied numbers (VariedElement). The
/// s-columns are closed sums over its points. H' is inverted without pivoting; Newton's
/// iteration corrects the error.
///
/// Compiled without fused products, whose choice depends on the number of lanes: results
/// are bit-identical for all.
template <class Kind>
class ExactKernel {
 public:
  /// Kernel of the sweeps along a strand.
  using Kernel = ReducedKernel<Kind>;
  /// Scalar: a number, or a pack of SIMD lanes.
  using T = typename Kind::Real;
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Data of an element that steps do not change.
  using Material = ReducedMaterial<T>;
  /// Motion of a frame.
  using Motion = ReducedMotion<T>;
  /// Elimination of an element.
  using Elimination = ExactElimination<T, sizeof(typename Kind::Unknowns) / sizeof(Vec)>;
  /// Unknowns of an element.
  using Unknowns = typename Kind::Unknowns;
  /// Working memory of one thread.
  using Scratch = typename Kernel::Scratch;
  using Factors = typename Elimination::Factors;  // of an element, between sweeps

  /// `kernel` must outlive it.
  explicit ExactKernel(const Kernel& kernel) : kernel_(kernel) {}

  /// Motion at the state, for loads in `scratch`; returns what newton() and again() need.
  Motion move(const Material& m, const Motion& root, const Unknowns* q, const Unknowns* v,
              const Unknowns* a, Scratch* scratch, Factors* factors) const;
  /// x in `correction`; returns its largest entry per lane, NaN unless all are finite.
  /// `end`: what move() returned; `loads`: of an element null or its points, null if
  /// there are none; `rest`, q, v, a, correction, and `scratch` of move(): (elements).
  T newton(const Material& m, const Motion& end, const ExactPoint<T>* const* loads,
           const Unknowns* rest, Weights w, const Unknowns* q, const Unknowns* v,
           const Unknowns* a, Unknowns* correction, const Scratch* scratch,
           Factors* factors) const;
  /// Computes a correction with the factors of the last newton(), at another state.
  T again(const Material& m, const Motion& end, const typename Kind::Loads* const* loads,
          const Unknowns* rest, const Unknowns* v, const Unknowns* a,
          Unknowns* correction, const Scratch* scratch, Factors* factors) const;

 private:
  using Each = typename Elimination::template Each<Vec>;
  // Unknowns are vectors one after the other.
  static Each* each(Unknowns* x) { return reinterpret_cast<Each*>(x); }

  const Kernel& kernel_;
};

}  // namespace tress::models
