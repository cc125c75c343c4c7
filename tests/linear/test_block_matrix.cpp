#include <gtest/gtest.h>

#include "linear/block_matrix.h"
#include "tests/linear/matrices.h"

namespace tress::test_block_matrix {

using testing_matrices::dense;
using testing_matrices::Random;
using testing_matrices::Sparse;
using testing_matrices::sparse;

// Numbers are multiples of 1/4 below 100, so sums are exact.
Eigen::MatrixXd exact(const Eigen::MatrixXd& a) {
  return a.unaryExpr([](double x) { return std::round(4 * x) / 4; });
}

TEST(BlockMatrix, OverlappingAndTransposedBlocksAddUp) {
  Random random(1);
  const Eigen::MatrixXd a = exact(random.thinned(4, 4, 0.6));
  const Eigen::MatrixXd g = exact(random.thinned(4, 2, 0.7));
  const Sparse sa = sparse(a), sg = sparse(g);
  BlockMatrix matrix(6, 6);
  const int first = matrix.add_block(sa.pattern, 0, 0);
  const int shifted = matrix.add_block(sa.pattern, 1, 2);
  const int right = matrix.add_block(sg.pattern, 0, 4);
  const int below = matrix.add_block(sg.pattern, 4, 0, true);
  matrix.finish();

  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(6, 6);
  expected.block(0, 0, 4, 4) += 2 * a;
  expected.block(1, 2, 4, 4) -= a;
  expected.block(0, 4, 4, 2) -= g;
  expected.block(4, 0, 2, 4) += g.transpose();
  for (int pass = 0; pass < 2; ++pass) {  // the second starts from clear()
    matrix.clear();
    matrix.add(first, 2, sa.values);
    matrix.add(shifted, -1, sa.values);
    matrix.add(right, -1, sg.values);
    matrix.add(below, 1, sg.values);
    EXPECT_EQ(dense(matrix.pattern(), matrix.values()), expected);
  }
}

TEST(BlockMatrix, RowsAscendWithoutRepetition) {
  BlockMatrix matrix(5, 5);
  matrix.add_block(identity_pattern(5), 0, 0);
  matrix.add_block(identity_pattern(3), 2, 0);
  matrix.add_block(identity_pattern(3), 1, 1);
  matrix.finish();
  const Pattern& p = matrix.pattern();
  EXPECT_EQ(p.nonzeros(), 8);
  for (std::size_t j = 0; j < 5; ++j) {
    for (int k = p.start[j] + 1; k < p.start[j + 1]; ++k) {
      EXPECT_LT(p.row[static_cast<std::size_t>(k - 1)],
                p.row[static_cast<std::size_t>(k)]);
    }
  }
}

TEST(BlockMatrix, RefusesABlockThatSticksOut) {
  BlockMatrix matrix(4, 4);
  EXPECT_THROW(matrix.add_block(identity_pattern(3), 2, 0), std::invalid_argument);
  EXPECT_THROW(matrix.add_block(identity_pattern(3), 0, -1), std::invalid_argument);
}

}  // namespace tress::test_block_matrix
