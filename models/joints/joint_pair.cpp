#include "models/joints/joint_pair.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "contract/input_error.h"
#include "models/supports/vec_parts.h"

namespace tress::models {
namespace {

using Eigen::Matrix3d;

constexpr Vec unit[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// The frame `inner` in components of `outer`.
Frame relative(const Frame& outer, const Frame& inner) {
  return {outer.back(inner.e0), outer.back(inner.e1), outer.back(inner.e2)};
}

Matrix3d matrix(const Frame& f) {
  Matrix3d m;
  m << f.e0.x, f.e1.x, f.e2.x, f.e0.y, f.e1.y, f.e2.y, f.e0.z, f.e1.z, f.e2.z;
  return m;
}

/// Two joints with these moduli in series, in the axes of b. `turn`: b in components of
/// a.
Matrix3d in_series(const Vec& a, const Vec& b, const Matrix3d& turn) {
  const auto compliance = [](const Vec& k) {
    return Eigen::Vector3d(1 / k.x, 1 / k.y, 1 / k.z);
  };
  Matrix3d all = turn.transpose() * compliance(a).asDiagonal() * turn;
  all.diagonal() += compliance(b);
  return all.inverse();
}

/// A frame whose first axis is this one.
Frame along(const Vec& axis) {
  const Vec e0 = (1 / norm(axis)) * axis;
  const Vec least = std::abs(e0.x) < 0.6 ? unit[0] : unit[1];
  const Vec across = cross(least, e0);
  const Vec e1 = (1 / norm(across)) * across;
  return {e0, e1, cross(e0, e1)};
}

}  // namespace

JointPair::JointPair(JointEnd a, JointEnd b, const Joint& joint, In q,
                     const std::string& where)
    : a_(std::move(a)),
      b_(std::move(b)),
      spring_(joint.kind == JointKind::spring),
      stiffness_(joint.stiffness),
      damping_(joint.damping),
      rest_length_(joint.rest_length) {
  refuse_if(a_.first() == b_.first() && a_.point() == b_.point(),
            "a joint of a point with itself", where, "join two points");
  zero_.assign(q.size(), 0.0);
  moved_ = zero_;
  std::vector<double> column(q.size());
  add_force(0, q, {1, 2, 3}, column);
  const bool moves = std::ranges::any_of(column, [](double x) { return x != 0; });
  refuse_if(!moves, "a joint of two points that cannot move", where,
            "leave the root of one of the strands free");
  if (joint.kind == JointKind::weld || joint.kind == JointKind::hinge) {
    hold(joint, q, where);
  }
}

/// Chooses the axes of c.
void JointPair::hold(const Joint& joint, In q, const std::string& where) {
  const bool hinge = joint.kind == JointKind::hinge;
  turning_ = true;
  a_.hold_section(where);
  b_.hold_section(where);
  const auto at_start = [q](JointEnd& end, const std::optional<Frame>& begin) {
    return begin && end.half_edge() ? end.of_model(0, q) * *begin : end.frame(0, q);
  };
  const Frame of_a = at_start(a_, joint.begin_a), of_b = at_start(b_, joint.begin_b);
  const Frame turn = relative(of_a, of_b);
  if (hinge) {
    refuse_if(!(norm(joint.axis) > 0), "a hinge without an axis", where, "give axis");
    measure_ = Sections::Turning::tangent;
    axes_ = along(of_b.back(joint.axis));
  }
  if (a_.half_edge() || b_.half_edge()) {
    Matrix3d k = in_series(joint.half_a.stiffness, joint.half_b.stiffness, matrix(turn));
    const double da = joint.half_a.friction.x, db = joint.half_b.friction.x;
    const double friction = da > 0 && db > 0 ? 1 / (1 / da + 1 / db) : 0;
    const Matrix3d basis = matrix(axes_);
    k = (basis.transpose() * k * basis).eval();
    // Axes in which k, or its part across the hinge, is diagonal.
    if (hinge) {
      k.row(0).setZero();
      k.col(0).setZero();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> of(k);
    Matrix3d turned = of.eigenvectors();  // ascending: the hinge first
    if (turned.determinant() < 0) turned.col(2) *= -1;
    if (hinge && turned(0, 0) < 0) turned.leftCols<2>() *= -1;
    const auto axis = [&](int i) {
      return Vec{turned(0, i), turned(1, i), turned(2, i)};
    };
    axes_ = axes_ * Frame{axis(0), axis(1), axis(2)};
    elastic_ = {of.eigenvalues()[0], of.eigenvalues()[1], of.eigenvalues()[2]};
    friction_ = {hinge ? 0 : friction, friction, friction};
    if (hinge) elastic_.x = 0;
  } else if (hinge) {
    components_ = {1, 2};
  } else {
    components_ = {0, 1, 2};
  }
  to_wall_ = turn * axes_;
}

RootPose JointPair::wall(double t, In q) {
  RootPose pose;
  pose.frame = a_.frame(t, q) * to_wall_;
  return pose;
}

RootPose JointPair::wall(double t, In q, In v) {
  const SectionMotion m = a_.section(t, q, v, zero_);
  RootPose pose;
  pose.frame = m.frame * to_wall_;
  pose.omega = m.omega;
  pose.alpha = m.alpha;
  return pose;
}

SectionMotion JointPair::section(double t, In q, In v) {
  SectionMotion m = b_.section(t, q, v, zero_);
  m.frame = m.frame * axes_;
  return m;
}

void JointPair::value(double t, In q, Out g) {
  if (places() > 0) store3(b_.place(t, q) - a_.place(t, q), g.data());
  if (components_.empty()) return;
  const Vec c = gap(t, q).value;
  std::size_t row = 3;
  for (const int k : components_) g[row++] = component(c, k);
}

void JointPair::rate(double t, In q, In v, Out g) {
  if (places() > 0) store3(b_.velocity(t, q, v) - a_.velocity(t, q, v), g.data());
  if (components_.empty()) return;
  const Vec c = gap(t, q, v).rate;
  std::size_t row = 3;
  for (const int k : components_) g[row++] = component(c, k);
}

void JointPair::bias(double t, In q, In v, Out g) {
  if (places() > 0) {
    store3(b_.acceleration(t, q, v, zero_) - a_.acceleration(t, q, v, zero_), g.data());
  }
  if (components_.empty()) return;
  const Vec c = gap(t, q, v).acceleration;
  std::size_t row = 3;
  for (const int k : components_) g[row++] = component(c, k);
}

Vec JointPair::turning_rate(double t, In q, In v) {
  return turning_ ? gap(t, q, v).rate : Vec{};
}

void JointPair::add_gradient(double t, In q, int row, double factor, InOut b) {
  if (!turns(row)) return add_force(t, q, factor * unit[row], b);
  const int k = components_[static_cast<std::size_t>(row - places())];
  add_moment(t, q, gap(t, q).moment(factor * unit[k]), b);
}

/// Total stress on c: of the multipliers, less that of the elastic halves.
Vec JointPair::stress(const SectionGap& gap, In lambda) const {
  double all[3] = {};
  for (std::size_t i = 0; i < components_.size() && !lambda.empty(); ++i) {
    all[components_[i]] = lambda[3 + i];
  }
  return load3(all) - entrywise(elastic_, gap.value) - entrywise(friction_, gap.rate);
}

JointLoad JointPair::load(double t, In q, In v, In lambda) {
  JointLoad made;
  if (spring_) {
    const Vec d = b_.place(t, q) - a_.place(t, q),
              u = b_.velocity(t, q, v) - a_.velocity(t, q, v);
    const double length = norm(d);
    if (rest_length_ == 0) {
      made.force = -stiffness_ * d - damping_ * u;
    } else if (length > 0) {
      const Vec n = (1 / length) * d;
      made.force = -(stiffness_ * (length - rest_length_) + damping_ * dot(u, n)) * n;
    }
  } else if (!lambda.empty()) {
    made.force = load3(lambda.data());
  }
  if (turning_) {
    const SectionGap at = gap(t, q, v);
    made.moment = at.moment(stress(at, lambda));
  }
  return made;
}

void JointPair::add_load(double t, In q, const JointLoad& load, InOut b) {
  add_force(t, q, load.force, b);
  if (turning_) add_moment(t, q, load.moment, b);
}

double JointPair::energy(double t, In q) {
  double sum = 0;
  if (spring_) {
    const double stretch = norm(b_.place(t, q) - a_.place(t, q)) - rest_length_;
    sum += stiffness_ * stretch * stretch / 2;
  }
  if (turning_) {
    const Vec c = gap(t, q).value;
    sum += dot(elastic_, entrywise(c, c)) / 2;
  }
  return sum;
}

double JointPair::energy_rate(double t, In q, In v) {
  double sum = 0;
  if (spring_) {
    const Vec d = b_.place(t, q) - a_.place(t, q),
              u = b_.velocity(t, q, v) - a_.velocity(t, q, v);
    const double length = norm(d);
    const double part = rest_length_ == 0 ? 1
                        : length > 0      ? 1 - rest_length_ / length
                                          : 0;
    sum += stiffness_ * part * dot(d, u);
  }
  if (turning_) {
    const SectionGap at = gap(t, q, v);
    sum += dot(entrywise(elastic_, at.value), at.rate);
  }
  return sum;
}

template <class Add>
void JointPair::add_drift(double t, In q, In v, const Vec& load, InOut b,
                          const Add& add) {
  for (const double step : {dt_, -dt_}) {
    for (std::size_t i = 0; i < q.size(); ++i) moved_[i] = q[i] + step * v[i];
    add(t + step, moved_, (0.5 / step) * load, b);
  }
}

/// Row e of the derivative of a spring's pull k (l - l0) n + c (u . n) n by d = l n, with
/// the weights of S.
Vec JointPair::along_spring(const Vec& d, const Vec& u, const Vec& e, Weights w) const {
  const double length = norm(d);
  const Vec n = length > 0 ? (1 / length) * d : unit[0];
  const double over_length = 1 / std::max(length, 1e-300);
  // Bounded in runs: slack springs must not make S indefinite.
  const double slack =
      dt_ > 0 ? rest_length_ * over_length : std::min(1.0, rest_length_ * over_length);
  const Vec along_n = dot(n, e) * n, across = e - along_n;
  Vec pulled = (w.pos * stiffness_) * (e - slack * across) + (w.vel * damping_) * along_n;
  if (dt_ > 0) {
    const Vec u_across = u - dot(u, n) * n;
    pulled = pulled + (w.pos * damping_ * over_length) *
                          (dot(n, e) * u_across + dot(u, n) * across);
  }
  return pulled;
}

/// A motion turns the ends by D_a and D_b. The moment M on b changes by B (D_b - D_a) +
/// D_a x M, where B is its derivative by the turn of b. M turns with both ends if they
/// turn together. The force of a spring changes by -K (x_b - x_a)' alone.
///
/// Exact: velocities u = J v change by J' dq, where J' is the derivative of J along the
/// motion. Angular velocities w = W v change by W' dq + D x w.
void JointPair::write_couplings(double t, In q, In v, In lambda, Weights w,
                                Eigen::Ref<Eigen::MatrixXd> u,
                                Eigen::Ref<Eigen::MatrixXd> v_of) {
  Eigen::Index column = 0;
  const auto at = [](Eigen::Ref<Eigen::MatrixXd> of, Eigen::Index k) {
    return InOut(of.col(k).data(), static_cast<std::size_t>(of.rows()));
  };
  if (spring_) {
    const Vec d = b_.place(t, q) - a_.place(t, q);
    const Vec rate = dt_ > 0 ? b_.velocity(t, q, v) - a_.velocity(t, q, v) : Vec{};
    for (const Vec& e : unit) {
      const Vec pulled = rest_length_ > 0 ? along_spring(d, rate, e, w)
                                          : (w.pos * stiffness_ + w.vel * damping_) * e;
      add_force(t, q, e, at(u, column));
      add_force(t, q, pulled, at(v_of, column));
      if (dt_ > 0 && damping_ > 0) {
        const Vec damped = rest_length_ > 0 ? (dot(d, e) / dot(d, d)) * d : e;
        add_drift(t, q, v, (w.pos * damping_) * damped, at(v_of, column),
                  [this](double at_t, In x, const Vec& f, InOut b) {
                    add_force(at_t, x, f, b);
                  });
      }
      ++column;
    }
  }
  if (!turning_) return;
  const RootPose wall_now = wall(t, q, v);
  const SectionMotion section_now = section(t, q, v);
  const Vec total = stress(SectionGap(measure_, wall_now, section_now), lambda);
  const SectionLoad by = section_load(measure_, wall_now, section_now, total,
                                      -1.0 * elastic_, -1.0 * friction_);
  for (int i = 0; i < 3; ++i) {
    add_moment(t, q, unit[i], at(u, column));
    const Vec turn = -w.pos * by.by_turn.row[i] - w.vel * by.by_spin.row[i];
    add_moment(t, q, turn, at(v_of, column));
    a_.add_moment(t, q, -w.pos * cross(by.moment, unit[i]), at(v_of, column));
    if (dt_ > 0 && norm(friction_) > 0) {
      const Vec spin = by.by_spin.row[i];
      add_moment(t, q, -w.pos * cross(section_now.omega, spin), at(v_of, column));
      add_drift(t, q, v, -w.pos * spin, at(v_of, column),
                [this](double at_t, In x, const Vec& m, InOut b) {
                  add_moment(at_t, x, m, b);
                });
    }
    ++column;
  }
}

}  // namespace tress::models
