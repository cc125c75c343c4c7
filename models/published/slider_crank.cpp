// Slider crank whose connecting rod is flexible: crank driven at constant angular
// velocity, rod with two lateral sine modes and two longitudinal quadratic modes,
// sliding block.
//
//     M(q) a - f(q, v) - G(q)^T lambda = 0,   g(t, q) = 0,   n = 7, m = 3
//
// q = (phi_1, phi_2 in rad, x_3 in m, q_1..q_4 elastic, m); g = (crank and rod end on
// the slide's axis, block at the rod's end, both in m; phi_1 = Omega t, in rad). The
// rod's end moves with q_4, so the first two constraints carry it. lambda has the
// opposite sign to the Test Set's. No damping, no gravity, linear elasticity: the Test
// Set's default, to which its end values at t = 0.1 s belong (references.h).
// `start = rigid` is its second start, on the rigid motion, which makes the rod ring.
//
// Source: B. Simeon, Modelling a flexible slider crank mechanism by a mixed system of
// DAEs and PDEs, Math. Modelling of Systems 2 (1996) 1-18; Mazzia & Magherini, Test Set
// for IVP Solvers, release 2.4, problem "crank". Difference here: block position and
// velocities are completed from the constraints, which the nine printed digits satisfy
// only to 1e-9.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "contract/forms/constraint_form.h"
#include "contract/jacobian_choice.h"
#include "models/entry.h"
#include "models/published/dense_system.h"

namespace tress::models {
namespace {

constexpr int modes = 4;
enum Coordinate { crank, rod, block, elastic_0, tip = elastic_0 + 3, coordinates };

// Data of the Test Set, problem "crank" (SI). Its program truncates pi to 3.1415927, but
// its end values were computed with pi: only then do the printed end accelerations follow
// from the end state (13 digits; with truncated pi the lateral ones match 3 to 6).
using std::numbers::pi;
constexpr double m2 = 0.151104, m3 = 0.075552;      // rod, block (kg)
constexpr double l1 = 0.15, l2 = 0.30;              // crank, rod (m)
constexpr double j1 = 0.002727, j2 = 0.0045339259;  // crank, rod (kg m^2)
constexpr double youngs_modulus = 0.20e12;          // Pa
constexpr double width = 0.0080, height = 0.0080;   // of the rod (m)
constexpr double density = 7870;                    // kg/m^3
constexpr double drive_rate = 150;                  // Omega (rad/s)

using Row = std::array<double, modes>;
constexpr double volume = width * height * l2;
constexpr double rod_mass = density * volume;
constexpr double axial = youngs_modulus * width * height / l2;  // N/m
constexpr double pi3 = pi * pi * pi;
constexpr double slender = height * height / (l2 * l2) * pi3 * pi;

// Elastic mass. The longitudinal block is printed without the 1/15 of the quadratic
// elements; it is part of the published problem.
constexpr std::array<Row, modes> mass = {{{rod_mass * .5, 0, 0, 0},
                                          {0, rod_mass * .5, 0, 0},
                                          {0, 0, rod_mass * 8, rod_mass},
                                          {0, 0, rod_mass, rod_mass * 2}}};
constexpr std::array<Row, modes> stiffness = {{{axial * slender / 24, 0, 0, 0},
                                               {0, axial* slender * 2 / 3, 0, 0},
                                               {0, 0, axial * 16 / 3, -axial * 8 / 3},
                                               {0, 0, -axial * 8 / 3, axial * 7 / 3}}};
// Gyroscopic coupling of lateral and longitudinal modes, antisymmetric (m^3).
constexpr double b13 = -volume * 16 / pi3, b14 = volume * (8 / pi3 - 1 / pi),
                 b24 = volume * .5 / pi;
constexpr std::array<Row, modes> gyroscopic = {
    {{0, 0, b13, b14}, {0, 0, 0, b24}, {-b13, 0, 0, 0}, {-b14, -b24, 0, 0}}};
constexpr Row c1 = {0, 0, volume * 2 / 3, volume / 6};
constexpr Row c2 = {volume * 2 / pi, 0, 0, 0};
constexpr Row c12 = {0, 0, l2* volume / 3, l2* volume / 6};
constexpr Row c21 = {l2 * volume / pi, -l2* volume * .5 / pi, 0, 0};

template <class T>
T dot(const Row& c, const T* x) {
  return c[0] * x[0] + c[1] * x[1] + c[2] * x[2] + c[3] * x[3];
}

struct CrankWithFlexibleRod {
  template <class Q, class X>
  void inertia(const Q* q, const X* x, X* r) const {
    using std::cos, std::sin;
    const Q* e = q + elastic_0;
    const X* y = x + elastic_0;
    const Q c = cos(q[crank] - q[rod]);
    const Q s = sin(q[crank] - q[rod]);
    const Q cross = (.5 * l1 * l2 * m2 + density * l1 * dot(c1, e)) * c +
                    density * l1 * dot(c2, e) * s;
    Q rod_inertia = j2 + 2 * density * dot(c12, e);
    for (int i = 0; i < modes; ++i) rod_inertia += e[i] * dot(mass[i], e);

    r[crank] = (j1 + m2 * l1 * l1) * x[crank] + cross * x[rod];
    r[rod] = cross * x[crank] + rod_inertia * x[rod];
    r[block] = m3 * x[block];
    for (int i = 0; i < modes; ++i) {
      const Q by_crank = density * l1 * (c2[i] * c - c1[i] * s);
      const Q by_rod = density * (c21[i] - dot(gyroscopic[i], e));
      r[crank] += by_crank * y[i];
      r[rod] += by_rod * y[i];
      r[elastic_0 + i] = by_crank * x[crank] + by_rod * x[rod] + dot(mass[i], y);
    }
  }

