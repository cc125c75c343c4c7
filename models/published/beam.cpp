// The Beam problem: an inextensible elastic rod (length 1 m, mass 1 kg/m, bending
// stiffness 1 N m^2) of n straight segments, clamped at one end, loaded at the free end
// by the dead force F(t) = load sin^2 t (-1, 1) N until t = pi, then free. Coordinates:
// the segments' angles theta (n, rad). With e_l = (cos, sin) theta_l, e'_l its quarter
// turn, s = 1/n, and the mass lumped at the joints (half at the tip):
//
//     r_l = s e'_l . N_l + dV/dtheta_l,   N_l = sum_{joints m >= l} mass_m z_m - F
//     z_m = s sum_{k <= m} (a_k e'_k - v_k^2 e_k)
//     V = (2 theta_1^2 + sum dtheta^2)/(2 s)
//
// M is symmetric positive definite, dense, never formed: residual and acceleration are
// sweeps, and S(w) is solved exactly with the N_l as extra unknowns, a band of
// half-width 3 in 3n. Every call is O(n). Stiff: the fastest mode has about 4 n^2 rad/s.
//
// Source: Hairer & Wanner, Solving Ordinary Differential Equations II, section IV.1 eqs.
// (1.9)-(1.23); Mazzia & Magherini, Test Set for IVP Solvers, release 2.4, problem
// "beam" (n = 40, end values at t = 5 s in references.h). Differences here: residual in
// N m (theirs times n^-3), and the sweeps above in place of the matrices C and D.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/material_points.h"
#include "contract/jacobian_choice.h"
#include "contract/system.h"
#include "math/banded_lu.h"
#include "models/entry.h"

namespace tress::models {
namespace {

struct Vec2 {
  double x = 0;
  double y = 0;

  Vec2& operator+=(Vec2 b) { return *this = {x + b.x, y + b.y}; }
};
Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
Vec2 operator*(double c, Vec2 a) { return {c * a.x, c * a.y}; }
double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
Vec2 quarter_turn(Vec2 a) { return {-a.y, a.x}; }

class Beam final : public System,
                   public ExplicitForm,
                   public Energetics,
                   public MaterialPoints {
 public:
  Beam(int segments, double load, Jacobian jacobian)
      : n_(segments),
        s_(1.0 / segments),
        load_(load),
        jacobian_(jacobian),
        axis_(size()),
        internal_(size()),
        axial_(size()),
        pivot_(size()),
        unknowns_(3 * size()),
        lu_(3 * segments, 3, 3) {}

  Layout layout() const override { return {n_, 0}; }
  Traits traits() const override {
    return {.constant_mass = false, .regular_mass = true};
  }
  void initial_state(Out q, Out v) const override {
    std::fill(q.begin(), q.end(), 0.0);
    std::fill(v.begin(), v.end(), 0.0);
  }
  void scale(Out q_typ, Out v_typ) const override {
    std::fill(q_typ.begin(), q_typ.end(), 1.0);
    std::fill(v_typ.begin(), v_typ.end(), 1.0);
  }

  Status residual(double t, In q, In v, In a, Out r) noexcept override {
    sweep_internal_forces(t, q, v, a);
    bool finite = true;
    for (int l = 0; l < n_; ++l) {
      r[l] = s_ * dot(quarter_turn(axis_[l]), internal_[l]) + spring_torque(q, l);
      finite = finite && std::isfinite(r[l]);
    }
    return finite ? Status::ok : Status::retry;
  }

  // Rows of segment l: torque balance over s^3, then the two force balances of its joints
  // differenced along the rod, ends * dN_l - dN_{l-1} - dN_{l+1} = s^2 weight_l x_l.
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    const bool exact = jacobian_ == Jacobian::exact;
    sweep_internal_forces(t, q, v, a);
    lu_.clear();
    const double bend = w.pos / (s_ * s_ * s_ * s_);  // bending stiffness over s^3
    for (int l = 0; l < n_; ++l) {
      const Vec2 e = axis_[l];
      const Vec2 turned = quarter_turn(e);
      const int row = 3 * l;
      Vec2 weight = w.acc * turned;
      double diagonal = bend * bending_diagonal(l);
      if (exact) {
        weight = (w.acc - w.pos * v[l] * v[l]) * turned -
                 (2 * v[l] * w.vel + w.pos * a[l]) * e;
        diagonal -= w.pos * dot(e, internal_[l]) / (s_ * s_);
      }
      lu_.at(row, row) = diagonal;
      lu_.at(row, row + 1) = turned.x;
      lu_.at(row, row + 2) = turned.y;
      lu_.at(row + 1, row) = -weight.x;
      lu_.at(row + 2, row) = -weight.y;
      for (const int k : {1, 2}) lu_.at(row + k, row + k) = inverse_diagonal(l);
      for (const int other : {l - 1, l + 1}) {
        if (other < 0 || other >= n_) continue;
        lu_.at(row, 3 * other) = -bend;
        for (const int k : {1, 2}) lu_.at(row + k, 3 * other + k) = -1;
      }
    }
    return lu_.factor() ? Status::ok : Status::retry;
  }

