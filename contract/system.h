#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contract/layers.h"
#include "contract/weights.h"

/// The contract between models (what moves) and integrators (how time advances).
///
/// A model is a mechanical system over coordinates q (n of them), q' = v, v' = a, with
/// optional position constraints g(t, q) = 0 (m of them) and multipliers lambda:
///
///     r(t, q, v, a) = M(t, q) a - f(t, q, v),      r - G^T lambda = 0,   G = dg/dq
///     S(w) = w.acc dr/da + w.vel dr/dv + w.pos dr/dq
///
/// Every implicit method is a choice of the three weights: backward Euler (1, h, h^2),
/// Newmark and generalized-alpha (1, gamma h, beta h^2), IDA (cj^2, cj, 1). So a model is
/// written once and every integrator drives it. Units are SI throughout.
namespace tress {

using In = std::span<const double>;
using Out = std::span<double>;
using InOut = std::span<double>;

/// Outcome of a call inside a step: `retry` requests a smaller step, `fatal` ends the
/// run. Values agree with SUNDIALS' 0 / +1 / -1 through `sundials_code`.
enum class [[nodiscard]] Status{ok, retry, fatal};

struct Layout {
  int coordinates = 0;  // n
  int constraints = 0;  // m
};

/// Properties that an integrator may assume; they decide which integrators apply.
struct Traits {
  bool constant_mass = false;  // dM/dt = 0 and dM/dq = 0
  bool regular_mass = true;    // M is invertible at every state
};

/// Terms included in dr/dq and dr/dv: all (full Newton), or only mass, damping and
/// elastic stiffness (semi-implicit Newton). A constructor option of models whose two
/// tangents differ.
enum class Tangent { exact, stiff };

/// Structure of a sparse matrix in compressed columns; rows ascend inside a column.
struct Pattern {
  int rows = 0;
  int cols = 0;
  std::vector<int> start;  // (cols + 1)
  std::vector<int> row;    // (start[cols])

  int nonzeros() const { return start.empty() ? 0 : start.back(); }
};

/// S(w) as a sparse matrix, for direct solvers. Required for systems with constraints.
class SparseForm {
 public:
  virtual ~SparseForm() = default;
  virtual const Pattern& pattern() const = 0;  // (n x n), fixed for the system's life
  virtual Status values(double t, In q, In v, In a, Weights w, Out s) noexcept = 0;
};

/// a = a(t, q, v) at the cost of the model's own solve of M. For unconstrained systems
/// only.
class ExplicitForm {
 public:
  virtual ~ExplicitForm() = default;
  virtual Status acceleration(double t, In q, In v, Out a) noexcept = 0;
};

/// Position constraints g(t, q) = 0 in the units of the model (lengths in m, angles in
/// rad).
class ConstraintForm {
 public:
  virtual ~ConstraintForm() = default;

