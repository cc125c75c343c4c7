#pragma once

#include <complex>
#include <memory>
#include <vector>

#include "experiments/problems/model_variants.h"
#include "experiments/validation/rods/end.h"
#include "experiments/validation/rods/loads.h"
#include "experiments/validation/rods/small_motions.h"
#include "models/strand/strand.h"

namespace tress::experiments::validation {

/// One model of a strand and its equilibria: r(q) = G^T lambda + C^T e under the load t,
/// g = 0, c = 0, with the model's own constraints g, and c those that hold the end, by
/// Newton's iteration on all unknowns. Dense, O(n^3): for some hundred unknowns.
class Statics {
 public:
  /// At the strand's initial state. Under the load t the strand has the weight of t
  /// `gravity` (m/s^2) and t end.force at its tip; what is held is held at any load.
  /// `others` act as well, at the time t. Throws InputError where the model refuses the
  /// strand.
  Statics(const ModelVariant& variant, const Strand& strand, const Vec& gravity,
          End end = {}, Effects others = {});

  /// Moves the place at which the end is held.
  void hold_at(const Vec& place) { end_.place = place; }
  /// Goes where another strand of the same model is.
  void start_at(const Statics& other);
  /// The equilibrium at this load, from where the strand is. Throws std::runtime_error
  /// when the iteration does not converge; the strand is then where it was.
  void relax(double t);
  /// relax() from `from`, or less of it where that is too much, to `to` (both > 0), loads
  /// as far apart by a factor as the iteration bears.
  void follow(double from, double to);

  System& system() { return *system_; }
  In q() const { return q_; }
  /// Of the last load: root and ends of the segments, (3 count) m.
  std::vector<double> points();
  Vec tip();
  /// Forces (N) along end.along, then moments (N m) about axes of end.frame, that hold
  /// the end.
  std::vector<double> holding() const { return {holding_.begin(), holding_.end()}; }
  /// Elastic energy and that of the weight, J.
  double energy();

  /// About the equilibrium with all that holds it; the least square is negative where the
  /// equilibrium is not stable.
  std::vector<SmallMotion> motions();
  /// Their omega^2, with what follower loads make of them: complex where they grow.
  std::vector<std::complex<double>> squares();
  double least_square() { return motions().front().square; }
  /// What a shape does to the points, (3 count) m.
  std::vector<double> displacements(const SmallMotion& motion);

 private:
  struct Conditions;  // their slopes at the present state
  Conditions conditions();
  struct Motion;  // M, K and the conditions of small motions
  Motion motion();
  Eigen::MatrixXd stiffness();
  void take_curvature();
  void load_tip();
  void guess_forces();
  double newton_step();  // the largest correction, over typical sizes

  End end_;
  std::shared_ptr<TipForce> tip_force_;
  std::unique_ptr<System> system_;
  std::unique_ptr<EndConditions> conditions_;
  std::vector<double> q_, q_typ_;
  Eigen::VectorXd lambda_, holding_;
  Eigen::MatrixXd curvature_;  // of the held section, as last taken
  double t_ = 0;
  double work_ = 0;  // of all steps, (unknowns)^3 each
};

}  // namespace tress::experiments::validation
