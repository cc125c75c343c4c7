// Which strands a batch takes.
#include "models/reduced/four_strands.h"
#include "tests/models/reduced/batch_strands.h"

namespace tress::test_batch_strands {

using namespace simulation;

using namespace testing_support;

class BatchOf : public testing::Test {
 protected:
  BatchOf() { options.jacobian = ReducedJacobian::elastic; }
  std::unique_ptr<System> batch(Unknown unknown = Unknown::curvature) const {
    return four_strands(strands, unknown, options, acting);
  }

  ReducedOptions options;
  std::vector<Strand> strands{strand(0, 3), strand(1, 3)};
  std::vector<Effects> acting{{}, {}};
};

TEST_F(BatchOf, ExactTangentsIsNone) {
  ASSERT_NE(batch(), nullptr);
  options.jacobian = ReducedJacobian::exact;
  EXPECT_EQ(batch(), nullptr);
}
TEST_F(BatchOf, OtherSolversIsNone) {
  options.method = TreeMethod::composite;
  EXPECT_EQ(batch(), nullptr);
}
TEST_F(BatchOf, OneModeIsNone) {
  strands = {strand(0, 1), strand(1, 1)};
  options.dofs = 1;
  EXPECT_EQ(batch(), nullptr);
}
TEST_F(BatchOf, AFreeRootIsNone) {
  strands[1].free_root.emplace();
  EXPECT_EQ(batch(), nullptr);
}
TEST_F(BatchOf, DifferentSegmentsIsNone) {
  strands[1].segments.pop_back();
  EXPECT_EQ(batch(), nullptr);
}
TEST_F(BatchOf, TreesIsNone) {
  for (Strand& tree : strands) tree.segments[3].parent = 1;
  EXPECT_EQ(batch(), nullptr);
}
TEST_F(BatchOf, BranchesOffTheWayOfTheirParentsIsNone) {
  strands[1].segments[5].mount = rotation({0, 0.6, 0.8}, 1);
  EXPECT_EQ(batch(), nullptr);
}

// 4 points would do for the first; the second winds by 2.4 rad a segment.
TEST_F(BatchOf, AllStrandsHaveThePointsOfTheOneThatNeedsMost) {
  for (Segment& segment : strands[1].segments) segment.natural.y = 2.4 / segment.length;
  const auto all = batch();
  options.quadrature = 8;
  const auto with_eight = batch();
  States s(*all);
  s.shake(1);
  EXPECT_EQ(residual(*all, s.q, s.v, s.a), residual(*with_eight, s.q, s.v, s.a));
}

}  // namespace tress::test_batch_strands
