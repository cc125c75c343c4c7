#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/history.h"
#include "contract/forms/sparse_form.h"
#include "contract/pattern.h"
#include "contract/system.h"
#include "linear/linear_solver.h"

/// Systems small enough to check by hand, for tests of integrators.
namespace tress::testing_support {

inline Pattern dense_pattern(int n) {
  Pattern p{n, n, {0}, {}};
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) p.row.push_back(i);
    p.start.push_back((j + 1) * n);
  }
  return p;
}

inline constexpr double gravity = 9.81;  // m/s^2

/// Pendulum of length 1 m in its angle: a + gravity sin q = 0, started at rest at 1 rad.
/// What it does when asked wrongly, and its floor, are knobs of the tests.
class AnglePendulum : public System, private ExplicitForm, private History {
 public:
  bool offers_explicit_form = true;
  double fails_after = std::numeric_limits<double>::infinity();  // s
  Status failure = Status::fatal;
  double longest_leap = std::numeric_limits<double>::infinity();  // s, beyond it: retry
  double leaps_from = 0;                                          // s
  bool bounces = false;  // off the vertical q = 0, elastically
  int bounced = 0;

  Layout layout() const override { return {1, 0}; }
  Traits traits() const override { return {true, true}; }
  void initial_state(Out q, Out v) const override {
    q[0] = 1;
    v[0] = 0;
  }
  void scale(Out q_typ, Out v_typ) const override {
    q_typ[0] = 1;
    v_typ[0] = std::sqrt(gravity);
  }
  Status residual(double t, In q, In, In a, Out r) noexcept override {
    r[0] = a[0] + gravity * std::sin(q[0]);
    return outcome(t);
  }
  Status linearize(double t, In q, In, In, Weights w) noexcept override {
    s_ = w.acc + w.pos * gravity * std::cos(q[0]);
    return outcome(t);
  }
  Status solve(In b, Out x) noexcept override {
    x[0] = b[0] / s_;
    return Status::ok;
  }
  ExplicitForm* explicit_form() override { return offers_explicit_form ? this : nullptr; }
  History* history() override { return this; }

 private:
  bool accept(double, InOut q, InOut v) override {
    if (!bounces || q[0] >= 0 || v[0] >= 0) return false;
    v[0] = -v[0];
    ++bounced;
    return true;
  }
  void reset() override {}
  std::vector<double> memory() const override { return {}; }
  void recall(In) override {}
  Status acceleration(double t, In q, In, Out a) noexcept override {
    a[0] = -gravity * std::sin(q[0]);
    return outcome(t);
  }
  Status outcome(double t) const {
    if (t > leaps_from + longest_leap) return Status::retry;
    return t > fails_after ? failure : Status::ok;
  }
  double s_ = 1;
};

/// A soft oscillator a0 + q0 = 0 that a stiff, overdamped one follows:
/// a1 + c v1 + k (q1 - q0) = 0. From q0 = 1 at rest, q0 = cos t and on the slow motion
/// q1 = Re(H e^{it}), H = k / (k - 1 + i c).
class StiffFollower : public System {
 public:
  static constexpr double k = 1e8;  // 1/s^2: rates of 1e4 / s
  static constexpr double c = 2e4;  // 1/s

  struct State {
    std::array<double, 2> q, v;
  };
  static State exact(double t) {
    const double size = k / ((k - 1) * (k - 1) + c * c);
    const double re = size * (k - 1), im = -size * c;
    return {{std::cos(t), re * std::cos(t) - im * std::sin(t)},
            {-std::sin(t), -re * std::sin(t) - im * std::cos(t)}};
  }

  Layout layout() const override { return {2, 0}; }
  Traits traits() const override { return {true, true}; }
  void initial_state(Out q, Out v) const override {
    const State s = exact(0);
    std::ranges::copy(s.q, q.begin());
    std::ranges::copy(s.v, v.begin());
  }
  void scale(Out q_typ, Out v_typ) const override {
    std::ranges::fill(q_typ, 1.0);
    std::ranges::fill(v_typ, 1.0);
  }
  Status residual(double, In q, In v, In a, Out r) noexcept override {
    r[0] = a[0] + q[0];
    r[1] = a[1] + c * v[1] + k * (q[1] - q[0]);
    return Status::ok;
  }
  Status linearize(double, In, In, In, Weights w) noexcept override {
    s00_ = w.acc + w.pos;
    s10_ = -k * w.pos;
    s11_ = w.acc + c * w.vel + k * w.pos;
    return Status::ok;
  }
  Status solve(In b, Out x) noexcept override {
    x[0] = b[0] / s00_;
    x[1] = (b[1] - s10_ * x[0]) / s11_;
    return Status::ok;
  }

 private:
  double s00_ = 1, s10_ = 0, s11_ = 1;
};

/// Chain of equal links (1 m, 1 kg at each end) in the angles from the vertical, hung at
/// the top, started at rest at 1 rad: a dense mass matrix that moves with q.
///     r_i = sum_j m_ij (cos(q_i - q_j) a_j + sin(q_i - q_j) v_j^2) + m_ii g sin q_i,
///     m_ij = links - max(i, j).
class AngleChain : public System, private SparseForm {
 public:
  bool offers_sparse_form = false;

  explicit AngleChain(int links)
      : n_(links),
        pattern_(dense_pattern(links)),
        solver_(make_linear_solver(LinearKind::dense, pattern_)),
        s_(static_cast<std::size_t>(links * links)) {}

