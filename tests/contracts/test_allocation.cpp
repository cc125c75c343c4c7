#include <gtest/gtest.h>

#include <cstdlib>

#include "contract/forms/compliance_form.h"
#include "integrators/catalogue.h"
#include "integrators/formulation/dynamics.h"
#include "models/effects/linear_drag.h"
#include "models/motion/root_motion.h"
#include "models/reduced/four_strands.h"
#include "tests/support/catalogue_cases.h"

// Counts heap allocations by standing in for malloc and realloc; the sanitizers have
// their own malloc, so there the test is skipped.
namespace {
long allocations = 0;
}  // namespace

#ifndef __SANITIZE_ADDRESS__
extern "C" {
void* __libc_malloc(std::size_t size);                  // NOLINT: glibc's names
void* __libc_realloc(void* pointer, std::size_t size);  // NOLINT
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* realloc(void* pointer, std::size_t size) {
  ++allocations;
  return __libc_realloc(pointer, size);
}
}
#endif

namespace tress {

using namespace integrators;
using namespace models;
namespace {

using namespace testing_support;

class Allocation : public testing::TestWithParam<CatalogueCase> {
 protected:
  void SetUp() override {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizer owns malloc";
#endif
  }
};

template <class F>
long count(F f) {
  const long before = allocations;
  f();
  return allocations - before;
}

TEST(RootMotionAllocation, PosesAllocateNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer owns malloc";
#endif
  RootMotion motion;
  motion.centre = Vec{-0.1, 0, 0};
  motion.rotations = {{{0, 0, 1}, sine(0.5, 3)}, {{1, 0, 0}, one_minus_cosine(0.2, 1)}};
  motion.translations = {{{0, 1, 0}, sum(smooth_step(1, 0, 1), stop(2, 0, 1))}};
  EXPECT_EQ(count([&motion] { EXPECT_NE(motion.at(0.3).v.y, 0); }), 0);
}

TEST(BatchAllocation, StepsAllocateNothingAfterTheFirst) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer owns malloc";
#endif
  Material material;
  material.internal_friction = 1e-8;
  const Strand strand =
      make_strand(material, {}, {.elements = 5, .length = 0.1}, uniform_shape({0, 5, 0}));
  const std::vector<Strand> strands(3, strand);
  const std::vector<Effects> drag(3, {std::make_shared<LinearDrag>(1e-5)});
  ReducedOptions reduced;
  reduced.jacobian = ReducedJacobian::elastic;
  for (const Unknown unknown : {Unknown::curvature, Unknown::joint_angle}) {
    const auto batch = four_strands(strands, unknown, reduced, drag);
    States s(*batch);
    Options options;
    options.step = 1e-4;
    const auto integrator = make_integrator("linearly_implicit_euler", *batch, options);
    ASSERT_EQ(integrator->start(0, s.q, s.v), Status::ok);
    ASSERT_EQ(integrator->advance(1e-4), Status::ok);
    EXPECT_EQ(count([&] { EXPECT_EQ(integrator->advance(1e-3), Status::ok); }), 0);
  }
}

TEST_P(Allocation, TheGuardSeesAnAllocation) {
  EXPECT_GT(count([] {
              std::vector<double> x(100);
              EXPECT_EQ(x[7], 0);
            }),
            0);
}

TEST_P(Allocation, ModelCallsAllocateNothingAfterTheFirst) {
  const auto system = GetParam().make();
  States s(*system);
  s.shake(0.01);
  std::vector<double> r(s.n), x(s.n);
  const auto once = [&] {
    (void)system->residual(0.01, s.q, s.v, s.a, r);
    if (!system->traits().regular_mass) return;
    (void)system->linearize(0.01, s.q, s.v, s.a, {1, 0.1, 0.01});
    (void)system->solve(r, x);
  };
  once();
  EXPECT_EQ(count(once), 0);
}

TEST_P(Allocation, DynamicsAllocateNothingAfterTheFirstSolve) {
  const auto system = GetParam().make();
  States s(*system);
  Options options;
  if (s.m > 0) options.formulation = Formulation::baumgarte;
  Dynamics dynamics(*system, options);
  std::vector<double> a(s.n), lambda(s.m), r(s.n), c(s.m);
  bool redundant = false;
  const auto once = [&] {
    (void)dynamics.accelerate(0, s.q, s.v, a, lambda);
    (void)dynamics.residual(0, s.q, s.v, a, lambda, r, c);
    (void)dynamics.linearize(0, s.q, s.v, a, lambda, {1, 1e-3, 1e-6});
    (void)dynamics.solve(r, c);
    redundant = dynamics.stats.rank_deficiency > 0;
  };
  once();
  once();  // the second matrix is the first to be refactored
  if (redundant) GTEST_SKIP() << "redundant constraints are analysed anew each time";
  EXPECT_EQ(count(once), 0);
}

TEST_P(Allocation, ComplianceFormAllocatesNothing) {
  const auto system = GetParam().make();
  ComplianceForm* form = system->compliance_form();
  if (form == nullptr) GTEST_SKIP() << "no compliance form";
  States s(*system);
  ComplianceForm::Value value;
  ComplianceForm::Second second = {};
  std::vector<double> x(ComplianceForm::most_oriented, 0.1);
  std::vector<double> y = x;
  const auto once = [&] {
    (void)form->rest(0, s.q, s.v, s.a);
    form->inverse_mass(s.a);
    for (std::size_t k = 0; k < form->blocks().size(); ++k) {
      const In at = In(x).first(form->blocks()[k].coordinates.size());
      form->evaluate(0, k, at, value);
      (void)form->add_second(0, k, at, value.c, second);
    }
    for (std::size_t k = 0; k < form->orientations().size(); ++k) {
      const InOut at = InOut(y).first(form->orientations()[k].coordinates.size());
      form->orient(0, 1e-3, k, In(x).first(at.size()), at);
    }
  };
  EXPECT_EQ(count(once), 0);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Allocation, testing::ValuesIn(catalogue_cases()),
                         [](const auto& test) { return test.param.name(); });

}  // namespace
}  // namespace tress
