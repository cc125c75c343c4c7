#pragma once

#include <Eigen/Core>
#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/forms/energetics.h"
#include "contract/forms/sparse_form.h"
#include "contract/pattern.h"
#include "contract/system.h"
#include "tests/support/dense.h"

namespace tress::testing_support {

inline In view(const Eigen::VectorXd& x) { return {x.data(), std::size_t(x.size())}; }
inline Out view(Eigen::VectorXd& x) { return {x.data(), std::size_t(x.size())}; }

inline Eigen::MatrixXd dense(const Pattern& p, const std::vector<double>& values) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(p.rows, p.cols);
  for (int j = 0; j < p.cols; ++j) {
    for (int k = p.start[std::size_t(j)]; k < p.start[std::size_t(j) + 1]; ++k) {
      m(p.row[std::size_t(k)], j) = values[std::size_t(k)];
    }
  }
  return m;
}

/// A system at a state, with the dense oracle of its equations: small systems only.
struct Oracle {
  System& system;
  Eigen::VectorXd q, v;

  explicit Oracle(System& s) : system(s), q(s.layout().coordinates), v(q.size()) {
    system.initial_state(view(q), view(v));
  }

  Eigen::MatrixXd tangent(Weights w) const {
    SparseForm& form = *system.sparse_form();
    std::vector<double> s(std::size_t(form.pattern().nonzeros()));
    const Eigen::VectorXd a = Eigen::VectorXd::Zero(q.size());
    EXPECT_EQ(form.values(0, view(q), view(v), view(a), w, s), Status::ok);
    return dense(form.pattern(), s);
  }

  Eigen::MatrixXd gradient() const {
    ConstraintForm& form = *system.constraint_form();
    std::vector<double> gt(std::size_t(form.pattern().nonzeros()));
    EXPECT_EQ(form.gradient(0, view(q), gt), Status::ok);
    return dense(form.pattern(), gt).transpose();
  }

  /// [M, -G^T; G, 0] (a, lambda) = (f, -bias) in the least-squares sense.
  Eigen::VectorXd acceleration() const {
    const auto n = q.size();
    const auto m = system.layout().constraints;
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd r(n);
    EXPECT_EQ(system.residual(0, view(q), view(v), view(rest), view(r)), Status::ok);
    Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n + m, n + m);
    Eigen::VectorXd rhs(n + m);
    kkt.topLeftCorner(n, n) = tangent({1, 0, 0});
    rhs.head(n) = -r;
    if (m > 0) {
      Eigen::VectorXd bias(m);
      EXPECT_EQ(system.constraint_form()->bias(0, view(q), view(v), view(bias)),
                Status::ok);
      kkt.bottomLeftCorner(m, n) = gradient();
      kkt.topRightCorner(n, m) = -gradient().transpose();
      rhs.tail(m) = -bias;
    }
    const Eigen::VectorXd x = testing_support::least_squares(kkt, rhs);
    return x.head(n);
  }

  double total_energy(double ahead) const {
    const Eigen::VectorXd a = acceleration();
    const Eigen::VectorXd q1 = q + ahead * v + ahead * ahead / 2 * a;
    const Eigen::VectorXd v1 = v + ahead * a;
    return system.energetics()->energy(0, view(q1), view(v1)).total();
  }
};

}  // namespace tress::testing_support
