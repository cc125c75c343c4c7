#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contract/forms/compliance_form.h"
#include "integrators/entry.h"
#include "integrators/position_based/anderson.h"
#include "integrators/position_based/windows.h"

namespace tress::integrators {

/// Treatment of the second derivatives of strains in block descent.
enum class Curvature {
  exact,      // as they are where the window's matrix is then positive definite
  majorised,  // sums of the sizes of each row on the diagonal
  none        // left out
};

/// Limit on the stiffness of rows that the sweeps use, for rows too stiff to converge.
struct Augmentation {
  double penalty;  // 1/s^2: largest stiffness of a row, times its G W G^T; 0: by the step
  double kept;     // part of the multipliers that the next step starts from
  int sweeps;      // before multipliers are improved
};

/// Options of BlockDescent.
struct DescentChoice {
  int sweeps;               // sweeps per step
  std::string sweep_order;  // order of the blocks in a sweep, as sweep_order_option
  int block = 1;            // nodes solved together, 0: all
  Curvature curvature = Curvature::exact;  // treatment of second derivatives
  double chebyshev =
      0;             // spectral radius for which sweeps are accelerated, 0: not at all
  int anderson = 0;  // earlier sweeps that Anderson acceleration combines, 0: none
  std::optional<Augmentation> augmentation = {};  // multipliers; none: pure descent
  bool oriented = false;  // orientations by ComplianceForm::orient
};

/// Block coordinate descent on the least action of a backward Euler step,
///
///     |x - target|^2_M/(2 h^2) + E(x),      target = origin + h v + h^2 rest,
///
/// and friction at the rates (x - origin)/h. In every sweep each window of consecutive
/// nodes (windows.h) in turn takes a Newton step on its own coordinates, with the others
/// held [Chen et al. 2024]. In odd sweeps windows begin half a window earlier. With s the
/// stress of a row, C_f = C + alpha c C' its strain with friction, gamma = alpha c/h:
///
///     H = M/h^2 + sum k (1 + gamma) G^T G + s d^2C/dx^2,    k = 1/alpha, s = k C_f.
///
/// Where H is not positive definite, a majoriser of its last term makes it so [Giles et
/// al. 2025, with row sums, which bound it, in place of norms]. Without a majoriser a
/// move is halved while the forces after it push back more than those before it drove.
/// Otherwise blocks of several locked nodes would throw each other about. Converged
/// sweeps solve backward Euler's step, including the change of G. Before convergence
/// stiff rows lock soft ones: with its neighbours held, a node moves only as far as the
/// stiffness of its rows allows. On a hair, hundreds of sweeps do not reproduce the
/// bending of one step.
///
/// With augmentation, k is at most penalty/(G W G^T), the stiffness of a spring, and the
/// multiplier makes up for the rest,
///
///     s = k C_f + (1 - k alpha) lambda,    lambda <- s after some sweeps,
///
/// whose fixed point is s = C_f/alpha: the proximal augmented Lagrangian of E with rho =
/// k/(1 - k alpha) [Rockafellar 1976].
///
/// chebyshev: x <- omega (x - x_2) + x_2, x_2 of two sweeps ago, omega <- 4/(4 - rho^2
/// omega) [Wang 2015].
///
/// anderson: AndersonMixing of x, in the norm of the masses, after every sweep, or after
/// every second one where odd sweeps have other windows. Nothing allocates in run().
class BlockDescent {
 public:
  /// Works on the compliance form of a system, which must outlive it.
  BlockDescent(System& system, const DescentChoice& choice);

  /// The multipliers of a state that is not reached by run(): of its strains.
  void begin(double t, In q);
  /// Solves the equations of time t; x is the guess, then the solution. Adds to `stats`.
  void run(double t, double h, In origin, In target, InOut x, Stats& stats);

  /// Nodes in the order of sweeps, orientations that have a closed form excluded.
  const std::vector<std::vector<int>>& nodes() const { return nodes_; }

 private:
  using Block = ComplianceForm::Block;
  static constexpr std::size_t most_rows = ComplianceForm::most_rows;
  static constexpr std::size_t columns = ComplianceForm::most_coordinates;
  using Rows = std::array<double, most_rows>;

  struct Step {
    double t, h;
    In origin, target;
  };
  /// A block at the current x.
  struct Strained {
    Rows strain, stress, stiffness;  // C_f, s, k (1 + gamma)
  };

  void look(double t, std::size_t k, In x);
  Strained strained(const Step& step, std::size_t k, In x);
  void limit(const Step& step, In x);
  void improve(const Step& step, In x);
  void sweep(const Step& step, int number, InOut x);
  void descend(const Step& step, Window& window, InOut x);
  void gather(const Step& step, Window& window, In x);
  void add(const Window::Part& part, const Strained& now, Window& window);
  void add_second(const Step& step, const Window::Part& part, const Strained& now,
                  Window& window);
  const Skyline* factored(Window& window);
  double push(const Step& step, const Window& window, In x);
  void orient(const Step& step, InOut x);
  void accelerate(int number, InOut x);

  DescentChoice choice_;
  ComplianceForm& form_;
  const std::vector<Block>& blocks_;
  std::vector<std::vector<int>> nodes_;
  /// Windows of even sweeps and of odd ones, and the order of each.
  std::array<std::vector<Window>, 2> windows_;
  std::array<std::vector<std::size_t>, 2> order_;
  std::vector<std::size_t> order_of_orientations_;
  std::vector<double> w_;
  std::vector<Rows> stiffness_, lambda_;  // k and lambda of the blocks
  double omega_ = 1;
  int map_ = 1;  // sweeps after which windows are the same again
  AndersonMixing mixing_;
  std::vector<double> last_, before_last_;    // x after sweeps
  std::vector<double> force_, move_, bound_;  // of one window
  std::vector<double> from_;                  // x before the sweeps of mixing_
  double at_[columns] = {};                   // of one block: its coordinates
  ComplianceForm::Value value_{};
};

}  // namespace tress::integrators
