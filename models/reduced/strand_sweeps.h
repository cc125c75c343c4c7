#pragma once

#include <memory>
#include <span>
#include <vector>

#include "contract/weights.h"
#include "models/reduced/free_root.h"
#include "models/reduced/reduced_strand.h"

namespace tress::models {

/// A strand under sweeps. It provides the motion of its clamp and the loads on its
/// points, which are those of ReducedStrand::blocks. The sweeps add uniform and viscous
/// loads (Effect::viscosity()) to the inertia.
class SweptStrand {
 public:
  virtual ~SweptStrand() = default;
  /// Arrays for the motion of the points, empty where no effect reads them.
  struct Places {
    Out x, v, tangent;  // 3 numbers per point, in components of the world
  };

  /// Returns the motion of the clamp in its own components, relative to free fall.
  virtual FrameMotion clamp(double t) = 0;
  /// Returns the arrays that the sweeps fill before loads() and stiffness().
  virtual Places places() = 0;
  /// Whether loads() returns any.
  virtual bool loaded() const = 0;
  /// Whether stiffness() returns any.
  virtual bool stiffened() const = 0;
  /// Returns the loads on the points in places() (3 numbers each, N).
  virtual In loads(double t) = 0;
  /// Returns -w.pos df/dx - w.vel df/dv of the points in places() (9 numbers each), made
  /// symmetric and semidefinite.
  virtual In stiffness(double t, Weights w) = 0;
};

/// Residual and elastic Jacobian of clamped strands without branches, with the elements
/// of the kernels for SIMD lanes (models/head/reduced_kernel.h). T = double: one strand;
/// Pack: one strand per lane. O(elements points).
template <class T>
class StrandSweepsOf {
  using In = std::span<const T>;
  using Out = std::span<T>;

 public:
  virtual ~StrandSweepsOf() = default;
  /// Sets the unknowns at rest.
  virtual void set_rest(In values) = 0;
  /// Writes the residual r, as System::residual().
  virtual void residual(double t, In q, In v, In a, Out r) noexcept = 0;
  /// Factors S(w). Returns false if elimination without exchange of rows is inaccurate in
  /// some lane, or a pivot is unusable.
  virtual bool factor(double t, In q, In v, In a, Weights w) noexcept = 0;
  /// Solves S(w) x = b with the last factors. b and x may be the same.
  virtual void solve(In b, Out x) noexcept = 0;
};
/// Sweeps of one strand.
using StrandSweeps = StrandSweepsOf<double>;

/// Strands to sweep over, which must outlive the sweeps, and the data they are made of,
/// with their effects.
/// Lanes beyond the last strand repeat the first.
struct ToSweep {
  std::vector<const ReducedStrand*> made;  // data, one strand per lane
  std::vector<SweptStrand*> strands;       // motion and loads, in the same order
};

/// Makes sweeps of one strand with two or three joint angles per element. Returns null
/// for other unknowns, and unless the strand is clamped, has no branches and solves
/// recursively.
std::unique_ptr<StrandSweeps> strand_sweeps(const ToSweep& strand, Unknown unknown,
                                            int modes);
/// Makes sweeps of up to four strands, one per lane, of curvatures or joint angles.
/// Returns null as strand_sweeps(), and unless the strands agree in the numbers of
/// elements and of points.
std::unique_ptr<StrandSweepsOf<Pack>> sweeps_of_four(const ToSweep& strands,
                                                     Unknown unknown, int modes);

}  // namespace tress::models
