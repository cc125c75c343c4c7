// Wheelset on a straight track: a rigid axle with two conical wheels, each of which
// touches a rail of circular profile in one point and creeps over it. It starts off the
// centre and swings from side to side (hunting).
//
// The published problem has 17 unknowns and index 2: the position p = (x, y, z, theta,
// phi) and its rates, the rotation beta about the axle beyond rolling, and algebraic
// unknowns: in each contact the angle psi and the distance xi of the touching point, and
// the contact force lambda. Contacts are held as velocities, G(p, xi, psi) p' = 0.
// Friction depends on lambda through the normal forces, so that no ConstraintForm fits.
//
// Unknowns of order one or zero are velocities here, v = (p', beta, psi_l, xi_l, psi_r,
// xi_r, lambda_l, lambda_r), n = 12, and q = (p, integrals of the others), on which
// nothing depends. The last six rows have no accelerations: M is singular, S(w) is not.
//
//     M(p) (p'', beta') = f(p, p', beta, psi, xi, lambda)
//     0 = g(p, psi, xi)     (4 rows: normals are parallel)
//     0 = G p'              (2 rows)
//
// Units: m, rad, s, N. Left is the wheel at xi > 0, right the other. The printed start
// has five digits of lambda, which implicit methods replace in the first step. The error
// test of `ida` sees this change: it starts at loose tolerances only.
//
// Source: B. Simeon, C. Fuehrer, P. Rentrop, Introduction to differential-algebraic
// equations in vehicle system dynamics, Surv. Math. Ind. 1 (1991) 1-37; Mazzia &
// Magherini, Test Set for IVP Solvers, release 2.4, problem "wheel", equations as in its
// program (R package deTestSet of bvpSolve at R-Forge, commit d154b114 of its mirror,
// src/Ex_wheelset.f), with the terms of a straight track and no propulsion. Differences
// here: lambda in N, not 1e4 N.
#include <algorithm>
#include <array>
#include <cmath>

#include "models/entry.h"
#include "models/published/dense_system.h"

namespace tress::models {
namespace {

enum Coordinate {
  across,   // x (m)
  upward,   // y (m)
  forward,  // z (m), beyond the motion at `speed`
  yaw,      // theta (rad)
  roll,     // phi (rad)
  spin,     // beta (rad/s)
  psi_left,
  xi_left,
  psi_right,
  xi_right,
  lambda_left,
  lambda_right,
  coordinates
};

// Data of the Test Set (SI). Its program truncates pi.
constexpr double pi = 3.1415926;
constexpr double mass = 16.08;                      // m_R (kg)
constexpr double axial = .0605, lateral = .366;     // I_1 = I_3, about the axle; I_2
constexpr double gravity = 9.81, speed = 30;        // v_0 (m/s)
constexpr double radius = .1;                       // r_N0 (m)
constexpr double friction = .12;                    // mu
constexpr double spring_arm = .19;                  // x_l (m)
constexpr double spring_x = 6400, spring_z = 6400;  // c_x, c_z (N/m)
constexpr double cone = .0262;                      // delta_0 (rad)
constexpr double half_gauge = .1506, rail = .06;    // a_R, r_S (m)
// Hertz's ellipse and Kalker's coefficients of creep.
constexpr double e_hertz = 1.3537956, g_hertz = .7115218;
constexpr double poisson = .28, shear_modulus = 7.92e10;  // sigma, G (Pa)
constexpr double c11 = 4.72772197, c22 = 4.27526987, c23 = 1.97203505;
constexpr double omega = speed / radius;  // rolling (rad/s)

enum class Side { left, right };

double number(double x) { return x; }
double saturated(double x) { return std::tanh(x); }
double cube_root(double x) { return std::cbrt(x); }

template <int n>
double number(const Dual<n>& x) {
  return x.value;
}
/// tanh.
template <int n>
Dual<n> saturated(const Dual<n>& x) {
  const double y = std::tanh(x.value);
  return x.chain(y, 1 - y * y);
}
template <int n>
Dual<n> cube_root(const Dual<n>& x) {
  const double root = std::cbrt(x.value);
  return x.chain(root, 1 / (3 * root * root));
}
template <class T>
T magnitude(const T& x) {
  return number(x) < 0 ? -x : x;
}

template <class T>
struct Trig {
  explicit Trig(const T& angle) {
    using std::cos, std::sin;
    s = sin(angle);
    c = cos(angle);
  }
  T s, c;
};

/// One contact: geometry, row of G, and the creep force with its moments.
template <class T>
struct Contact {
  Contact(Side side, const T* q, const T& psi_value, const T& xi_value)
      : sign(side == Side::left ? -1 : 1),
        theta_value(q[yaw]),
        theta(q[yaw]),
        phi(q[roll]),
        psi(psi_value),
        xi(xi_value) {
    using std::atan2, std::sqrt;
    const double outward = side == Side::left ? 1 : -1;  // sign of xi
    r_1 = -outward * std::tan(cone);
    r = radius + std::tan(cone) * half_gauge + r_1 * xi;
    const T at = q[across] + xi * theta.c * phi.c +
                 r * (theta.c * phi.s * psi.c - theta.s * psi.s);
    const T from = outward * at - half_gauge - std::sin(cone) * rail;
    const T height = sqrt(rail * rail - from * from);
    rail_1 = -outward * from / height;
    rail_2 = -rail * rail / (height * height * height);
    row = {rail_1, T(-1.0), T(0.0),
           rail_1 *
               (-r * (theta.c * psi.s + psi.c * phi.s * theta.s) - phi.c * theta.s * xi),
           -psi.c * r * phi.s - phi.c * xi +
               rail_1 * (phi.c * psi.c * theta.c * r - theta.c * phi.s * xi)};
    const T down = r_1 * phi.s + psi.c * phi.c;
    const T aside = (r_1 * phi.c - phi.s * psi.c) * theta.c + psi.s * theta.s;
    inclination = atan2(sign * aside, down);
    parallel = {
        rail_1 * down + r_1 * theta.c * phi.c - theta.c * phi.s * psi.c + theta.s * psi.s,
        r_1 * theta.s * phi.c - theta.s * phi.s * psi.c - theta.c * psi.s};
  }