  /// Pattern of G^T (n x m): column k holds the gradient of constraint k. Fixed for life.
  virtual const Pattern& pattern() const = 0;
  virtual void scale(Out g_typ) const = 0;                            // (m)
  virtual Status value(double t, In q, Out g) noexcept = 0;           // (m)
  virtual Status gradient(double t, In q, Out gt) noexcept = 0;       // G^T
  virtual Status rate(double t, In q, In v, Out g_dot) noexcept = 0;  // G v + g_t
  virtual Status bias(double t, In q, In v, Out b) noexcept = 0;      // g'' - G a
  /// (d(G v + g_t)/dq)^T on pattern(): the derivative of the rate.
  virtual Status rate_gradient(double t, In q, In v, Out values) noexcept = 0;
  /// s += factor d(G^T lambda)/dq on the pattern of the system's SparseForm.
  virtual Status add_curvature(double t, In q, In lambda, double factor,
                               InOut s) noexcept = 0;
};

class ComplianceForm;  // contract/compliance_form.h

/// Stresses of stiff strains s(q) as unknowns of Newton's method beside q, condensed
/// [Magisano, Leonetti, Garcea 2017, CMAME 313, 986, "mixed integration points"]. The
/// tangent of r = k s ds/dq has a term of second order, stress d^2 s/dq^2, with the
/// stress k s of the state at which it is evaluated. A correction that turns an edge by x
/// leaves it longer by x^2/2 of its length, so that a stiff one has a stress there that
/// the solution does not have: it makes the next correction take back the one before. The
/// stress that the linear equations themselves have found is free of that.
class StressForm {
 public:
  virtual ~StressForm() = default;
  enum class Stresses {
    held,      // those at the origin
    followed,  // with their change linear in that of q since: what a correction from the
               // origin found
  };
  /// From where the terms of second order of the next linearize() or SparseForm::values()
  /// have their stresses; all others have those of their own state, as the derivative of
  /// the residual does.
  virtual void take_stresses(double t, In q, Stresses stresses) noexcept = 0;
};

struct Energy {
  double kinetic = 0;    // J
  double potential = 0;  // J
  double total() const { return kinetic + potential; }
};

struct Momentum {
  std::array<double, 3> linear{};   // kg m/s
  std::array<double, 3> angular{};  // kg m^2/s, about the origin
};

class Energetics {
 public:
  virtual ~Energetics() = default;
  virtual Energy energy(double t, In q, In v) = 0;
  /// Empty: the model does not compute its momentum.
  virtual std::optional<Momentum> momentum(double, In, In) { return {}; }
  /// Power (W) of all forces that `energy` does not account for; negative for drag.
  virtual double power(double t, In q, In v) = 0;
};

/// Points of the body in space, for output, error norms and effects.
class MaterialPoints {
 public:
  virtual ~MaterialPoints() = default;
  virtual int count() const = 0;
  /// The point that point i is attached to, always an earlier one; -1: none.
  virtual int before(int i) const { return i - 1; }
  virtual void positions(double t, In q, Out x) = 0;         // (3 count) m
  virtual void velocities(double t, In q, In v, Out u) = 0;  // (3 count) m/s
  /// du/dv, (3 count x n) by rows. False: not known in closed form; it can be had from
  /// mean() or velocities().
  virtual bool jacobian(double /*t*/, In /*q*/, Out /*j*/) { return false; }
  /// b += J^T f, J = du/dv, of forces f (3 numbers each, N) on ascending points. False:
  /// as jacobian().
  virtual bool pull_back(double /*t*/, In /*q*/, std::span<const int> /*points*/,
                         In /*f*/, InOut /*b*/) {
    return false;
  }
  /// J S^-1 J^T of ascending points, with S as the last linearize() left it, at this t
  /// and q: 3x3 blocks by rows, those of the force on the first point, of the second ...
  /// False: to be had from jacobian() or mean() and System::solve().
  virtual bool responses(double /*t*/, In /*q*/, std::span<const int> /*points*/,
                         Out /*blocks*/) {
    return false;
  }
  /// Largest |length/rest - 1| over the segments of the body. Empty: not available.
  virtual std::optional<double> stretch(double /*t*/, In /*q*/) { return {}; }

  /// Point i as a mean of coordinates and a prescribed part,
  /// x_i = prescribed(t) + sum_k weight_k (q[c_k], q[c_k + 1], q[c_k + 2]).
  struct Mean {
    int count = 0;
    std::array<int, 4> coordinate{};  // c_k
    std::array<double, 4> weight{};
  };
  /// Fixed for life. Empty: points are not linear in the coordinates.
  virtual std::optional<Mean> mean(int /*point*/) { return {}; }