  Status solve(In b, Out x) noexcept override {
    std::fill(unknowns_.begin(), unknowns_.end(), 0.0);
    for (int l = 0; l < n_; ++l) unknowns_[3 * l] = b[l] / (s_ * s_ * s_);
    lu_.solve(unknowns_);
    for (int l = 0; l < n_; ++l) x[l] = unknowns_[3 * l];
    return Status::ok;
  }

  // Torque balance gives each N_l across its segment, (N_l . e'_l); the axial part
  // follows from the second difference of N along e, which must be the centripetal -s^2
  // v^2, and a from the same difference along e'.
  ExplicitForm* explicit_form() override { return this; }
  Status acceleration(double t, In q, In v, Out a) noexcept override {
    const Vec2 force = tip_force(t);
    const double rescale = 1 / (s_ * s_);
    for (int l = 0; l < n_; ++l) {
      axis_[l] = {std::cos(q[l]), std::sin(q[l])};
      const Vec2 turned = quarter_turn(axis_[l]);
      const double across = rescale * (dot(turned, force) - spring_torque(q, l) / s_);
      internal_[l] = across * turned;
    }
    for (int l = 0; l < n_; ++l) {
      axial_[l] = -v[l] * v[l] + dot(axis_[l], neighbours(l));
      pivot_[l] = inverse_diagonal(l);
    }
    for (int l = 1; l < n_; ++l) {
      const double ratio = dot(axis_[l], axis_[l - 1]) / pivot_[l - 1];
      pivot_[l] -= ratio * dot(axis_[l], axis_[l - 1]);
      axial_[l] += ratio * axial_[l - 1];
    }
    for (int l = n_ - 1; l >= 0; --l) {
      if (l + 1 < n_) axial_[l] += dot(axis_[l], axis_[l + 1]) * axial_[l + 1];
      axial_[l] /= pivot_[l];
    }
    for (int l = 0; l < n_; ++l) internal_[l] += axial_[l] * axis_[l];
    bool finite = true;
    for (int l = 0; l < n_; ++l) {
      const Vec2 difference = inverse_diagonal(l) * internal_[l] - neighbours(l);
      a[l] = dot(quarter_turn(axis_[l]), difference);
      finite = finite && std::isfinite(a[l]);
    }
    return finite ? Status::ok : Status::retry;
  }

  Energetics* energetics() override { return this; }
  Energy energy(double, In q, In v) override {
    Energy sum;
    Vec2 velocity;
    for (int l = 0; l < n_; ++l) {
      velocity += (s_ * v[l]) * Vec2{-std::sin(q[l]), std::cos(q[l])};
      sum.kinetic += 0.5 * joint_mass(l) * dot(velocity, velocity);
      const double turn = l > 0 ? q[l] - q[l - 1] : std::numbers::sqrt2 * q[0];
      sum.potential += 0.5 / s_ * turn * turn;
    }
    return sum;
  }
  double power(double t, In q, In v) override {
    Vec2 velocity;
    for (int l = 0; l < n_; ++l) {
      velocity += (s_ * v[l]) * Vec2{-std::sin(q[l]), std::cos(q[l])};
    }
    return dot(tip_force(t), velocity);
  }

