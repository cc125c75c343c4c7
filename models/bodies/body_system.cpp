#include "models/bodies/body_system.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "math/dual.h"
#include "models/bodies/body_kernels.h"

namespace tress::models {
namespace {

/// Rotation vector at which the reference moves, well below the accuracy of the chart.
constexpr double largest_angle = 1.5;

Frame orthonormal(Frame f) {
  f.e0 = (1 / norm(f.e0)) * f.e0;
  f.e1 = f.e1 - dot(f.e0, f.e1) * f.e0;
  f.e1 = (1 / norm(f.e1)) * f.e1;
  f.e2 = cross(f.e0, f.e1);
  return f;
}

template <class Kernel>
class BodyOf final : public BodySystem {
  static constexpr int n = Kernel::size;
  static constexpr bool free = n == 6;
  using Matrix = Eigen::Matrix<double, n, n>;
  using Vector = Eigen::Matrix<double, n, 1>;

 public:
  BodyOf(const DrivenBody& effect, const TypicalMotion& typical, Kernel kernel)
      : BodySystem(effect, typical), kernel_(std::move(kernel)) {
    zero_.assign(n, 0.0);
  }

  Layout layout() const override { return {n, 0}; }
  Traits traits() const override {
    return {.constant_mass = !free, .regular_mass = true};
  }

  void initial_state(Out q, Out v) const override {
    std::ranges::fill(q, 0.0);
    const DrivenBodies::Motion& start = effect_.start();
    if constexpr (free) {
      store3(start.x, &q[0]);
      store3(start.v, &v[0]);
      store3(start.omega, &v[3]);
    } else {
      v[0] = start.speed;
    }
  }

  void scale(Out q_typ, Out v_typ) const override {
    const DrivenBodies::Motion& start = effect_.start();
    const double spin = std::max(typical_.rate, norm(start.omega));
    std::ranges::fill(q_typ, 1.0);
    std::ranges::fill(v_typ, spin);
    if constexpr (free) {
      std::ranges::fill(q_typ.first(3), typical_.length);
      std::ranges::fill(v_typ.first(3),
                        std::max(typical_.rate * typical_.length, norm(start.v)));
    }
  }

  Status residual(double, In q, In v, In a, Out r) noexcept override {
    kernel_.equations(q.data(), v.data(), a.data(), r.data());
    const BodyWrench contact = effect_.wrench();
    std::array<double, n> loads;
    kernel_.project(q.data(), contact.force, contact.moment, loads.data());
    for (int i = 0; i < n; ++i) {
      r[i] -= loads[i];
      if (!std::isfinite(r[i])) return Status::retry;
    }
    return Status::ok;
  }

  /// Loads of joints are constant: their derivatives are the joints' own.
  Status linearize_loaded(double, In q, In v, In a, Weights w,
                          std::span<const SectionLoad> loads,
                          In springs) noexcept override {
    using D = Dual<n>;
    std::array<D, n> qd, vd, ad, r, part;
    for (int k = 0; k < n; ++k) {
      for (const auto& [to, from, weight] :
           {std::tuple{&qd, q, w.pos}, {&vd, v, w.vel}, {&ad, a, w.acc}}) {
        (*to)[k].value = from[k];
        (*to)[k].part[k] = weight;
      }
    }
    kernel_.equations(qd.data(), vd.data(), ad.data(), r.data());
    const bool moving = w.pos != 0 || w.vel != 0;
    if (moving) {
      const BodyMotionOf<D> now = kernel_.motion(qd.data(), vd.data(), ad.data());
      // The contact forces act at fixed places.
      const Vec at{now.x.x.value, now.x.y.value, now.x.z.value};
      Vec3<D> force(wrench_.force), moment(wrench_.moment);
      moment = moment - cross(now.x - Vec3<D>(at), force);
      for (const SectionLoad& load : loads) {
        const Vec3<D> arm =
            now.turn * Vec3<D>(arms_[static_cast<std::size_t>(load.point)]);
        force = force + Vec3<D>(load.force);
        moment = moment + Vec3<D>(load.moment) + cross(arm, Vec3<D>(load.force));
      }
      kernel_.project(qd.data(), force, moment, part.data());
      for (int i = 0; i < n; ++i) r[i] -= part[i];
    }
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        matrix_(i, j) = r[i].part[j];
        if (moving && !own_.empty()) matrix_(i, j) += own_[std::size_t(j * n + i)];
      }
      if (!springs.empty()) matrix_(j, j) += w.pos * springs[j];
    }
    lu_.compute(matrix_);
    const double least = lu_.matrixLU().diagonal().cwiseAbs().minCoeff();
    return least > 0 && std::isfinite(least) ? Status::ok : Status::retry;
  }

