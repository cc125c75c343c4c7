// Which strands a batch takes, and what it makes of those that are not chains.
#include "contract/input_error.h"
#include "tests/models/reduced/batch_strands.h"

namespace tress::test_batch_strands {

using namespace simulation;

using namespace testing_support;

class BatchOf : public testing::Test {
 protected:
  BatchOf() { options.jacobian = ReducedJacobian::elastic; }
  void expect_refused(const char* what) {
    try {
      super_helix_batch(strands, options, acting);
      ADD_FAILURE() << "not refused";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  }

  ReducedOptions options;
  std::vector<Strand> strands{strand(0, 3), strand(1, 3)};
  std::vector<Effects> acting{{}, {}};
};

TEST_F(BatchOf, FiveStrandsIsRefused) {
  strands.resize(5, strand(0, 3));
  acting.resize(5);
  expect_refused("5 strands");
}
TEST_F(BatchOf, NoStrandsIsRefused) {
  strands.clear();
  acting.clear();
  expect_refused("0 strands");
}
TEST_F(BatchOf, FewerEffectsThanStrandsIsRefused) {
  acting.pop_back();
  expect_refused("1 lists of effects for 2 strands");
}
TEST_F(BatchOf, ExactTangentsIsRefused) {
  options.jacobian = ReducedJacobian::exact;
  expect_refused("elastic Jacobian");
}
TEST_F(BatchOf, DenseSolversIsRefused) {
  options.method = TreeMethod::composite;
  expect_refused("recursively");
}
TEST_F(BatchOf, AFreeRootIsRefused) {
  strands[1].free_root.emplace();
  expect_refused("free root");
}
TEST_F(BatchOf, DifferentSegmentsIsRefused) {
  strands[1].segments.pop_back();
  expect_refused("different segments");
}

// 4 points would do for the first; the second winds by 2.4 rad a segment.
TEST_F(BatchOf, AllStrandsHaveThePointsOfTheOneThatNeedsMost) {
  for (Segment& segment : strands[1].segments) segment.natural.y = 2.4 / segment.length;
  const auto batch = super_helix_batch(strands, options, acting);
  options.quadrature = 8;
  const auto with_eight = super_helix_batch(strands, options, acting);
  States s(*batch);
  s.shake(1);
  EXPECT_EQ(residual(*batch, s.q, s.v, s.a), residual(*with_eight, s.q, s.v, s.a));
}

// Branches off the way of their parents: with mounts, and several children.
TEST_F(BatchOf, TreesIsThatOfTheTrees) {
  for (Strand& tree : strands) {
    const double side = &tree == &strands[0] ? 1 : -1;
    tree.segments[3].parent = 1;
    tree.segments[3].mount = rotation({0, 0.6, 0.8}, side);
    tree.segments[5].mount = rotation({1, 0, 0}, 0.5 * side);
  }
  strands[1].segments[5].mount = Frame{};  // one lane with a mount, one without
  const auto batch = super_helix_batch(strands, options, acting);
  States s(*batch);
  s.shake(1);
  const std::vector<double> got = residual(*batch, s.q, s.v, s.a);
  std::vector<double> x(s.n);
  ASSERT_EQ(batch->linearize(t0, s.q, s.v, s.a, backward_euler), Status::ok);
  ASSERT_EQ(batch->solve(got, x), Status::ok);
  const std::size_t n = s.n / 2;
  for (std::size_t k = 0; k < 2; ++k) {
    SCOPED_TRACE(k);
    const auto alone = super_helix(strands[k], options, {});
    const auto part = [&](const std::vector<double>& of) {
      return std::vector<double>(of.begin() + static_cast<std::ptrdiff_t>(k * n),
                                 of.begin() + static_cast<std::ptrdiff_t>((k + 1) * n));
    };
    const std::vector<double> zero(n);
    const auto want = residual(*alone, part(s.q), part(s.v), part(s.a));
    const auto at_rest = residual(*alone, part(s.q), part(s.v), zero);
    EXPECT_LE(apart(part(got), want), rounding * (largest(want) + 2 * largest(at_rest)));
    ASSERT_EQ(alone->linearize(t0, part(s.q), part(s.v), zero, backward_euler),
              Status::ok);
    std::vector<double> y = part(got);
    ASSERT_EQ(alone->solve(y, y), Status::ok);
    EXPECT_LE(apart(part(x), y), rounding * condition(inverse(*alone, n)) * largest(y));
  }
}

}  // namespace tress::test_batch_strands