  Layout layout() const override { return {n_, 0}; }
  Traits traits() const override { return {}; }
  void initial_state(Out q, Out v) const override {
    std::ranges::fill(q, 1.0);
    std::ranges::fill(v, 0.0);
  }
  void scale(Out q_typ, Out v_typ) const override {
    std::ranges::fill(q_typ, 1.0);
    std::ranges::fill(v_typ, std::sqrt(gravity));
  }
  Status residual(double, In q, In v, In a, Out r) noexcept override {
    for (std::size_t i = 0; i < q.size(); ++i) {
      r[i] = mass(i, i) * gravity * std::sin(q[i]);
      for (std::size_t j = 0; j < q.size(); ++j) {
        const double d = q[i] - q[j];
        r[i] += mass(i, j) * (std::cos(d) * a[j] + std::sin(d) * v[j] * v[j]);
      }
    }
    return Status::ok;
  }
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    (void)values(t, q, v, a, w, s_);
    return solver_->factor(s_);
  }
  Status solve(In b, Out x) noexcept override {
    std::copy(b.begin(), b.end(), x.begin());
    return solver_->solve(x);
  }
  SparseForm* sparse_form() override { return offers_sparse_form ? this : nullptr; }

 private:
  const Pattern& pattern() const override { return pattern_; }
  Status values(double, In q, In v, In a, Weights w, Out s) noexcept override {
    const std::size_t n = q.size();
    for (std::size_t i = 0; i < n; ++i) {
      double turned = mass(i, i) * gravity * std::cos(q[i]);  // dr_i/dq_i
      for (std::size_t j = 0; j < n; ++j) {
        const double d = q[i] - q[j], sine = std::sin(d), cosine = std::cos(d);
        const double dq = mass(i, j) * (sine * a[j] - cosine * v[j] * v[j]);
        turned -= dq;
        s[j * n + i] = w.acc * mass(i, j) * cosine +
                       w.vel * mass(i, j) * 2 * sine * v[j] + w.pos * dq;
      }
      s[i * n + i] += w.pos * turned;
    }
    return Status::ok;
  }
  double mass(std::size_t i, std::size_t j) const {
    return n_ - static_cast<double>(std::max(i, j));
  }

  int n_;
  Pattern pattern_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<double> s_;
};

/// The same pendulum as a point (1 kg) in the plane with g = (|q|^2 - 1) / 2 = 0, y up.
class PointPendulum : public System {
 public:
  Layout layout() const override { return {2, 1}; }
  Traits traits() const override { return {true, true}; }
  void initial_state(Out q, Out v) const override {
    q[0] = std::sin(1.0);
    q[1] = -std::cos(1.0);
    v[0] = v[1] = 0;
  }
  void scale(Out q_typ, Out v_typ) const override {
    std::ranges::fill(q_typ, 1.0);
    std::ranges::fill(v_typ, std::sqrt(gravity));
  }
  Status residual(double, In, In, In a, Out r) noexcept override {
    r[0] = a[0];
    r[1] = a[1] + gravity;
    return Status::ok;
  }
  Status linearize(double, In, In, In, Weights w) noexcept override {
    s_ = w.acc;
    return Status::ok;
  }
  Status solve(In b, Out x) noexcept override {
    for (std::size_t i = 0; i < 2; ++i) x[i] = b[i] / s_;
    return Status::ok;
  }
  SparseForm* sparse_form() override { return &mass_; }
  ConstraintForm* constraint_form() override { return &circle_; }

  static double violation(In q) { return std::abs(q[0] * q[0] + q[1] * q[1] - 1) / 2; }

 private:
  struct Mass final : SparseForm {
    const Pattern diagonal{2, 2, {0, 1, 2}, {0, 1}};
    const Pattern& pattern() const override { return diagonal; }
    Status values(double, In, In, In, Weights w, Out s) noexcept override {
      std::ranges::fill(s, w.acc);
      return Status::ok;
    }
  };
  struct Circle final : ConstraintForm {
    const Pattern column{2, 1, {0, 2}, {0, 1}};
    const Pattern& pattern() const override { return column; }
    void scale(Out g_typ) const override { g_typ[0] = 1; }
    Status value(double, In q, Out g) noexcept override {
      g[0] = (q[0] * q[0] + q[1] * q[1] - 1) / 2;
      return Status::ok;
    }
    Status gradient(double, In q, Out gt) noexcept override {
      std::copy(q.begin(), q.end(), gt.begin());
      return Status::ok;
    }
    Status rate(double, In q, In v, Out g_dot) noexcept override {
      g_dot[0] = q[0] * v[0] + q[1] * v[1];
      return Status::ok;
    }
    Status bias(double, In, In v, Out b) noexcept override {
      b[0] = v[0] * v[0] + v[1] * v[1];
      return Status::ok;
    }
    Status rate_gradient(double, In, In v, Out values) noexcept override {
      std::copy(v.begin(), v.end(), values.begin());
      return Status::ok;
    }
    Status add_curvature(double, In, In lambda, double factor,
                         InOut s) noexcept override {
      for (double& entry : s) entry += factor * lambda[0];
      return Status::ok;
    }
  };
  Mass mass_;
  Circle circle_;
  double s_ = 1;
};

}  // namespace tress::testing_support
