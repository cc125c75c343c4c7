#pragma once

#include <complex>
#include <memory>
#include <vector>

#include "experiments/numerics/small_motions.h"
#include "experiments/problems/strand_models.h"
#include "experiments/validation/rods/end.h"
#include "experiments/validation/rods/loads.h"
#include "models/strand/strand.h"

namespace tress::experiments::validation {

/// One strand model and its equilibria: r(q) = G^T lambda + C^T e under the load t, with
/// g = 0 and c = 0. Here g are the model's own constraints and c the end conditions.
/// Newton's iteration solves for all unknowns. Dense, O(n^3): for a few hundred unknowns.
class Statics {
 public:
  /// Starts at the strand's initial state. Under the load t the strand has the weight of
  /// t `gravity` (m/s^2) and t end.force at its tip; supports hold at any load. `others`
  /// act as well, at the time t. Throws InputError where the model refuses the strand.
  Statics(const ModelVariant& variant, const Strand& strand, const Vec& gravity,
          End end = {}, Effects others = {});

  /// Moves the position at which the end is held.
  void hold_at(const Vec& place) { end_.place = place; }
  /// Copies the state of another strand of the same model.
  void start_at(const Statics& other);
  /// Finds the equilibrium at this load from the current state. Throws std::runtime_error
  /// when the iteration does not converge; the state is then unchanged.
  void relax(double t);
  /// relax() from `from` (or a smaller load if that fails) to `to`, both > 0, in the
  /// largest load factors for which the iteration converges.
  void follow(double from, double to);

  System& system() { return *system_; }
  In q() const { return q_; }
  /// Returns the root and the ends of the segments at the last load, (3 count) m.
  std::vector<double> points();
  Vec tip();
  /// Forces (N) along end.along, then moments (N m) about axes of end.frame, that hold
  /// the end.
  std::vector<double> holding() const { return {holding_.begin(), holding_.end()}; }
  /// Elastic and gravitational energy, J.
  double energy();

  /// Small motions about the equilibrium with all supports; the least square is negative
  /// where the equilibrium is unstable.
  std::vector<SmallMotion> motions();
  /// Returns omega^2 of the small motions, follower loads included: complex where they
  /// grow.
  std::vector<std::complex<double>> squares();
  double least_square() { return motions().front().square; }
  /// Displacements of the points in a motion's shape, (3 count) m.
  std::vector<double> displacements(const SmallMotion& motion);

 private:
  struct Conditions;  // gradients of the conditions at the present state
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