  template <class T>
  void elastic(const T* q, T* r) const {
    for (int i = 0; i < modes; ++i) r[elastic_0 + i] += dot(stiffness[i], q + elastic_0);
  }

  // Test Set, problem "crank", eq. of f^e and Gamma, without gravity.
  template <class T>
  void residual(double, const T* q, const T* v, const T* a, T* r) const {
    using std::cos, std::sin;
    const T* e = q + elastic_0;
    const T* e_dot = v + elastic_0;
    const T c = cos(q[crank] - q[rod]);
    const T s = sin(q[crank] - q[rod]);
    const T spin1 = v[crank] * v[crank];
    const T spin2 = v[rod] * v[rod];
    const T lever = (.5 * l1 * l2 * m2 + density * l1 * dot(c1, e)) * s -
                    density * l1 * dot(c2, e) * c;
    T growth = density * dot(c12, e_dot);  // half the rate of the rod's inertia
    for (int i = 0; i < modes; ++i) growth += e_dot[i] * dot(mass[i], e);

    inertia(q, a, r);
    r[crank] += spin2 * lever +
                2 * density * l1 * v[rod] * (c * dot(c1, e_dot) + s * dot(c2, e_dot));
    r[rod] += 2 * v[rod] * growth - spin1 * lever;
    for (int i = 0; i < modes; ++i) {
      r[elastic_0 + i] -= spin2 * (dot(mass[i], e) + density * c12[i]) +
                          density * (l1 * spin1 * (c1[i] * c + c2[i] * s) +
                                     2 * v[rod] * dot(gyroscopic[i], e_dot));
    }
    elastic(q, r);
  }
};

// g = (l1 sin phi_1 + (l2 + q_4) sin phi_2, x_3 - l1 cos phi_1 - (l2 + q_4) cos phi_2,
//      phi_1 - Omega t).
class SlideAndDrive final : public ConstraintForm {
 public:
  const Pattern& pattern() const override { return pattern_; }
  void scale(Out g_typ) const override {
    g_typ[0] = g_typ[1] = l2;
    g_typ[2] = 1;
  }
  Status value(double t, In q, Out g) noexcept override {
    const double reach = l2 + q[tip];
    g[0] = l1 * std::sin(q[crank]) + reach * std::sin(q[rod]);
    g[1] = q[block] - l1 * std::cos(q[crank]) - reach * std::cos(q[rod]);
    g[2] = q[crank] - drive_rate * t;
    return Status::ok;
  }
  Status gradient(double, In q, Out gt) noexcept override {
    const double reach = l2 + q[tip];
    const std::array<double, entries> values = {
        l1 * std::cos(q[crank]),  reach * std::cos(q[rod]),
        std::sin(q[rod]),         l1 * std::sin(q[crank]),
        reach * std::sin(q[rod]), 1,
        -std::cos(q[rod]),        1};
    std::copy(values.begin(), values.end(), gt.begin());
    return Status::ok;
  }
  Status rate(double t, In q, In v, Out g_dot) noexcept override {
    std::array<double, entries> gt;
    const Status status = gradient(t, q, gt);
    apply(gt, v, g_dot);
    g_dot[2] -= drive_rate;
    return status;
  }
  // The constraints are free of second derivatives in time, so g'' - G a = (G') v.
  Status bias(double t, In q, In v, Out b) noexcept override {
    std::array<double, entries> gt_dot;
    const Status status = rate_gradient(t, q, v, gt_dot);
    apply(gt_dot, v, b);
    return status;
  }
  Status rate_gradient(double, In q, In v, Out values) noexcept override {
    const double reach = l2 + q[tip];
    const double c = std::cos(q[rod]), s = std::sin(q[rod]);
    const std::array<double, entries> turned = {-l1 * std::sin(q[crank]) * v[crank],
                                                v[tip] * c - reach * s * v[rod],
                                                c * v[rod],
                                                l1 * std::cos(q[crank]) * v[crank],
                                                v[tip] * s + reach * c * v[rod],
                                                0,
                                                s * v[rod],
                                                0};
    std::copy(turned.begin(), turned.end(), values.begin());
    return Status::ok;
  }
  Status add_curvature(double, In q, In lambda, double factor,
                       InOut s) noexcept override {
    const double reach = l2 + q[tip];
    const double c = std::cos(q[rod]), sn = std::sin(q[rod]);
    const auto entry = [&](int i, int j) -> double& { return s[coordinates * j + i]; };
    entry(crank, crank) +=
        factor * l1 * (lambda[1] * std::cos(q[crank]) - lambda[0] * std::sin(q[crank]));
    entry(rod, rod) += factor * reach * (lambda[1] * c - lambda[0] * sn);
    const double mixed = factor * (lambda[0] * c + lambda[1] * sn);
    entry(rod, tip) += mixed;
    entry(tip, rod) += mixed;
    return Status::ok;
  }