  /// Axes e0 (the tangent), e1, e2 of the section at the last point, row by row in world
  /// components; they turn with the material. Empty: the model has no such frame.
  virtual std::optional<std::array<double, 9>> end_frame(double /*t*/, In /*q*/) {
    return {};
  }
};

/// What a system remembers of the steps behind it: reference frames, contact sets.
class History {
 public:
  virtual ~History() = default;
  /// Called once after every accepted step; may move frames or contact sets and adjust
  /// the state to them. True: the equations changed, multistep methods must restart.
  virtual bool accept(double t, InOut q, InOut v) = 0;
  /// Discards the effects of every accept(): coordinates regain the meaning that they
  /// have in initial_state().
  virtual void reset() = 0;
  /// All that accept() has changed since reset(). recall() restores it in an identically
  /// constructed system, which then continues as this one would.
  virtual std::vector<double> memory() const = 0;
  virtual void recall(In memory) = 0;
};

/// The laws of rigid contact linear about a state, for methods that solve for a state and
/// the forces of contact at once [Josephy 1979]: the velocities of contacts respond
/// linearly to their forces, which obey the laws exactly. Vectors have three entries per
/// contact: along its normal, and two tangents.
class Complementarity {
 public:
  virtual ~Complementarity() = default;
  /// Takes the contacts that hold forces or overlap at one of two states, of which the
  /// first is the one that all below is linear about. Their forces are constants from
  /// here to let_go(), those that they held at first. Their number.
  virtual std::size_t take(double t, In q, In v, In q_next, In v_next) noexcept = 0;
  virtual void forces(Out f) const noexcept = 0;  // N
  /// None that pulls.
  virtual void set_forces(In f) noexcept = 0;
  /// What the laws are about, m/s: gaps over the time that closes them, or the excess
  /// over the speed of a rebound, and velocities along the surface.
  virtual void velocities(double t, In q, In v, Out u) noexcept = 0;
  /// By how much a change of v changes the contacts' velocities.
  virtual void responses(In dv, Out du) noexcept = 0;
  /// Forces that obey the laws where contacts have the velocities u + W (f - f_given); W
  /// by columns. By how much they violate them, m/s.
  virtual double balance(In w, In u, double tolerance, InOut f) noexcept = 0;
  /// Penalties act again; unless the forces were found, multipliers are those of before.
  virtual void let_go(bool found) noexcept = 0;
};

/// Contact forces that obey the laws of Signorini and Coulomb without regularisation.
/// Each is given by a multiplier, a penalty and the state, so that the equations are
/// functions of the state as ever; the multipliers at which the law holds are found by
/// solving the equations and improving the multipliers in turn (augmented Lagrangian).
/// The law is that of the state at which the equations are solved: methods use it at
/// states that are ends of steps or stages.
///
/// Friction acts against the slide U = X', where X are the places of points in the frames
/// of the bodies. A method integrates X as it integrates q: its stage has X = x0 + tau U
/// with x0 of its own formula, so that what sticks stays where it is, however the body
/// turns.
class ContactForm {
 public:
  virtual ~ContactForm() = default;
  /// Before the equations of a state that lies `tau` (s) ahead are solved: q = q0 + tau
  /// v, where q0 and v0 are the state from which the motion goes on, and X = x0 + tau U.
  virtual void begin(double t, double tau, In q0, In v0, In x0) noexcept = 0;
  /// After they are solved, at the solution: takes the forces found as the multipliers.
  /// The largest speed (m/s) by which the solution violates the law.
  virtual double improve(double t, In q, In v) noexcept = 0;
  /// The largest T.U/(mu N) of the forces and slides that improve() took, m/s: friction
  /// does work on a slide where it is positive.
  virtual double drive() const noexcept = 0;
  /// Before they are solved again: multipliers farther along the way that improvements
  /// have taken.
  virtual void extrapolate() noexcept = 0;
  /// Largest speed (m/s) at which points whose rigid contact is closed approach their
  /// surface: where it is not 0 velocities jump, and forces are an impulse over tau.
  virtual double approach(double t, In q, In v) noexcept = 0;
  /// After an impact: the contacts stay closed, without the forces of the impulse.
  virtual void release() noexcept = 0;
  /// Whether points may rebound: v0 must then be the velocity before the impact.
  virtual bool rebounds() const = 0;
  /// Null: some contact is not rigid, or the laws are not known in this form.
  virtual Complementarity* complementarity() { return nullptr; }
  /// The multipliers, of fixed number; 0 at first.
  virtual std::vector<double> multipliers() const = 0;
  virtual void set_multipliers(In values) = 0;
  /// Returns the number of coordinates X; fixed for life.
  virtual std::size_t tracked() const = 0;
  /// X, m.
  virtual void places(double t, In q, In v, Out x) noexcept = 0;
  /// U of the last solution where it has closed contacts, that of v elsewhere; m/s.
  virtual void slides(double t, In q, In v, Out u) noexcept = 0;
};

/// One mechanical system. `residual` is pure; `linearize` prepares `solve`; nothing
/// allocates after the first call of each; only History::accept, ContactForm and
/// StressForm may change what it remembers.
class System {
 public:
  virtual ~System() = default;

