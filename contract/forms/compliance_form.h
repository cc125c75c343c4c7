#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "contract/basics.h"

namespace tress {

/// Elastic energy and friction as sums over blocks k, with all other forces as an
/// acceleration. Block k has few constraints C_k(t, x), where x are the coordinates that
/// it touches. Position-based methods need this form [Macklin, Mueller & Chentanez 2016,
/// XPBD, eqs. 4 and 26]. With W = M^-1 diagonal and constant, alpha the compliances and c
/// the friction,
///
///     E = sum_k C_k^T alpha^-1 C_k/2,    a = rest - W sum_k G_k^T s_k,
///     s = alpha^-1 C + c C',    G = dC/dq,    C' = G v + C_t.
///
/// C has model-specific units u: alpha in u^2/J, c in J s/u^2. For unconstrained systems
/// only.
class ComplianceForm {
 public:
  static constexpr int most_rows = 5, most_coordinates = 12;  // bounds for a block

  /// Constant data of a block.
  struct Block {
    std::vector<int> coordinates;              // indices into q, ascending
    int rows = 0;                              // constraints
    std::array<double, most_rows> alpha{};     // >= 0
    std::array<double, most_rows> friction{};  // c >= 0
  };
  /// Values of a block at a state.
  struct Value {
    double c[most_rows];                           // constraints C_k, u
    double drift[most_rows];                       // C_t
    double gradient[most_rows][most_coordinates];  // G = dC/dq, by rows of C
  };

  virtual ~ComplianceForm() = default;
  /// Ordered along the body from the root; fixed for life.
  virtual const std::vector<Block>& blocks() const = 0;
  virtual void inverse_mass(Out w) const = 0;  // (n) the diagonal of W, > 0
  /// Acceleration from all forces outside the blocks.
  virtual Status rest(double t, In q, In v, Out a) noexcept = 0;
  /// Evaluates block k at x, the values of its coordinates.
  virtual void evaluate(double t, std::size_t k, In x, Value& value) noexcept = 0;

  /// Second derivatives by the coordinates of a block.
  using Second = double[most_coordinates][most_coordinates];
  /// h += sum_r stress_r d^2 C_r/dx^2 of block k at x, a row of C each. False: the second
  /// derivatives are not known, h is as it was.
  virtual bool add_second(double /*t*/, std::size_t /*k*/, In /*x*/, In /*stress*/,
                          Second& /*h*/) noexcept {
    return false;
  }

  /// Four coordinates that are the quaternion of a frame, with norm 1 at rest.
  struct Orientation {
    std::vector<int> coordinates;  // that the energy of its blocks depends on, ascending
    std::size_t own = 0;           // place of its four among them
  };
  /// Bound of the coordinates in Orientation::coordinates.
  static constexpr int most_oriented = 18;
  /// Ordered along the body; fixed for life. Empty: no coordinates are quaternions, or
  /// there is no closed form for them.
  virtual const std::vector<Orientation>& orientations();
  /// Moves orientation k in x, given by its coordinates' values, towards its equilibrium
  /// in closed form. In equilibrium energy and friction balance at the rates (x -
  /// origin)/h, with the others held, without inertia and with norm 1. Repeated calls
  /// converge.
  virtual void orient(double /*t*/, double /*h*/, std::size_t /*k*/, In /*origin*/,
                      InOut /*x*/) noexcept {}
};

inline const std::vector<ComplianceForm::Orientation>& ComplianceForm::orientations() {
  static const std::vector<Orientation> none;
  return none;
}

}  // namespace tress
