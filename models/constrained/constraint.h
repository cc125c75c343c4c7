#pragma once

#include <array>
#include <memory>
#include <span>

#include "contract/basics.h"

namespace tress::models {

/// Object to which a constraint is attached: a particle (3 coordinates), a massless
/// parameter (1 coordinate) or an anchor (3 numbers prescribed in time, no coordinates).
struct Node {
  /// Kinds of nodes, as above: `particle`, `parameter` or `anchor`.
  enum class Kind { particle, parameter, anchor };
  Kind kind = Kind::particle;  // what the node is
  int index = 0;               // index among the nodes of its kind

  /// Returns the number of its coordinates, or of its prescribed numbers.
  int size() const { return kind == Kind::parameter ? 1 : 3; }
  friend bool operator==(const Node&, const Node&) = default;
};

/// Bound of Constraint::inputs().
inline constexpr int max_constraint_inputs = 9;
/// Bound of Constraint::rows().
inline constexpr int max_constraint_rows = 3;

/// One modular, local constraint C(z) = 0; z holds the coordinates of its nodes, in their
/// order. These three functions provide all that the assembly (constraint_set.h) needs:
///
///     C' = (dC/dz) z',   C'' - G a = z'^T H z' + (dC/dz) p'',   dC'/dz = H z',
///
/// with H the second derivatives. Time enters only through anchors p(t), which are part
/// of z, so modules have no explicit time dependence. Pure, no allocation. [Witkin 1997]
/// A. Witkin, Physically Based Modeling: Constrained Dynamics, SIGGRAPH course notes,
/// section 4.
class Constraint {
 public:
  virtual ~Constraint() = default;
  /// Returns the nodes whose coordinates are z.
  virtual std::span<const Node> nodes() const = 0;
  virtual int inputs() const = 0;   // numbers in z
  virtual int rows() const = 0;     // 1 to 3
  virtual bool linear() const = 0;  // H = 0: hessian() is not called
  /// Typical size of C (m, or rad) in a scene of the given extent (m).
  virtual double scale(double extent) const = 0;
  /// Evaluates the constraint, (rows).
  virtual void value(In z, Out c) const noexcept = 0;
  /// Evaluates the gradient, (rows x inputs).
  virtual void gradient(In z, Out g) const noexcept = 0;
  /// Evaluates the second derivative sum_k w_k H_k, (inputs x inputs).
  virtual void hessian(In z, In w, Out h) const noexcept = 0;
};

/// Constraints of a system.
using Constraints = std::vector<std::unique_ptr<const Constraint>>;

/// Constraint made from a kernel: a small struct with `node_count`, `inputs`, `rows`,
/// `linear` and scale(extent). It also has value(z, c) (a template on the scalar), and
/// gradient(z, g) and hessian(z, w, h) on plain arrays. Matrices are row-major.
template <class Kernel>
class Module final : public Constraint {
 public:
  /// Attaches a kernel to nodes.
  Module(std::array<Node, Kernel::node_count> nodes, Kernel kernel)
      : nodes_(nodes), kernel_(std::move(kernel)) {
    static_assert(Kernel::inputs <= max_constraint_inputs);
    static_assert(Kernel::rows <= max_constraint_rows);
  }

  std::span<const Node> nodes() const override { return nodes_; }
  int inputs() const override { return Kernel::inputs; }
  int rows() const override { return Kernel::rows; }
  bool linear() const override { return Kernel::linear; }
  double scale(double extent) const override { return kernel_.scale(extent); }
  void value(In z, Out c) const noexcept override { kernel_.value(z.data(), c.data()); }
  void gradient(In z, Out g) const noexcept override {
    kernel_.gradient(z.data(), g.data());
  }
  void hessian(In z, In w, Out h) const noexcept override {
    kernel_.hessian(z.data(), w.data(), h.data());
  }

 private:
  std::array<Node, Kernel::node_count> nodes_;
  Kernel kernel_;
};

/// A two-point kernel made from a kernel of d = x - origin.
template <class Inner>
struct Difference {
  static constexpr int node_count = 2;           // number of nodes
  static constexpr int inputs = 6;               // length of z
  static constexpr int rows = Inner::rows;       // length of C
  static constexpr bool linear = Inner::linear;  // whether H = 0

  Inner inner;  // kernel of the difference

  /// Returns the typical size of C in a scene of the given extent (m).
  double scale(double extent) const { return inner.scale(extent); }

  /// Evaluates C at z.
  template <class T>
  void value(const T* z, T* c) const {
    const T d[3] = {z[0] - z[3], z[1] - z[4], z[2] - z[5]};
    inner.value(d, c);
  }

  /// Evaluates the first derivatives of C, row by row.
  void gradient(const double* z, double* g) const {
    const double d[3] = {z[0] - z[3], z[1] - z[4], z[2] - z[5]};
    double local[3 * rows];
    inner.gradient(d, local);
    for (int k = 0; k < rows; ++k) {
      for (int i = 0; i < 3; ++i) {
        g[6 * k + i] = local[3 * k + i];
        g[6 * k + 3 + i] = -local[3 * k + i];
      }
    }
  }

  /// Evaluates the second derivatives of w . C, row by row.
  void hessian(const double* z, const double* w, double* h) const {
    const double d[3] = {z[0] - z[3], z[1] - z[4], z[2] - z[5]};
    double local[9];
    inner.hessian(d, w, local);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        h[6 * i + j] = h[6 * (i + 3) + j + 3] = local[3 * i + j];
        h[6 * (i + 3) + j] = h[6 * i + j + 3] = -local[3 * i + j];
      }
    }
  }
};

}  // namespace tress::models
