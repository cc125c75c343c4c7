#include "tests/models/maximal/clamped_modes.h"

// A source of its own: Eigen's decompositions take the compiler half a minute.
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace tress::testing_support {
namespace {

/// Gradients of the constraints, one a column (n x m).
Eigen::MatrixXd dense_gradient(System& system, In q) {
  const Layout layout = system.layout();
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(layout.coordinates, layout.constraints);
  ConstraintForm* form = system.constraint_form();
  if (form == nullptr) return g;
  const Pattern& p = form->pattern();
  std::vector<double> values(static_cast<std::size_t>(p.nonzeros()));
  EXPECT_EQ(form->gradient(0, q, values), Status::ok);
  for (int j = 0; j < p.cols; ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (int k = p.start[column]; k < p.start[column + 1]; ++k) {
      const auto at = static_cast<std::size_t>(k);
      g(p.row[at], j) = values[at];
    }
  }
  return g;
}

}  // namespace

Eigen::MatrixXd dense_tangent(System& system, In q, Weights w) {
  SparseForm& form = *system.sparse_form();
  const Pattern& p = form.pattern();
  const std::vector<double> zero = zeros(system);
  std::vector<double> values(static_cast<std::size_t>(p.nonzeros()));
  EXPECT_EQ(form.values(0, q, zero, zero, w, values), Status::ok);
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(p.rows, p.cols);
  for (int j = 0; j < p.cols; ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (int k = p.start[column]; k < p.start[column + 1]; ++k) {
      const auto at = static_cast<std::size_t>(k);
      s(p.row[at], j) = values[at];
    }
  }
  return s;
}

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

std::vector<double> lowest_frequencies(std::string_view model,
                                       const ModelSettings& settings, int count) {
  const auto system = make_model(model, settings);
  std::vector<double> q = zeros(*system), v = q;
  system->initial_state(q, v);
  const Eigen::MatrixXd g = dense_gradient(*system, q);
  const Eigen::MatrixXd basis =
      Eigen::MatrixXd(Eigen::HouseholderQR<Eigen::MatrixXd>(g).householderQ())
          .rightCols(g.rows() - g.cols());
  const Eigen::MatrixXd mass =
      basis.transpose() * dense_tangent(*system, q, {1, 0, 0}) * basis;
  const Eigen::MatrixXd stiffness =
      basis.transpose() * dense_tangent(*system, q, {0, 0, 1}) * basis;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(
      mass, stiffness, Eigen::EigenvaluesOnly);
  const Eigen::VectorXd& squares = modes.eigenvalues();  // ascending
  std::vector<double> frequencies;
  for (int mode = 1; mode <= count; ++mode) {
    frequencies.push_back(1 / std::sqrt(squares[squares.size() - mode]));
  }
  return frequencies;
}

std::vector<double> bending_frequencies(std::string_view model,
                                        const ModelSettings& settings) {
  const std::vector<double> all = lowest_frequencies(model, settings, 6);
  std::vector<double> frequencies;
  for (std::size_t k = 0; k < all.size(); k += 2) {
    EXPECT_NEAR(all[k + 1] / all[k], 1, 1e-6) << "no pair of bending modes";
    frequencies.push_back(all[k]);
  }
  return frequencies;
}

}  // namespace tress::testing_support
