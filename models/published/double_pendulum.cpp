// Double pendulum: two point masses on massless rods in the plane, angles q = (theta_1,
// theta_2) in rad from the downward vertical, no constraints, no damping:
//
//     M = [(m1 + m2) l1^2, c; c, m2 l2^2],   c = m2 l1 l2 cos(theta_1 - theta_2)
//     V = -(m1 + m2) g l1 cos theta_1 - m2 g l2 cos theta_2
//
// Material points: the two masses, z up, pivot at the origin. Chaotic at large angles:
// judge long runs by energy, not by position.
// Source: L. Landau, E. Lifshitz, Mechanics (3rd ed.), section 5, problem 1.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/material_points.h"
#include "models/entry.h"
#include "models/published/dense_system.h"

namespace tress::models {
namespace {

struct Pendulum {
  double m1, m2;   // kg
  double l1, l2;   // m
  double gravity;  // m/s^2

  template <class Q>
  Q coupling(const Q* q) const {
    using std::cos;
    return (m2 * l1 * l2) * cos(q[0] - q[1]);
  }

  template <class Q, class X>
  void inertia(const Q* q, const X* x, X* r) const {
    const Q c = coupling(q);
    r[0] = ((m1 + m2) * l1 * l1) * x[0] + c * x[1];
    r[1] = c * x[0] + (m2 * l2 * l2) * x[1];
  }

  template <class T>
  void residual(double, const T* q, const T* v, const T* a, T* r) const {
    using std::sin;
    inertia(q, a, r);
    const T slope = (m2 * l1 * l2) * sin(q[0] - q[1]);
    r[0] += slope * v[1] * v[1] + ((m1 + m2) * gravity * l1) * sin(q[0]);
    r[1] += (m2 * gravity * l2) * sin(q[1]) - slope * v[0] * v[0];
  }
};

class DoublePendulum final : public DenseSystem<2, Pendulum>,
                             public ExplicitForm,
                             public Energetics,
                             public MaterialPoints {
 public:
  DoublePendulum(Pendulum pendulum, std::array<double, 2> start)
      : DenseSystem(pendulum), start_(start) {}

  void initial_state(Out q, Out v) const override {
    std::copy(start_.begin(), start_.end(), q.begin());
    std::fill(v.begin(), v.end(), 0.0);
  }
  void scale(Out q_typ, Out v_typ) const override {
    const Pendulum& p = kernel();
    std::fill(q_typ.begin(), q_typ.end(), 1.0);
    // Without gravity the only rate is the user's; one radian per second stands for it.
    const double rate = p.gravity > 0 ? std::sqrt(p.gravity / std::min(p.l1, p.l2)) : 1.0;
    std::fill(v_typ.begin(), v_typ.end(), rate);
  }

  ExplicitForm* explicit_form() override { return this; }
  Status acceleration(double t, In q, In v, Out a) noexcept override {
    const Pendulum& p = kernel();
    const std::array<double, 2> rest = {0, 0};
    std::array<double, 2> r;
    p.residual(t, q.data(), v.data(), rest.data(), r.data());
    const double c = p.coupling(q.data());
    const double m11 = (p.m1 + p.m2) * p.l1 * p.l1;
    const double m22 = p.m2 * p.l2 * p.l2;
    const double determinant = m11 * m22 - c * c;
    a[0] = (c * r[1] - m22 * r[0]) / determinant;
    a[1] = (c * r[0] - m11 * r[1]) / determinant;
    return finite(a) ? Status::ok : Status::retry;
  }

  Energetics* energetics() override { return this; }
  Energy energy(double, In q, In v) override {
    const Pendulum& p = kernel();
    return {kinetic_energy(q, v), -(p.m1 + p.m2) * p.gravity * p.l1 * std::cos(q[0]) -
                                      p.m2 * p.gravity * p.l2 * std::cos(q[1])};
  }
  double power(double, In, In) override { return 0; }

  MaterialPoints* material_points() override { return this; }
  int count() const override { return 2; }
  void positions(double, In q, Out x) override {
    const Pendulum& p = kernel();
    x[0] = p.l1 * std::sin(q[0]);
    x[1] = 0;
    x[2] = -p.l1 * std::cos(q[0]);
    x[3] = x[0] + p.l2 * std::sin(q[1]);
    x[4] = 0;
    x[5] = x[2] - p.l2 * std::cos(q[1]);
  }
  void velocities(double, In q, In v, Out u) override {
    const Pendulum& p = kernel();
    u[0] = p.l1 * v[0] * std::cos(q[0]);
    u[1] = 0;
    u[2] = p.l1 * v[0] * std::sin(q[0]);
    u[3] = u[0] + p.l2 * v[1] * std::cos(q[1]);
    u[4] = 0;
    u[5] = u[2] + p.l2 * v[1] * std::sin(q[1]);
  }

 private:
  std::array<double, 2> start_;
};

constexpr double tiny = 1e-9;  // keeps masses and lengths positive
constexpr double right_angle = std::numbers::pi / 2;
constexpr std::array<Parameter, 7> double_pendulum_table = {{
    {.name = "mass_1", .help = "upper mass (kg)", .number = 1, .min = tiny},
    {.name = "mass_2", .help = "lower mass (kg)", .number = 1, .min = tiny},
    {.name = "length_1", .help = "upper rod (m)", .number = 1, .min = tiny},
    {.name = "length_2", .help = "lower rod (m)", .number = 1, .min = tiny},
    {.name = "gravity_m_s2", .help = "gravity (m/s^2)", .number = 9.81, .min = 0},
    {.name = "angle_1", .help = "upper angle at the start (rad)", .number = right_angle},
    {.name = "angle_2", .help = "lower angle at the start (rad)", .number = right_angle},
}};

std::unique_ptr<System> make_double_pendulum(const Parameters& p) {
  return std::make_unique<DoublePendulum>(
      Pendulum{p.number("mass_1"), p.number("mass_2"), p.number("length_1"),
               p.number("length_2"), p.number("gravity_m_s2")},
      std::array<double, 2>{p.number("angle_1"), p.number("angle_2")});
}

}  // namespace

ModelEntry double_pendulum_entry() {
  return {.id = "double_pendulum",
          .summary = "2 angles, point masses, chaotic",
          .source = "Landau & Lifshitz 1976, section 5",
          .parameters = double_pendulum_table,
          .make = make_double_pendulum};
}

}  // namespace tress::models
