#include <Eigen/Cholesky>
#include <vector>

#include "integrators/fixed_step.h"
#include "integrators/methods.h"

namespace tress {
namespace {

using Block = ComplianceForm::Block;

/// Places of `count` blocks in the order of a sweep.
std::vector<std::size_t> order_of(SweepOrder order, std::size_t count) {
  std::vector<std::size_t> all;
  if (order == SweepOrder::root_to_tip) {
    for (std::size_t k = 0; k < count; ++k) all.push_back(k);
    return all;
  }
  std::size_t odd = count - count % 2;  // one behind the last odd place
  for (std::size_t even = 0; even < count; even += 2) {
    all.push_back(even);
    if (odd > 0) all.push_back(odd - 1);
    odd = odd > 2 ? odd - 2 : 0;
  }
  return all;
}

class Xpbd final : public FixedStep {
 public:
  Xpbd(System& system, const Options& options)
      : FixedStep(system, options),
        form_(*system.compliance_form()),
        blocks_(form_.blocks()),
        order_(order_of(options.sweep_order, blocks_.size())),
        lambda_of_(blocks_.size()),
        w_(vector_n()),
        x_(vector_n()) {
    form_.inverse_mass(w_);
  }

 private:
  static constexpr int columns = ComplianceForm::most_coordinates;
  using Rows = std::array<double, ComplianceForm::most_rows>;

  Status step(double t, double h) override {
    if (const Status s = form_.rest(t, q_, v_, x_); s != Status::ok) return s;
    ++dynamics_.stats.residuals;
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] = q_[i] + h * (v_[i] + h * x_[i]);
    for (Rows& lambda : lambda_of_) lambda.fill(0);
    for (int sweep = 0; sweep < options_.sweeps; ++sweep) {
      for (const std::size_t k : order_) correct(t + h, h, k);
      ++dynamics_.stats.sweeps;
    }
    for (std::size_t i = 0; i < x_.size(); ++i) v_[i] = (x_[i] - q_[i]) / h;
    q_.swap(x_);
    return Status::ok;
  }

  void correct(double t, double h, std::size_t k) {
    switch (blocks_[k].rows) {
      case 1:
        return correct_rows<1>(t, h, k);
      case 2:
        return correct_rows<2>(t, h, k);
      case 3:
        return correct_rows<3>(t, h, k);
      case 4:
        return correct_rows<4>(t, h, k);
      default:
        return correct_rows<5>(t, h, k);
    }
  }

  /// Rows of methods.h's equation divided by 1 + gamma: symmetric, positive definite.
  /// Columns beyond the block's have no inverse mass and do nothing.
  template <int rows>
  void correct_rows(double t, double h, std::size_t k) {
    const Block& block = blocks_[k];
    const std::size_t size = block.coordinates.size();
    Eigen::Array<double, columns, 1> x, moved, w;
    w.setZero();
    moved.setZero();
    for (std::size_t i = 0; i < size; ++i) {
      const auto from = static_cast<std::size_t>(block.coordinates[i]);
      const auto to = static_cast<Eigen::Index>(i);
      x(to) = x_[from];
      moved(to) = x_[from] - q_[from];
      w(to) = w_[from];
    }
    form_.evaluate(t, k, {x.data(), size}, value_);
    const Eigen::Map<const Eigen::Matrix<double, rows, columns, Eigen::RowMajor>> slope(
        value_.gradient[0]);
    const Eigen::Matrix<double, rows, columns> weighted = slope * w.matrix().asDiagonal();
    Eigen::Matrix<double, rows, rows> matrix = weighted * slope.transpose();
    Eigen::Matrix<double, rows, 1> change = slope * moved.matrix();
    Rows& lambda = lambda_of_[k];
    for (int r = 0; r < rows; ++r) {
      const auto row = static_cast<std::size_t>(r);
      const double alpha = block.alpha[row] / (h * h);
      const double gamma = block.alpha[row] * block.friction[row] / h;
      matrix(r, r) += alpha / (1 + gamma);
      change(r) = -(value_.c[r] + alpha * lambda[row] +
                    gamma * (change(r) + h * value_.drift[r])) /
                  (1 + gamma);
    }
    const Eigen::Matrix<double, rows, 1> more = matrix.llt().solve(change);
    const Eigen::Matrix<double, columns, 1> correction = weighted.transpose() * more;
    for (std::size_t r = 0; r < rows; ++r)
      lambda[r] += more(static_cast<Eigen::Index>(r));
    for (std::size_t i = 0; i < size; ++i) {
      x_[static_cast<std::size_t>(block.coordinates[i])] +=
          correction(static_cast<Eigen::Index>(i));
    }
  }

  ComplianceForm& form_;
  const std::vector<Block>& blocks_;
  std::vector<std::size_t> order_;
  std::vector<Rows> lambda_of_;  // of the blocks, in this step
  std::vector<double> w_, x_;
  ComplianceForm::Value value_{};
};

}  // namespace

std::unique_ptr<Integrator> make_xpbd(System& system, const Options& options) {
  return std::make_unique<Xpbd>(system, options);
}

}  // namespace tress