  virtual Layout layout() const = 0;
  virtual Traits traits() const = 0;
  virtual void initial_state(Out q,
                             Out v) const = 0;  // satisfies g = 0 and G v + g_t = 0
  virtual void scale(Out q_typ, Out v_typ) const = 0;  // typical sizes, > 0; angles <= 1
  virtual Status residual(double t, In q, In v, In a, Out r) noexcept = 0;
  virtual Status linearize(double t, In q, In v, In a, Weights w) noexcept = 0;
  virtual Status solve(In b, Out x) noexcept = 0;  // S(w) x = b; b and x may be the same

  /// The first time after t at which the equations are not smooth in time (a prescribed
  /// motion stops, a force is switched); methods that rely on smoothness end a step
  /// there. Infinity: none.
  virtual double next_breakpoint(double /*t*/) const {
    return std::numeric_limits<double>::infinity();
  }

  /// Names the term of r(t, q, v, 0) that is not finite and its location: "quadratic_drag
  /// at point 7". Empty: all terms are finite, or the model does not report it.
  virtual std::string not_finite(double /*t*/, In /*q*/, In /*v*/) { return {}; }

  // Optional forms, null when absent; queried once.
  virtual SparseForm* sparse_form() { return nullptr; }
  virtual ExplicitForm* explicit_form() { return nullptr; }
  virtual ConstraintForm* constraint_form() { return nullptr; }
  virtual ComplianceForm* compliance_form() { return nullptr; }
  virtual StressForm* stress_form() { return nullptr; }
  virtual Energetics* energetics() { return nullptr; }
  virtual MaterialPoints* material_points() { return nullptr; }
  virtual History* history() { return nullptr; }
  virtual ContactForm* contact_form() { return nullptr; }

  // Of the history and of the multipliers of contacts, where there are any.
  bool accept(double t, InOut q, InOut v) {
    return history() != nullptr && history()->accept(t, q, v);
  }
  void reset() {
    if (history() != nullptr) history()->reset();
    if (contact_form() == nullptr) return;
    const std::vector<double> none(contact_form()->multipliers().size());
    contact_form()->set_multipliers(none);
  }
  std::vector<double> memory() {
    auto all = history() == nullptr ? std::vector<double>{} : history()->memory();
    if (contact_form() == nullptr) return all;
    const std::vector<double> multipliers = contact_form()->multipliers();
    all.insert(all.end(), multipliers.begin(), multipliers.end());
    return all;
  }
  void recall(In memory) {
    const std::size_t multipliers =
        contact_form() == nullptr ? 0 : contact_form()->multipliers().size();
    const std::size_t of_history = memory.size() - multipliers;
    if (history() != nullptr) history()->recall(memory.first(of_history));
    if (multipliers > 0) contact_form()->set_multipliers(memory.last(multipliers));
  }
};

}  // namespace tress