  /// Sets the creep force by the normal force (N) and the velocities.
  void creep(const T& normal, const T* v) {
    using std::sqrt;
    const Trig<T> delta(inclination);
    const Trig<T> turn(theta_value / delta.c);
    const double slope = std::sqrt(1 + r_1 * r_1);
    const T flat = 1 + rail_1 * rail_1;
    const T curvatures = .5 / (r * slope) - .5 * rail_2 / (flat * sqrt(flat));
    const T ellipse =
        cube_root(3 * (1 - poisson) * e_hertz * magnitude(normal) /
                  (2 * pi * shear_modulus * std::sqrt(g_hertz) * curvatures));
    // Velocity over the rail, and that of rolling.
    const T rolling = omega + v[spin];
    const T arm = xi * phi.s - r * phi.c * psi.c;
    const T k1 =
        -rolling * r * (turn.s * psi.c + turn.c * phi.s * psi.s) + v[across] -
        v[yaw] * (r * (turn.s * phi.s * psi.c + turn.c * psi.s) + xi * turn.s * phi.c) -
        v[roll] * turn.c * arm;
    const T k2 = rolling * r * phi.c * psi.s + v[upward] +
                 v[roll] * (xi * phi.c + r * phi.s * psi.c);
    const T k3 =
        -rolling * r * (turn.c * psi.c - turn.s * phi.s * psi.s) + speed + v[forward] -
        v[yaw] * (xi * turn.c * phi.c + r * (turn.c * phi.s * psi.c - turn.s * psi.s)) +
        v[roll] * turn.s * arm;
    const T k4 = k1 - 2 * v[across], k5 = k2 - 2 * v[upward],
            k6 = k3 - 2 * v[forward] - 2 * speed;
    const T rate = .5 * sqrt(k4 * k4 + k5 * k5 + k6 * k6);
    const T along = (turn.s * k1 + turn.c * k3) / rate;
    const T aside =
        (turn.c * delta.c * k1 - sign * delta.s * k2 - turn.s * delta.c * k3) / rate;
    const T bore = (sign * delta.s * rolling + delta.c * v[yaw]) / rate;

    const T limit = friction * normal;
    const T size = shear_modulus * ellipse * ellipse / limit;
    T tx = -limit * saturated(size * c11 * along);
    T ty = -limit * saturated(size * (c22 * aside + c23 * ellipse * bore));
    const T square = tx * tx + ty * ty;
    if (number(square) > number(limit * limit)) {
      const T shrunk = magnitude(limit) / sqrt(square);
      tx = shrunk * tx;
      ty = shrunk * ty;
    }
    force = {turn.s * tx + turn.c * delta.c * ty, -sign * delta.s * ty,
             turn.c * tx - turn.s * delta.c * ty};
  }

  /// Moments of the creep force in the rows of yaw, roll and spin.
  std::array<T, 3> moments() const {
    const auto& [f1, f2, f3] = force;
    return {-(xi * theta.s + r * psi.s * theta.c * phi.c) * f1 - r * psi.s * phi.s * f2 +
                (-xi * theta.c + r * psi.s * theta.s * phi.c) * f3,
            -theta.c * (xi * phi.s - r * psi.c * phi.c) * f1 +
                (xi * phi.c + r * psi.c * phi.s) * f2 +
                theta.s * (xi * phi.s - r * psi.c * phi.c) * f3,
            -r * (psi.c * theta.s + psi.s * theta.c * phi.s) * f1 +
                r * psi.s * phi.c * f2 -
                r * (psi.c * theta.c - psi.s * theta.s * phi.s) * f3};
  }

