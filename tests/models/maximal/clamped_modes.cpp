#include "tests/models/maximal/clamped_modes.h"

#include "experiments/numerics/dense_form.h"
#include "experiments/numerics/small_motions.h"

namespace tress::testing_support {

using namespace experiments;

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

std::vector<double> lowest_frequencies(std::string_view model,
                                       const ModelSettings& settings, int count) {
  const auto system = make_model(model, settings);
  std::vector<double> q = zeros(*system), v = q, typical = q;
  system->initial_state(q, v);
  system->scale(typical, v);
  const Eigen::MatrixXd held = dense_gradient(*system, 0, q);
  const std::vector<SmallMotion> motions =
      small_motions(dense_mass(*system, 0, q), dense_stiffness(*system, 0, q), held,
                    held.transpose(), typical);
  std::vector<double> frequencies;
  frequencies.reserve(static_cast<std::size_t>(count));
  for (int mode = 0; mode < count; ++mode) {
    frequencies.push_back(std::sqrt(motions[static_cast<std::size_t>(mode)].square));
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
