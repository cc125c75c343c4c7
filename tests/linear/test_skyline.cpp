#include <gtest/gtest.h>

#include <random>

#include "linear/skyline.h"

namespace tress::test_skyline {

const std::vector<std::size_t> profile{0, 0, 2, 1, 0, 3, 3};

/// Rows of a symmetric matrix of that profile, diagonally dominant by `dominance`.
std::vector<std::vector<double>> rows_of(double dominance) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const std::size_t n = profile.size();
  std::vector<std::vector<double>> rows(n, std::vector<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = profile[i]; j < i; ++j)
      rows[i][j] = rows[j][i] = uniform(random);
    rows[i][i] = dominance;
  }
  return rows;
}

Skyline matrix_of(const std::vector<std::vector<double>>& rows) {
  Skyline matrix(profile);
  matrix.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = profile[i]; j <= i; ++j) matrix.at(i, j) = rows[i][j];
  }
  return matrix;
}

TEST(Skyline, SolvesWhatIsPositiveDefinite) {
  const auto rows = rows_of(7);  // above the sum of the others in every row
  Skyline matrix = matrix_of(rows);
  std::vector<double> x{1, -2, 3, -4, 5, -6, 7}, b(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < x.size(); ++j) b[i] += rows[i][j] * x[j];
  }
  ASSERT_TRUE(matrix.factor());
  matrix.solve(b);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(b[i], x[i], 1e-14);
}

TEST(Skyline, AddsAndRefusesWhatIsNot) {
  Skyline indefinite = matrix_of(rows_of(0.5));
  EXPECT_FALSE(indefinite.factor());
  Skyline sum = matrix_of(rows_of(0.5));
  auto diagonal = rows_of(0);
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    diagonal[i].assign(diagonal.size(), 0);
    diagonal[i][i] = 6;
  }
  sum.add(matrix_of(diagonal));
  EXPECT_TRUE(sum.factor());
  Skyline none = matrix_of(std::vector(profile.size(), std::vector<double>(7, NAN)));
  EXPECT_FALSE(none.factor());
}

}  // namespace tress::test_skyline
