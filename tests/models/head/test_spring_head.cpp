#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "contract/forms/energetics.h"
#include "contract/input_error.h"
#include "models/effects/constant_force.h"
#include "tests/models/head/arrangements.h"
#include "tests/models/head/mixed_hairs.h"
#include "tests/models/head/spring_strands.h"

/// Heads of springs by linearly_implicit_euler; by the other methods in
/// test_spring_methods.cpp.
namespace tress::test_spring_head {

using namespace simulation;
using namespace testing_support;

std::unique_ptr<Head> head(const RodCase& c, const HeadPack& pack, std::size_t strands,
                           const Effects& effects = {}) {
  return springs(c, one_solve, pack, strands, effects);
}
std::unique_ptr<System> system_alone(const RodCase& c, std::size_t k,
                                     const Effects& more = {}) {
  return spring_alone(rod(c, k), rod_options(c), one_solve, more);
}
SpringAlone alone(const RodCase& c, std::size_t k, int steps, double h, double change) {
  return spring_alone(c, one_solve, k, steps, h, change);
}

class SpringHead : public testing::TestWithParam<RodCase> {};

// Both eliminate the same matrices in other orders, from other unknowns. As for discrete
// rods (test_der_head.cpp), strands differ by no more than a relative change of the
// initial state by 1e-11 makes, and by roundings of what they are.
TEST_P(SpringHead, StrandsMoveAsTheyDoAlone) {
  const RodCase& c = GetParam();
  // Forty edges amplify by 1e7 in twenty steps of that length.
  const int steps = c.elements > 20 ? 5 : 60;
  constexpr double h = 1e-3;
  constexpr std::size_t strands = 10;
  const auto all = head(c, longest_doubles(), strands);
  advance_springs(*all, steps, h);
  const auto n = static_cast<std::size_t>(3 * c.elements);
  std::vector<double> q(n), v(n), u;
  const std::vector<double> x = spring_points(*all, steps * h, u);
  for (std::size_t k = 0; k < strands; ++k) {
    SCOPED_TRACE(k);
    EXPECT_FALSE(all->lost(k));
    all->state(k, q, v);
    const SpringAlone want = alone(c, k, steps, h, 0),
                      changed = alone(c, k, steps, h, 1e-11);
    const double rate = 60;
    EXPECT_LE(apart(q, want.q), apart(changed.q, want.q) + 1e-13);
    EXPECT_LE(apart(v, want.v), apart(changed.v, want.v) + 1e-13 * rate);
    EXPECT_LE(apart(In(x).subspan(k * (n + 3), n + 3), want.x),
              apart(changed.x, want.x) + 1e-13);
    EXPECT_GT(apart(want.x, alone(c, k, 0, h, 0).x), 1e-4);  // or this says nothing
  }
}

TEST_P(SpringHead, EnergiesAndVelocitiesAreThoseOfTheStrandsAlone) {
  const RodCase& c = GetParam();
  constexpr int steps = 20;
  constexpr double h = 1e-3, t = steps * h;
  const auto all = head(c, longest_doubles(), 8);
  advance_springs(*all, steps, h);
  std::vector<HeadEnergy> each(8);
  for (std::size_t b = 0, k = 0; b < all->blocks(); k += all->strands_of(b++)) {
    all->energies(b, t, std::span(each).subspan(k, all->strands_of(b)));
  }
  std::vector<double> v;
  const std::vector<double> x = spring_points(*all, t, v);
  const auto n = static_cast<std::size_t>(3 * c.elements);
  for (std::size_t k = 0; k < 8; ++k) {
    SCOPED_TRACE(k);
    // In the head's own state: nodes from the root on, and their velocities.
    const In nodes = In(x).subspan(k * (n + 3) + 3, n),
             rates = In(v).subspan(k * (n + 3) + 3, n);
    const Energy want = system_alone(c, k)->energetics()->energy(t, nodes, rates);
    EXPECT_GT(want.kinetic, 0);
    EXPECT_NEAR(each[k].kinetic, want.kinetic, 1e-12 * want.kinetic);
    // Nodes are rounded by 1e-16 of the metres to the origin, edges of 1e-5 stretch by
    // 1e-11 of themselves then: their energy by 1e-6.
    const double weight = rod(c, k).mass() * 9.9 * 2;
    EXPECT_NEAR(each[k].elastic + each[k].gravity, want.potential,
                1e-12 * weight + 1e-6 * each[k].elastic);
    EXPECT_GT(each[k].elastic, 0);
    double fastest = 0;
    for (std::size_t i = 0; i < n + 3; i += 3) {
      fastest = std::max(fastest, norm(load3(&v[k * (n + 3) + i])));
    }
    EXPECT_NEAR(each[k].fastest, fastest, 1e-12 * fastest);
    EXPECT_LE(norm(each[k].tip - load3(&x[(k + 1) * (n + 3) - 3])), 1e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, SpringHead, testing::ValuesIn(spring_cases),
                         [](const auto& of) { return of.param.name; });

class SpringHeadOnBodies : public testing::TestWithParam<SpringBodies> {};

using Dense = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// S^-1 r of the strand by itself at (t, q, v, 0), where the bodies enter S by what their
/// derivatives and drag have that is symmetric and semidefinite, as in all heads.
Eigen::VectorXd wanted_correction(const RodCase& c, std::size_t k, const Effects& bodies,
                                  Weights w, double t, In q, In v) {
  const std::size_t n = q.size();
  const auto bare = system_alone(c, k), loaded = system_alone(c, k, bodies);
  std::vector<double> a(n, 0.0), r(n), unit(n), column(n);
  EXPECT_EQ(loaded->residual(t, q, v, a, r), Status::ok);
  EXPECT_EQ(bare->linearize(t, q, v, a, w), Status::ok);
  Dense inverse(n, n);
  for (std::size_t j = 0; j < n; ++j) {
    std::ranges::fill(unit, 0.0);
    unit[j] = 1;
    EXPECT_EQ(bare->solve(unit, column), Status::ok);
    for (std::size_t i = 0; i < n; ++i) {
      inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = column[i];
    }
  }
  const Strand strand = rod(c, k);
  const Segment& first = strand.segments.front();
  const double edge = first.length,
               density = strand.material.density * first.section.area();
  const std::size_t nodes = n / 3;
  std::vector<double> length(nodes, edge), mass(nodes), blocks(3 * n, 0.0);
  length.back() = edge / 2;
  for (std::size_t i = 0; i < nodes; ++i) mass[i] = density * length[i];
  const Points at{static_cast<int>(nodes), q, v, {}, mass, length};
  for (const auto& body : bodies) body->add_derivatives(t, at, -w.pos, -w.vel, blocks);
  Dense change = Dense::Zero(inverse.rows(), inverse.cols());
  const HeadOptions o = rod_options(c);
  for (std::size_t i = 0; i < nodes; ++i) {
    Eigen::Matrix3d b =
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&blocks[9 * i]);
    if (b.isZero(0)) continue;
    const double drag = w.vel * (o.drag + o.mass_damping * density) * length[i];
    b = 0.5 * (b + b.transpose().eval()) + drag * Eigen::Matrix3d::Identity();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(b);
    b = parts.eigenvectors() * parts.eigenvalues().cwiseMax(0.0).asDiagonal() *
            parts.eigenvectors().transpose() -
        drag * Eigen::Matrix3d::Identity();
    const auto place = static_cast<Eigen::Index>(3 * i);
    change.block<3, 3>(place, place) = b;
  }
  // (S + B)^-1 r = (1 + S^-1 B)^-1 S^-1 r.
  const Dense one = Dense::Identity(inverse.rows(), inverse.cols());
  return (one + inverse * change)
      .partialPivLu()
      .solve(inverse * Eigen::Map<const Eigen::VectorXd>(r.data(), inverse.rows()));
}

// Each step from the head's own state. Roundings of 1e-16 of the metres to the origin by
// which the head's places are read, times the stiffness of stretching, up to 1e5 of that
// of a node's mass at these steps, and the norm of the inverse: 1e-9 of the largest.
TEST_P(SpringHeadOnBodies, StepsAreThoseOfTheStrandsAlone) {
  const RodCase c = case_of(GetParam());
  const Effects bodies = effects_of(GetParam(), c);
  constexpr std::size_t strands = 6;
  constexpr double h = 1e-3;
  const auto all = head(c, {HeadNumber::float64, 4}, strands, bodies),
             bare = head(c, {HeadNumber::float64, 4}, strands);
  const auto scratch = all->scratch();
  const auto n = static_cast<std::size_t>(3 * c.elements);
  std::vector<double> u, new_u;
  int touched = 0;
  for (int s = 0; s < 8; ++s) {
    const double t = s * h;
    const std::vector<double> x = spring_points(*all, t, u);
    all->step(0, all->blocks(), t, h, *scratch);
    const std::vector<double> new_x = spring_points(*all, t + h, new_u);
    for (std::size_t k = 0; k < strands; ++k) {
      SCOPED_TRACE(k);
      std::vector<double> q(n), v(n);
      for (std::size_t i = 0; i < n; ++i) {
        v[i] = u[k * (n + 3) + 3 + i];
        q[i] = x[k * (n + 3) + 3 + i] + h * v[i];
      }
      const auto step = [&](const Effects& by) {
        return wanted_correction(c, k, by, {1, h, h * h}, t + h, q, v);
      };
      const Eigen::VectorXd want = step(bodies);
      const double most = want.cwiseAbs().maxCoeff();
      touched += (step({}) - want).cwiseAbs().maxCoeff() > 1e-3 * most ? 1 : 0;
      for (std::size_t i = 0; i < n; ++i) {
        const double got = (v[i] - new_u[k * (n + 3) + 3 + i]) / h;
        EXPECT_NEAR(got, want(static_cast<Eigen::Index>(i)), 1e-9 * most) << i;
      }
    }
  }
  EXPECT_GE(touched, 8);  // or this says little
}

TEST_P(SpringHeadOnBodies, LanesAndInstructionsGiveTheSameBits) {
  const RodCase c{.name = "", .elements = GetParam().elements, .moves = GetParam().moves};
  const Effects bodies = effects_of(GetParam(), c);
  std::size_t want = 0;
  for (const HeadPack& pack : packs_of_build(false)) {
    const auto all = head(c, pack, 19, bodies);
    advance_springs(*all, 60, 5e-4);
    if (want == 0) want = all->hash();
    EXPECT_EQ(all->hash(), want) << pack.lanes;
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, SpringHeadOnBodies, testing::ValuesIn(spring_bodies),
                         [](const auto& of) { return of.param.name; });

TEST(SpringHeadKept, GoesOnWithTheSameBitsInAHeadOfOtherLanes) {
  const RodCase c{.name = "", .moves = true};
  const auto first = head(c, {HeadNumber::float64, 4}, 11),
             second = head(c, {HeadNumber::float64, 1}, 11);
  advance_springs(*first, 20, 1e-3);
  EXPECT_NE(second->hash(), first->hash());
  recall(*second, kept_of(*first));
  for (Head* of : {first.get(), second.get()}) {
    const auto scratch = of->scratch();
    for (int s = 20; s < 60; ++s) of->step(0, of->blocks(), s * 1e-3, 1e-3, *scratch);
  }
  EXPECT_EQ(second->hash(), first->hash());
}

// 11 of 64 strands cannot be computed: the others move as they do without them.
TEST(SpringHeadWithLosses, OtherStrandsGoOn) {
  const RodCase c{""};
  const auto fails = [](std::size_t k) { return k % 6 == 1; };
  for (const HeadPack& pack : packs_of_build(false)) {
    const auto sound = head(c, pack, 64), hurt = spring_head(rod_options(c), pack);
    for (std::size_t k = 0; k < 64; ++k) {
      Strand one = rod(c, k);
      if (fails(k)) {
        for (Segment& s : one.segments) s.natural = {1e200, -1e200, 1e200};
      }
      hurt->add(one);
    }
    advance_springs(*sound, 10, 2e-3);
    advance_springs(*hurt, 10, 2e-3);
    std::vector<double> q(30), v(30), want_q(30), want_v(30);
    for (std::size_t k = 0; k < 64; ++k) {
      ASSERT_EQ(hurt->lost(k), fails(k)) << k;
      hurt->state(k, q, v);
      sound->state(k, want_q, want_v);
      if (fails(k)) {
        EXPECT_EQ(v, std::vector<double>(30)) << k;
      } else {
        EXPECT_EQ(q, want_q) << k;
        EXPECT_EQ(v, want_v) << k;
      }
    }
    EXPECT_EQ(hurt->losses().size(), 11U);
  }
}

TEST(SpringHeadMemory, IsTheState) {
  const auto all = head({""}, longest_doubles(), 16);
  // q, v and rest strains of each edge; root and material.
  EXPECT_LE(all->bytes(), 16U * (10 * 8 + 20) * sizeof(double));
}

TEST(SpringHeadInput, IsRefusedWithTheReason) {
  const RodCase c{""};
  HeadOptions options = rod_options(c);
  options.method = HeadMethod::tr_bdf2;
  options.tolerance = 1e-12;
  EXPECT_THROW(spring_head(options, {}), InputError);
  EXPECT_THROW(spring_head(rod_options(c), {HeadNumber::float64, 16}), InputError);
  EXPECT_THROW(spring_head(rod_options(c), {HeadNumber::float32, 8}), InputError);
  const auto push = std::make_shared<ConstantForce>(Vec{1e-4, 0, 0}, Vec{1, 2, 3});
  EXPECT_THROW(head(c, {}, 1, {push}), InputError);
  const auto all = head(c, {}, 1);
  EXPECT_THROW(all->add(rod(c, 0), {push}), InputError);
}

}  // namespace tress::test_spring_head