 private:
  static constexpr int entries = 8;

  void apply(const std::array<double, entries>& gt, In x, Out y) const {
    for (int k = 0; k < 3; ++k) {
      y[k] = 0;
      for (int p = pattern_.start[k]; p < pattern_.start[k + 1]; ++p) {
        y[k] += gt[p] * x[pattern_.row[p]];
      }
    }
  }

  Pattern pattern_{
      coordinates, 3, {0, 3, 7, 8}, {crank, rod, tip, crank, rod, block, tip, crank}};
};

enum class Start { smooth, rigid };

class SliderCrank final : public DenseSystem<coordinates, CrankWithFlexibleRod> {
 public:
  SliderCrank(Start start, Jacobian jacobian)
      : DenseSystem(CrankWithFlexibleRod{}, jacobian), start_(start) {}

  Layout layout() const override { return {coordinates, 3}; }

  void initial_state(Out q, Out v) const override {
    std::fill(q.begin(), q.end(), 0.0);
    std::fill(v.begin(), v.end(), 0.0);
    if (start_ == Start::smooth) {
      q[elastic_0 + 2] = .103339863e-4;
      q[tip] = .169327969e-4;
      v[elastic_0] = .444896105;
      v[elastic_0 + 1] = .463434311e-2;
      v[elastic_0 + 2] = -.178591076e-5;
      v[tip] = -.268938672e-5;
    }
    q[block] = l1 + l2 + q[tip];
    v[crank] = drive_rate;
    v[rod] = -l1 * drive_rate / (l2 + q[tip]);
    v[block] = v[tip];
  }

  void scale(Out q_typ, Out v_typ) const override {
    // Sizes seen over the published run: rad, m and their rates.
    constexpr std::array<double, coordinates> size = {1, .5, .3, 2e-4, 2e-5, 2e-5, 2e-5};
    constexpr std::array<double, coordinates> rate = {150, 75, 50, .5, .01, 2e-3, 2e-3};
    std::copy(size.begin(), size.end(), q_typ.begin());
    std::copy(rate.begin(), rate.end(), v_typ.begin());
  }

  ConstraintForm* constraint_form() override { return &constraints_; }

 private:
  Start start_;
  SlideAndDrive constraints_;
};

constexpr std::array<Parameter, 2> slider_crank_table = {
    {{.name = "start",
      .help = "close to smooth motion, or rigid motion: the rod rings",
      .choices = "smooth|rigid"},
     jacobian_parameter}};

std::unique_ptr<System> make_slider_crank(const Parameters& p) {
  return std::make_unique<SliderCrank>(
      p.word("start") == "rigid" ? Start::rigid : Start::smooth, jacobian_choice(p));
}

}  // namespace

ModelEntry slider_crank_entry() {
  return {.id = "slider_crank",
          .summary = "2 angles, 1 slide, 4 elastic modes, 3 constraints (one driven)",
          .source = "Simeon 1996; Test Set for IVP Solvers 2.4, crank",
          .parameters = slider_crank_table,
          .make = make_slider_crank};
}

}  // namespace tress::models