  Status solve(In b, Out x) noexcept override {
    const Vector right = Eigen::Map<const Vector>(b.data());
    Eigen::Map<Vector>(x.data()) = lu_.solve(right);
    return Status::ok;
  }

  Status acceleration(double t, In q, In v, Out a) noexcept override {
    std::array<double, n> r;
    Status s = residual(t, q, v, zero_, r);
    if (s == Status::ok) s = linearize_loaded(t, q, v, zero_, {1, 0, 0}, {}, {});
    for (double& one : r) one = -one;
    return s == Status::ok ? solve(r, a) : s;
  }

  DrivenBodies::Motion motion(In q, In v) const override {
    const BodyMotionOf<double> m = kernel_.motion(q.data(), v.data(), zero_.data());
    DrivenBodies::Motion to{m.x, m.turn, m.v, m.omega};
    if constexpr (!free) {
      to.angle = q[0];
      to.speed = v[0];
    }
    return to;
  }

  void screws(In q, In v, std::span<Screw> to) const override {
    if constexpr (!free) {
      to[0] = {kernel_.bearing.axis, {}, {}};
    } else {
      using D = Dual<3>;
      std::array<D, 6> at;
      for (int k = 0; k < 6; ++k) at[k].value = q[k];
      for (int k = 0; k < 3; ++k) at[k + 3].part[k] = 1;
      const Vec3<D> spin =
          kernel_.world(kernel_.chart(at.data()).w(Vec3<D>(load3(&v[3]))));
      const RotationChart<double> chart = kernel_.chart(q.data());
      for (int k = 0; k < 3; ++k) {
        const Vec unit(k == 0, k == 1, k == 2);
        to[k] = {{}, unit, {}};
        to[k + 3] = {kernel_.world(chart.w(unit)),
                     {},
                     {spin.x.part[k], spin.y.part[k], spin.z.part[k]}};
      }
    }
  }

  void accelerations(double, In q, In v, In a, Out x) override {
    const BodyMotionOf<double> m = kernel_.motion(q.data(), v.data(), a.data());
    for (std::size_t i = 0; i < arms_.size(); ++i) {
      const Vec arm = m.turn * arms_[i];
      store3(m.a + cross(m.alpha, arm) + cross(m.omega, cross(m.omega, arm)), &x[3 * i]);
    }
  }

  bool pull_back(double, In q, std::span<const int> points, In f, InOut b) override {
    const Frame turn = motion(q, zero_).turn;
    Vec force, moment;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec one = load3(&f[3 * i]);
      force = force + one;
      moment = moment + cross(turn * arms_[static_cast<std::size_t>(points[i])], one);
    }
    add(q, force, moment, b);
    return true;
  }

  std::vector<int> section_coordinates(int) const override {
    if constexpr (free) return {3, 4, 5};
    return {0};
  }
  SectionMotion section(double, In q, In v, In a, int) override {
    const BodyMotionOf<double> m = kernel_.motion(q.data(), v.data(), a.data());
    return {m.turn, m.omega, m.alpha};
  }
  void add_moment(double, In q, int, const Vec& moment, InOut b) override {
    add(q, {}, moment, b);
  }

  Energy energy(double, In q, In v) override {
    if constexpr (free) {
      const Vec omega = kernel_.chart(q.data()).w_transposed(load3(&v[3]));
      const Vec u = load3(&v[0]);
      return {(kernel_.body.mass * dot(u, u) + dot(omega, kernel_.momentum(omega))) / 2,
              -kernel_.body.mass * dot(kernel_.gravity, load3(&q[0]))};
    } else {
      return {kernel_.bearing.inertia * v[0] * v[0] / 2, 0};
    }
  }
  /// A bearing carries momentum away: of a body that turns, 0.
  std::optional<Momentum> momentum(double, In q, In v) override {
    Momentum all;
    if constexpr (free) {
      const RotationChart<double> chart = kernel_.chart(q.data());
      const Vec linear = kernel_.body.mass * load3(&v[0]);
      const Vec spin =
          kernel_.world(chart.turned(kernel_.momentum(chart.w_transposed(load3(&v[3])))));
      store3(linear, all.linear.data());
      store3(cross(load3(&q[0]), linear) + spin, all.angular.data());
    }
    return all;
  }
  double power(double, In q, In v) override {
    if constexpr (free) return 0;
    return own_power(q, v);
  }
  double own_power(In, In v) const override {
    if constexpr (free) {
      return kernel_.body.mass * dot(kernel_.gravity, load3(&v[0]));
    } else {
      return (kernel_.bearing.moment - kernel_.bearing.damping * v[0]) * v[0];
    }
  }

  bool accept(double, InOut q, InOut v) override {
    if constexpr (free) {
      const Vec phi = load3(&q[3]);
      if (dot(phi, phi) < largest_angle * largest_angle) return false;
      const RotationChart<double> chart(phi);
      store3(chart.w_transposed(load3(&v[3])), &v[3]);
      store3(Vec{}, &q[3]);
      kernel_.reference = orthonormal(kernel_.reference * chart.frame());
      return true;
    }
    return false;
  }
  void reset() override {
    if constexpr (free) kernel_.reference = {};
  }
  std::vector<double> memory() const override {
    std::vector<double> all;
    if constexpr (free) {
      all.resize(9);
      store9(kernel_.reference, all.data());
    }
    return all;
  }
  void recall(In memory) override {
    if constexpr (free) kernel_.reference = load9(memory.data());
  }

 private:
  void add(In q, const Vec& force, const Vec& moment, InOut b) const {
    std::array<double, n> r;
    kernel_.project(q.data(), force, moment, r.data());
    for (int i = 0; i < n; ++i) b[i] += r[i];
  }

  Kernel kernel_;
  Matrix matrix_;
  Eigen::PartialPivLU<Matrix> lu_;
};

}  // namespace