  // The clamp and the n joints, in the plane z = 0.
  MaterialPoints* material_points() override { return this; }
  int count() const override { return n_ + 1; }
  void positions(double, In q, Out x) override {
    std::fill(x.begin(), x.end(), 0.0);
    for (int l = 0; l < n_; ++l) {
      x[3 * l + 3] = x[3 * l] + s_ * std::cos(q[l]);
      x[3 * l + 4] = x[3 * l + 1] + s_ * std::sin(q[l]);
    }
  }
  void velocities(double, In q, In v, Out u) override {
    std::fill(u.begin(), u.end(), 0.0);
    for (int l = 0; l < n_; ++l) {
      u[3 * l + 3] = u[3 * l] - s_ * v[l] * std::sin(q[l]);
      u[3 * l + 4] = u[3 * l + 1] + s_ * v[l] * std::cos(q[l]);
    }
  }

 private:
  std::size_t size() const { return static_cast<std::size_t>(n_); }
  double joint_mass(int l) const { return l + 1 < n_ ? s_ : 0.5 * s_; }

  // Diagonal of the inverse mass chain (1, 2, ..., 2, 3; n = 1: 2) and of the bending
  // stiffness (3, 2, ..., 2, 1; n = 1: 2), both with -1 beside it.
  double inverse_diagonal(int l) const { return 2.0 - (l == 0) + (l + 1 == n_); }
  double bending_diagonal(int l) const { return 2.0 + (l == 0) - (l + 1 == n_); }

  Vec2 neighbours(int l) const {
    return (l > 0 ? internal_[l - 1] : Vec2{}) + (l + 1 < n_ ? internal_[l + 1] : Vec2{});
  }

  double spring_torque(In q, int l) const {
    const double beside = (l > 0 ? q[l - 1] : 0.0) + (l + 1 < n_ ? q[l + 1] : 0.0);
    return (bending_diagonal(l) * q[l] - beside) / s_;
  }

  Vec2 tip_force(double t) const {
    if (t > std::numbers::pi) return {};
    const double size = load_ * std::sin(t) * std::sin(t);
    return {-size, size};
  }

  void sweep_internal_forces(double t, In q, In v, In a) noexcept {
    Vec2 z;
    for (int l = 0; l < n_; ++l) {
      axis_[l] = {std::cos(q[l]), std::sin(q[l])};
      z += s_ * (a[l] * quarter_turn(axis_[l]) - (v[l] * v[l]) * axis_[l]);
      internal_[l] = joint_mass(l) * z;
    }
    internal_[size() - 1] += -1.0 * tip_force(t);
    for (int l = n_ - 2; l >= 0; --l) internal_[l] += internal_[l + 1];
  }

  int n_;
  double s_;     // segment length (m)
  double load_;  // N
  Jacobian jacobian_;
  // Scratch, rewritten by each call that reads it; lu_ alone lives from linearize to
  // solve.
  std::vector<Vec2> axis_;        // (n) e_l
  std::vector<Vec2> internal_;    // (n) N_l; over s^2 in `acceleration`
  std::vector<double> axial_;     // (n) N_l . e_l over s^2
  std::vector<double> pivot_;     // (n)
  std::vector<double> unknowns_;  // (3n) x_l, dN_l over s^2
  BandedLu lu_;
};

constexpr std::array<Parameter, 3> beam_table = {
    {{.name = "segments",
      .help = "rigid segments",
      .number = 40,
      .min = 1,
      .max = 1e6,
      .whole = true},
     {.name = "load", .help = "amplitude of the force on the tip (N)", .number = 1.5},
     jacobian_parameter}};

std::unique_ptr<System> make_beam(const Parameters& p) {
  return std::make_unique<Beam>(p.whole("segments"), p.number("load"),
                                jacobian_choice(p));
}

}  // namespace

ModelEntry beam_entry() {
  return {.id = "beam",
          .summary = "n angles of inextensible segments, clamped, pushed at the tip",
          .source = "Hairer & Wanner 1996, IV.1; Test Set for IVP Solvers 2.4, beam",
          .parameters = beam_table,
          .make = make_beam};
}

}  // namespace tress::models
