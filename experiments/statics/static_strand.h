#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "experiments/statics/varied.h"
#include "models/supports/supported_system.h"
#include "simulation/scene/scene.h"

namespace tress::experiments::statics {

/// Unknowns of an equilibrium.
struct Balance {
  Eigen::VectorXd q;       // coordinates
  Eigen::VectorXd lambda;  // multipliers of the constraints
  double value = 0;        // parameter of the path
};

/// One strand of a scene at any value of the parameter of a path, at rest. With the
/// parameter p, its equilibria are the solutions of
///
///     R(q, lambda, p) = r(t, q, 0, 0; p) - G^T lambda = 0,   g(t, q; p) = 0.
///
/// Over supports, p is the time t. Over anything else t is 0, and each value of p has a
/// system of its own. Dense, O(n^3): for a few hundred coordinates.
class StaticStrand {
 public:
  /// Throws InputError where the strand has no equilibrium, or none that its scene
  /// determines. `number`: index of the strand in the scene.
  StaticStrand(simulation::Scene scene, std::size_t number, Varied varied);

  /// Returns the number of coordinates.
  Eigen::Index coordinates() const { return std::ssize(typical_); }
  /// Returns the number of constraints.
  Eigen::Index constraints() const { return constraints_; }
  /// Returns the typical sizes of the coordinates.
  In typical() const { return typical_; }
  /// Returns EI/L, the unit of energies, J.
  double bending() const { return bending_; }
  /// Returns the units of residuals: EI/L over the typical sizes. Of models whose mass
  /// matrix is the identity, for residuals are accelerations: EI/(rho A L^4) times those.
  const Eigen::VectorXd& units() const { return units_; }
  /// Returns the length of the strand, m.
  double length() const { return length_; }
  /// Returns the parameter of the path.
  const Varied& varied() const { return varied_; }
  /// Returns the strand as the scene describes it.
  const models::Strand& strand() const { return scene_.strands.front(); }
  /// Returns the index of the strand in the file.
  std::size_t number() const { return number_; }
  /// Returns the scene with this strand alone.
  const simulation::Scene& scene() const { return scene_; }

  /// Returns the state in which the strand comes to rest at the first value. Throws
  /// std::runtime_error if there is none.
  Balance start();

  /// Returns R and g, (n + m). Throws std::runtime_error where they are not finite.
  Eigen::VectorXd residual(const Balance& at);
  /// Returns the derivative of R and g by the parameter, (n + m), by a central
  /// difference.
  Eigen::VectorXd by_parameter(const Balance& at);
  /// Derivatives by the coordinates.
  struct Slopes {
    Eigen::MatrixXd stiffness;  // dR/dq, (n x n)
    Eigen::MatrixXd gradient;   // G^T, (n x m)
    /// Bound of the rounding errors of the stiffness over its largest entry. A load that
    /// follows the strand may be as small against the stiffness of stretch: 1e-9.
    double rounding;
  };
  /// Returns the derivatives by the coordinates.
  Slopes slopes(const Balance& at);
  /// Returns the mass matrix, (n x n).
  Eigen::MatrixXd mass(const Balance& at);

  /// Tells the model that an equilibrium was found. The model may adjust the coordinates
  /// to frames that move with the strand.
  void accept(Balance& at);
  /// Returns what accept() has changed, for recall().
  const std::vector<double>& memory() const { return memory_; }
  /// Restores what memory() returned.
  void recall(std::vector<double> memory);

  /// Returns the places of the ends of all elements, (3 per point) m.
  std::vector<double> points(const Balance& at);
  /// Returns the displacements of these points for a change of the coordinates.
  std::vector<double> displacements(const Balance& at, const Eigen::VectorXd& change);
  /// Returns the elastic energy and the potential of the loads, J.
  double energy(const Balance& at);
  /// Returns the force of a support on the strand, N.
  Vec support_force(const Balance& at, std::size_t support);
  /// Returns the supports of the strand.
  const std::vector<models::Support>& supports();

 private:
  std::unique_ptr<models::SupportedSystem> make(double value) const;
  models::SupportedSystem& at(double value);
  double time(double value) const;

  simulation::Scene scene_;  // with this strand alone
  std::size_t number_;
  Varied varied_;
  std::unique_ptr<models::SupportedSystem> system_;
  double value_ = 0;  // of system_
  std::vector<double> memory_, typical_, zero_;
  Eigen::VectorXd units_;
  Eigen::Index constraints_ = 0;
  double bending_ = 0, length_ = 0;
};

}  // namespace tress::experiments::statics