  double sign, r_1;  // -1 left, 1 right; slope of the wheel
  T theta_value;
  Trig<T> theta, phi, psi;
  T xi, r, rail_1, rail_2;    // of the wheel's profile; slope and curvature of the rail
  T inclination;              // delta
  std::array<T, 5> row;       // of G
  std::array<T, 2> parallel;  // g
  std::array<T, 3> force{};   // of creep (N)
};

struct RollingAxle {
  template <class T>
  void residual(double, const T* q, const T* v, const T* a, T* r) const {
    const Trig<T> phi(q[roll]);
    Contact<T> left(Side::left, q, v[psi_left], v[xi_left]);
    Contact<T> right(Side::right, q, v[psi_right], v[xi_right]);
    std::array<T, 5> push;
    for (std::size_t i = 0; i < push.size(); ++i) {
      push[i] = left.row[i] * v[lambda_left] + right.row[i] * v[lambda_right];
    }
    const Trig<T> to_left(left.inclination), to_right(right.inclination);
    const T determinant = -to_left.s * to_right.c - to_right.s * to_left.c;
    left.creep((to_right.c * push[0] - to_right.s * push[1]) / determinant, v);
    right.creep((-to_left.c * push[0] - to_left.s * push[1]) / determinant, v);
    const auto of_left = left.moments(), of_right = right.moments();

    for (int i = across; i <= forward; ++i) {
      const auto k = static_cast<std::size_t>(i);
      r[i] = mass * a[i] - left.force[k] - right.force[k] - push[k];
    }
    r[across] += 2 * spring_x * q[across];
    r[upward] += mass * gravity;
    r[forward] += 2 * spring_z * q[forward];
    const T rolling = omega + v[spin];
    const T rotation = v[yaw] * phi.s;
    const T suspension = -2 * spring_arm * spring_arm * spring_z * q[yaw];
    r[yaw] = lateral * (phi.c * a[yaw] - rotation * v[roll]) + axial * rolling * v[roll] +
             (axial - lateral) * rotation * v[roll] - of_left[0] - of_right[0] -
             phi.c * suspension - push[3];
    r[roll] = lateral * a[roll] - axial * rolling * v[yaw] * phi.c -
              (axial - lateral) * rotation * v[yaw] * phi.c - of_left[1] - of_right[1] -
              push[4];
    r[spin] = axial * (phi.s * a[yaw] + a[spin] + v[yaw] * v[roll] * phi.c) - of_left[2] -
              of_right[2] - phi.s * suspension;
    r[psi_left] = left.parallel[0];
    r[xi_left] = left.parallel[1];
    r[psi_right] = right.parallel[0];
    r[xi_right] = right.parallel[1];
    r[lambda_left] = r[lambda_right] = T(0.0);
    for (std::size_t i = 0; i < push.size(); ++i) {
      r[lambda_left] += left.row[i] * v[i];
      r[lambda_right] += right.row[i] * v[i];
    }
  }
};

class Wheelset final : public DenseSystem<coordinates, RollingAxle> {
 public:
  Wheelset() : DenseSystem(RollingAxle{}) {}

  Traits traits() const override {
    return {.constant_mass = false, .regular_mass = false};
  }
  void initial_state(Out q, Out v) const override {
    constexpr std::array<double, 5> start = {.14941e-2, .40089e-6, .11241e-5, -.28573e-3,
                                             .26459e-3};
    // psi_l, xi_l, psi_r, xi_r, lambda_l, lambda_r
    constexpr std::array<double, 6> touching = {
        7.5634406395172940e-6, .1490635714733819, -7.4122380357667139e-6,
        -.1521364296121248,    -83.593,           -74.144};
    std::ranges::fill(q, 0.0);
    std::ranges::fill(v, 0.0);
    std::ranges::copy(start, q.begin());
    std::ranges::copy(touching, v.begin() + psi_left);
  }
  void scale(Out q_typ, Out v_typ) const override {
    // Sizes seen over the published run; of xi what it changes by. Integrals: over 1 s.
    constexpr std::array<double, coordinates> size = {.01,  1e-4, 1e-4, .02, 2e-3, .3,
                                                      1e-3, .01,  1e-3, .01, 30,   30};
    constexpr std::array<double, coordinates> rate = {.2,   1e-3, 5e-3, .5,  .05, .5,
                                                      1e-3, .01,  1e-3, .01, 30,  30};
    std::ranges::copy(size, q_typ.begin());
    std::ranges::copy(rate, v_typ.begin());
  }
};

std::unique_ptr<System> make_wheelset(const Parameters&) {
  return std::make_unique<Wheelset>();
}

}  // namespace

ModelEntry wheelset_entry() {
  return {.id = "wheelset",
          .summary = "axle on two rails, contacts as velocity constraints, index 2",
          .source = "Simeon et al. 1991; Test Set for IVP Solvers 2.4, wheel",
          .parameters = {},
          .make = make_wheelset};
}

}  // namespace tress::models