TypicalMotion typical_motion(System& strand) {
  const auto n = static_cast<std::size_t>(strand.layout().coordinates);
  std::vector<double> q(n), v(n), q_typ(n), v_typ(n);
  strand.initial_state(q, v);
  strand.scale(q_typ, v_typ);
  TypicalMotion typical{0, 0};
  for (std::size_t i = 0; i < n; ++i) {
    typical.rate = std::max(typical.rate, v_typ[i] / q_typ[i]);
  }
  if (MaterialPoints* const points = strand.material_points()) {
    std::vector<double> x(3 * static_cast<std::size_t>(points->count()));
    points->positions(0, q, x);
    for (int i = 1; i < points->count(); ++i) {
      const int before = points->before(i);
      if (before < 0) continue;
      typical.length += norm(load3(&x[3 * static_cast<std::size_t>(i)]) -
                             load3(&x[3 * static_cast<std::size_t>(before)]));
    }
  }
  if (typical.length == 0) typical.length = 1;
  return typical;
}

Vec gravity_on_bodies(const Effects& effects) {
  Vec sum;
  for (const auto& effect : effects) {
    if (effect->name() != "gravity") continue;
    sum = sum + effect->uniform_acceleration().value_or(Vec{});
  }
  return sum;
}

int BodySystem::add_point(const Vec& place) {
  arms_.push_back(place - effect_.start().x);
  return count() - 1;
}

void BodySystem::hang(const BodyWrench& wrench, std::span<const double> own) {
  wrench_ = wrench;
  own_.assign(own.begin(), own.end());
}

void BodySystem::positions(double, In q, Out x) {
  const DrivenBodies::Motion now = motion(q, zero_);
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    store3(now.x + now.turn * arms_[i], &x[3 * i]);
  }
}

void BodySystem::velocities(double, In q, In v, Out u) {
  const DrivenBodies::Motion now = motion(q, v);
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    store3(now.v + cross(now.omega, now.turn * arms_[i]), &u[3 * i]);
  }
}

Frame BodySystem::section_frame(double, In q, int) { return motion(q, zero_).turn; }

std::unique_ptr<BodySystem> make_body_system(const DrivenBody& effect, const Vec& gravity,
                                             const TypicalMotion& typical) {
  if (const auto* bearing = std::get_if<Bearing>(&effect.drive())) {
    return std::make_unique<BodyOf<TurningKernel>>(effect, typical,
                                                   TurningKernel{*bearing});
  }
  const FreeBody& body = std::get<FreeBody>(effect.drive());
  return std::make_unique<BodyOf<FreeKernel>>(
      effect, typical,
      FreeKernel{body, turned(effect.place().frame, diagonal(body.inertia)), gravity});
}

}  // namespace tress::models
