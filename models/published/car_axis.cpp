// Axle of a car on a bumpy road: a massless bar between two points of mass m, each on a
// spring. The left spring stands on the road, the right one on a bump that moves.
//
//     m a - f(t, q) - G(t, q)^T lambda = 0,   g(t, q) = 0,   n = 4, m = 2
//
// q = (x_l, y_l, x_r, y_r), the ends of the bar. g = (x_l x_b + y_l y_b: the chassis, at
// a right angle to the road; (x_l - x_r)^2 + (y_l - y_r)^2 - l^2: the bar's length). The
// road's right end is at (x_b, y_b), y_b = r sin(omega t), x_b^2 + y_b^2 = l^2. All
// numbers are without units, as in the Test Set, and lambda has its sign.
//
// Source: S. Schneider, Integration de systemes d'equations differentielles raides et
// differentielles-algebriques par des methodes de collocations et methodes generales
// lineaires, thesis, Geneva 1994; Mazzia & Magherini, Test Set for IVP Solvers, release
// 2.4, problem "caraxis".
#include <algorithm>
#include <array>
#include <cmath>

#include "contract/forms/constraint_form.h"
#include "models/entry.h"
#include "models/published/dense_system.h"

namespace tress::models {
namespace {

enum Coordinate { x_l, y_l, x_r, y_r, coordinates };

// Data of the Test Set. The mass is eps^2 M/2, of weight eps^2 M/2.
constexpr double eps = 1e-2, whole_mass = 10, mass = eps * eps * whole_mass / 2;
constexpr double bar = 1, spring = 0.5;       // l, and l_0 of both springs
constexpr double bump = 0.1, frequency = 10;  // r, omega

/// The road's right end at a time, with two derivatives by the time.
struct Road {
  explicit Road(double t) {
    y = bump * std::sin(frequency * t);
    y_1 = bump * frequency * std::cos(frequency * t);
    y_2 = -frequency * frequency * y;
    x = std::sqrt(bar * bar - y * y);
    x_1 = -y * y_1 / x;
    x_2 = -(y_1 * y_1 + y * y_2 + x_1 * x_1) / x;
  }
  double x, y, x_1, y_1, x_2, y_2;
};

struct Axle {
  template <class Q, class X>
  void inertia(const Q*, const X* x, X* r) const {
    for (int i = 0; i < coordinates; ++i) r[i] = mass * x[i];
  }

  // Test Set, problem "caraxis", eq. of f.
  template <class T>
  void residual(double t, const T* q, const T*, const T* a, T* r) const {
    using std::sqrt;
    const Road road(t);
    const T left = sqrt(q[x_l] * q[x_l] + q[y_l] * q[y_l]);
    const T dx = q[x_r] - road.x, dy = q[y_r] - road.y;
    const T right = sqrt(dx * dx + dy * dy);
    inertia(q, a, r);
    r[x_l] -= (spring - left) / left * q[x_l];
    r[y_l] -= (spring - left) / left * q[y_l] - mass;
    r[x_r] -= (spring - right) / right * dx;
    r[y_r] -= (spring - right) / right * dy - mass;
  }
};

class ChassisAndBar final : public ConstraintForm {
 public:
  const Pattern& pattern() const override { return pattern_; }
  void scale(Out g_typ) const override { std::ranges::fill(g_typ, bar * bar); }
  Status value(double t, In q, Out g) noexcept override {
    const Road road(t);
    const double dx = q[x_l] - q[x_r], dy = q[y_l] - q[y_r];
    g[0] = q[x_l] * road.x + q[y_l] * road.y;
    g[1] = dx * dx + dy * dy - bar * bar;
    return Status::ok;
  }
  Status gradient(double t, In q, Out gt) noexcept override {
    const Road road(t);
    put({road.x, road.y}, q, gt);
    return Status::ok;
  }
  Status rate(double t, In q, In v, Out g_dot) noexcept override {
    const Road road(t);
    g_dot[0] = road.x * v[x_l] + road.y * v[y_l] + road.x_1 * q[x_l] + road.y_1 * q[y_l];
    g_dot[1] = 2 * ((q[x_l] - q[x_r]) * (v[x_l] - v[x_r]) +
                    (q[y_l] - q[y_r]) * (v[y_l] - v[y_r]));
    return Status::ok;
  }
  Status bias(double t, In q, In v, Out b) noexcept override {
    const Road road(t);
    const double dx = v[x_l] - v[x_r], dy = v[y_l] - v[y_r];
    b[0] = 2 * (road.x_1 * v[x_l] + road.y_1 * v[y_l]) + road.x_2 * q[x_l] +
           road.y_2 * q[y_l];
    b[1] = 2 * (dx * dx + dy * dy);
    return Status::ok;
  }
  Status rate_gradient(double t, In, In v, Out values) noexcept override {
    const Road road(t);
    put({road.x_1, road.y_1}, v, values);
    return Status::ok;
  }
  Status add_curvature(double, In, In lambda, double factor, InOut s) noexcept override {
    const double entry = 2 * factor * lambda[1];
    for (int i = 0; i < coordinates; ++i) {
      s[coordinates * i + i] += entry;
      s[coordinates * i + (i + 2) % coordinates] -= entry;
    }
    return Status::ok;
  }

 private:
  /// Columns of the chassis and of the bar.
  static void put(const std::array<double, 2>& chassis, In q, Out gt) {
    const double dx = 2 * (q[x_l] - q[x_r]), dy = 2 * (q[y_l] - q[y_r]);
    const std::array<double, 6> values = {chassis[0], chassis[1], dx, dy, -dx, -dy};
    std::ranges::copy(values, gt.begin());
  }

  Pattern pattern_{coordinates, 2, {0, 2, 6}, {x_l, y_l, x_l, y_l, x_r, y_r}};
};

class CarAxis final : public DenseSystem<coordinates, Axle> {
 public:
  CarAxis() : DenseSystem(Axle{}) {}

  Layout layout() const override { return {coordinates, 2}; }
  Traits traits() const override { return {.constant_mass = true, .regular_mass = true}; }

  void initial_state(Out q, Out v) const override {
    constexpr std::array<double, coordinates> start = {0, spring, bar, spring};
    std::ranges::copy(start, q.begin());
    std::ranges::fill(v, 0.0);
    v[x_l] = v[x_r] = -spring * bump * frequency / bar;
  }

  void scale(Out q_typ, Out v_typ) const override {
    // Sizes seen over the published run.
    constexpr std::array<double, coordinates> size = {.05, .5, 1, .5};
    constexpr std::array<double, coordinates> rate = {.5, .1, .5, 1};
    std::ranges::copy(size, q_typ.begin());
    std::ranges::copy(rate, v_typ.begin());
  }

  ConstraintForm* constraint_form() override { return &constraints_; }

 private:
  ChassisAndBar constraints_;
};

std::unique_ptr<System> make_car_axis(const Parameters&) {
  return std::make_unique<CarAxis>();
}

}  // namespace

ModelEntry car_axis_entry() {
  return {.id = "car_axis",
          .summary = "2 points on springs, a bar and a moving road, 2 constraints",
          .source = "Schneider 1994; Test Set for IVP Solvers 2.4, caraxis",
          .parameters = {},
          .make = make_car_axis};
}

}  // namespace tress::models
