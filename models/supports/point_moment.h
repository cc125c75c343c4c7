#pragma once

#include "models/motion/factor_over_time.h"
#include "models/supports/held_section.h"
#include "models/supports/support.h"

namespace tress::models {

/// A moment on the section at a point of a strand. With the factor c(t) and the axes F of
/// the section:
///
///     m = c (M + F P).
///
/// M keeps its direction in the world, P follows the material. Neither has a potential:
/// the work depends on the way of the section.
struct PointMoment {
  int point = 0;          // of MaterialPoints
  Vec dead{};             // M, N m, world components
  Vec follower{};         // P, N m, about the tangent and the axes e1, e2 of the section
  FactorOverTime factor;  // c
};

/// Refuses a moment at the end of an edge that turns with a half edge (HalfJoint). The
/// moment would act on the edge, behind the elastic half edge, and not on the held
/// section. Accepts a moment about `free_axis` alone, about which the end turns freely
/// (world components; 0: none). Throws InputError naming `where`.
void refuse_on_half_edge(System& strand, const PointMoment& moment, const Vec& free_axis,
                         const std::string& where);
/// Does so if the support holds the section of the moment.
void refuse_on_support(System& strand, const PointMoment& moment, const Support& support,
                       const std::string& where);

/// The moment's forces on the coordinates, and their derivatives.
class MomentOnSection {
 public:
  /// `strand` must outlive it; `matrix` is its S (null: full). Throws InputError naming
  /// `where` if the model has no section there that the moment could turn.
  MomentOnSection(System& strand, PointMoment moment, SparseForm* matrix,
                  const std::string& where);

  /// r -= J^T m.
  void add_force(double t, In q, InOut r) { pull(t, q, -1, r); }
  /// s -= factor d(J^T m)/dq.
  void add_tangent(double t, In q, double factor, InOut s);
  /// Returns the moment with its derivatives.
  SectionLoad load(double t, In q);
  /// Returns the power of the moment, W, seen from a frame that turns with `turning`.
  double power(double t, In q, In v, const Vec& turning);
  /// Returns the moment that acts.
  const PointMoment& moment() const { return moment_; }
  /// Returns the first time after t at which the factor is not smooth, s.
  double next_breakpoint(double t) const { return moment_.factor.next_breakpoint(t); }

 private:
  Vec at(double t, In q);
  void pull(double t, In q, double factor, InOut b);

  Sections* sections_;
  PointMoment moment_;
  HeldSection section_;
  std::vector<double> zero_;
};

}  // namespace tress::models
