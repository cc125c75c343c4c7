// Chains whose joints are softer than the inertia of a step by seven digits and bent by
// more than pi: what hangs on a joint turns freely about it, so that the inertia which
// the joint passes on is a difference of numbers that are larger by as much.
#include <gtest/gtest.h>

#include <cmath>

#include "contract/forms/energetics.h"
#include "integrators/catalogue.h"
#include "models/effects/gravity.h"
#include "models/reduced/articulated_chain.h"
#include "simulation/head/make_head.h"
#include "tests/models/head/hairs.h"

namespace tress::test_soft_chain {
namespace {

using namespace simulation;

constexpr int elements = 2, steps = 60;
constexpr double step = 1.75e-3;  // s
const Vec gravity{0, 0, -9.81};

Strand strand(double modulus) {
  Material material;
  material.density = 8000;
  material.youngs_modulus = modulus;
  material.shear_modulus = modulus / 3;
  // Joints at rest turn by 4.4 and, at the clamp, 2.2 rad.
  const Vec natural{2, 14, -3};
  return make_strand(material, {2.6e-5, 5.1e-5},
                     {.elements = elements, .length = 0.6, .grading = 1},
                     uniform_shape(natural), uniform_shape(natural));
}

/// Kinetic and elastic energy of the strand by itself.
Energy alone(const Strand& strand, int dofs, TreeMethod method) {
  const auto system = articulated_chain(
      strand, {.dofs = dofs, .jacobian = ReducedJacobian::elastic, .method = method},
      {std::make_shared<Gravity>(gravity)});
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  std::vector<double> q(n), v(n);
  system->initial_state(q, v);
  Options options;
  options.step = step;
  const auto integrator =
      integrators::make_integrator("linearly_implicit_euler", *system, options);
  EXPECT_EQ(integrator->start(0, q, v), Status::ok);
  EXPECT_EQ(integrator->advance(steps * step), Status::ok);
  return system->energetics()->energy(steps * step, integrator->q(), integrator->v());
}

HeadEnergy in_head(const Strand& strand, int dofs, const HeadPack& pack) {
  HeadOptions options{{.elements = elements, .twist = dofs == 3, .longest = 0.6}};
  options.gravity = gravity;
  const auto head = chain_head(options, pack);
  head->add(strand);
  testing_support::advance(*head, steps, step);
  EXPECT_FALSE(head->lost(0));
  std::vector<HeadEnergy> each(1);
  head->energies(0, steps * step, each);
  return each[0];
}

class SoftChain : public testing::TestWithParam<int> {};

// Eliminations that exchange rows, and the two recursions by means of their own, are off
// by eps = 2e-16 times a condition of 1e4 in units of typical coordinates, in sixty steps
// that add up. Of single precision, eps = 1e-7, this leaves two digits.
TEST_P(SoftChain, MovesAlikeByAllSolversAndInHeads) {
  for (const double modulus : {1.7e6, 1.7e4, 1.7e9}) {
    SCOPED_TRACE(modulus);
    const Strand one = strand(modulus);
    const Energy want = alone(one, GetParam(), TreeMethod::composite);
    EXPECT_GT(want.kinetic, 0);
    for (const TreeMethod method : {TreeMethod::recursive, TreeMethod::sparse}) {
      const Energy other = alone(one, GetParam(), method);
      EXPECT_NEAR(other.kinetic, want.kinetic, 1e-9 * want.kinetic);
    }
    for (const HeadPack& pack : testing_support::packs_of_build()) {
      const HeadEnergy head = in_head(one, GetParam(), pack);
      const double off = pack.number == HeadNumber::float64 ? 1e-9 : 1e-2;
      EXPECT_NEAR(head.kinetic, want.kinetic, off * want.kinetic) << pack.lanes;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Unknowns, SoftChain, testing::Values(3, 2));

}  // namespace
}  // namespace tress::test_soft_chain
