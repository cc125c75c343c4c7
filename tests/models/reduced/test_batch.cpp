#include <gtest/gtest.h>

#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/material_points.h"
#include "contract/forms/natural_strains.h"
#include "integrators/catalogue.h"
#include "models/reduced/articulated_chain.h"
#include "models/reduced/four_strands.h"
#include "models/reduced/super_helix.h"
#include "tests/models/reduced/batch_strands.h"

namespace tress::test_batch {

using namespace simulation;

using namespace testing_support;

struct BatchCase {
  std::string name;
  Unknown unknown;
  decltype(super_helix)* alone;
  int dofs;
  int strands;
};

void PrintTo(const BatchCase& c, std::ostream* out) { *out << c.name; }  // NOLINT

class Batch : public testing::TestWithParam<BatchCase> {
 protected:
  Batch() {
    options.dofs = GetParam().dofs;
    options.jacobian = ReducedJacobian::elastic;
    options.quadrature = 8;
    std::vector<Strand> strands;
    std::vector<Effects> acting;
    for (int lane = 0; lane < GetParam().strands; ++lane) {
      strands.push_back(strand(lane, options.dofs));
      acting.push_back(effects(lane));
      swept.push_back(GetParam().alone(strands.back(), options, acting.back()));
      ReducedOptions general = options;
      general.method = TreeMethod::composite;
      alone.push_back(GetParam().alone(strands.back(), general, acting.back()));
    }
    batch = four_strands(strands, GetParam().unknown, options, acting);
    n = static_cast<std::size_t>(alone.front()->layout().coordinates);
  }

  /// Calls f(strand by itself, its part of x...) for every strand.
  template <class F, class... X>
  void each(F f, X&... x) {
    for (std::size_t s = 0; s < alone.size(); ++s) {
      SCOPED_TRACE(s);
      f(*alone[s], std::span(x).subspan(s * n, n)...);
    }
  }

  ReducedOptions options;
  /// Strands by themselves: by equations for trees and a dense matrix, and by sweeps.
  std::vector<std::unique_ptr<System>> alone, swept;
  std::unique_ptr<System> batch;
  std::size_t n = 0;  // unknowns of a strand
};

/// Where `got` may differ from the residual of a strand: rounding of terms that cancel,
/// inertia against everything else.
void expect_residual(System& strand, In q, In v, In a, In got) {
  std::vector<double> want(got.size()), at_rest(got.size());
  const std::vector<double> zero(got.size());
  ASSERT_EQ(strand.residual(t0, q, v, a, want), Status::ok);
  ASSERT_EQ(strand.residual(t0, q, v, zero, at_rest), Status::ok);
  EXPECT_LE(apart(got, want), rounding * (largest(want) + 2 * largest(at_rest)));
}

/// Recursions are backward stable: |x - S^-1 b| <= rounding cond(S) |x|.
void expect_solution(System& strand, Weights w, In q, In v, In a, In b, In got) {
  std::vector<double> want(b.begin(), b.end());
  ASSERT_EQ(strand.linearize(t0, q, v, a, w), Status::ok);
  ASSERT_EQ(strand.solve(want, want), Status::ok);
  EXPECT_LE(apart(got, want),
            rounding * condition(inverse(strand, b.size())) * largest(want));
}

/// The same of accelerations without w.
void expect_acceleration(System& strand, In q, In v, In got) {
  std::vector<double> want(got.size());
  const std::vector<double> zero(got.size());
  ASSERT_EQ(strand.explicit_form()->acceleration(t0, q, v, want), Status::ok);
  ASSERT_EQ(strand.linearize(t0, q, v, zero, {1, 0, 0}), Status::ok);
  EXPECT_LE(apart(got, want),
            rounding * condition(inverse(strand, got.size())) * largest(want));
}

constexpr Weights some_weights[] = {{1, 0, 0}, backward_euler, {0.5, 2 * h, h}};

TEST_P(Batch, ResidualIsThatOfTheStrands) {
  States s(*batch);
  s.shake(1);
  std::vector<double> r(s.n);
  ASSERT_EQ(batch->residual(t0, s.q, s.v, s.a, r), Status::ok);
  each(expect_residual, s.q, s.v, s.a, r);
}

TEST_P(Batch, SolvesAsTheStrandsDo) {
  States s(*batch);
  s.shake(1);
  for (const Weights w : some_weights) {
    const std::vector<double> b = s.random(s.a_typ);
    std::vector<double> x = b;
    ASSERT_EQ(batch->linearize(t0, s.q, s.v, s.a, w), Status::ok);
    ASSERT_EQ(batch->solve(x, x), Status::ok);
    each([w](System& strand, In q, In v, In a, In from,
             In got) { expect_solution(strand, w, q, v, a, from, got); },
         s.q, s.v, s.a, b, x);
  }
}

// With other natural strains, too.
TEST_P(Batch, StrandsBySweepsAreThoseOfTheEquationsForTrees) {
  for (std::size_t k = 0; k < alone.size(); ++k) {
    SCOPED_TRACE(k);
    System& strand = *swept[k];
    States s(strand);
    s.shake(1);
    std::vector<double> natural = natural_strains(strand)->natural();
    for (double& strain : natural) strain = 0.5 * strain - s.q_typ[0];
    for (System* one : {swept[k].get(), alone[k].get()}) {
      natural_strains(*one)->set_natural(natural);
    }
    std::vector<double> r(s.n), a(s.n);
    ASSERT_EQ(strand.residual(t0, s.q, s.v, s.a, r), Status::ok);
    expect_residual(*alone[k], s.q, s.v, s.a, r);
    for (const Weights w : some_weights) {
      const std::vector<double> b = s.random(s.a_typ);
      std::vector<double> x = b;
      ASSERT_EQ(strand.linearize(t0, s.q, s.v, s.a, w), Status::ok);
      ASSERT_EQ(strand.solve(x, x), Status::ok);
      expect_solution(*alone[k], w, s.q, s.v, s.a, b, x);
    }
    ASSERT_EQ(strand.explicit_form()->acceleration(t0, s.q, s.v, a), Status::ok);
    expect_acceleration(*alone[k], s.q, s.v, a);
  }
}

std::vector<double> after(System& system, const std::vector<double>& q, int steps) {
  Options given;
  given.step = h;
  const auto integrator = make_integrator("linearly_implicit_euler", system, given);
  EXPECT_EQ(integrator->start(0, q, std::vector<double>(q.size())), Status::ok);
  EXPECT_EQ(integrator->advance(steps * h), Status::ok);
  const In end = integrator->q();
  return {end.begin(), end.end()};
}

// A step is in error by no more than rounding cond(S) of how far it goes, and what
// becomes of that is what becomes of any small change: measured by one of 1e-7.
TEST_P(Batch, TrajectoryIsThatOfTheStrands) {
  constexpr int steps = 60;
  States s(*batch);
  const std::vector<double> end = after(*batch, s.q, steps);
  each(
      [&](System& strand, In q, In q_typ, In got) {
        const std::vector<double> from(q.begin(), q.end());
        std::vector<double> changed = from;
        const double change = 1e-7 * q_typ[0];
        for (std::size_t i = 0; i < n; ++i) changed[i] += i % 2 == 0 ? change : -change;
        const std::vector<double> want = after(strand, from, steps);
        const double growth =
            std::max(1.0, apart(after(strand, changed, steps), want) / change);
        const std::vector<double> zero(n);
        ASSERT_EQ(strand.linearize(0, q, zero, zero, backward_euler), Status::ok);
        const double farthest = apart(want, from) + largest(want);
        EXPECT_LE(apart(got, want),
                  steps * growth * rounding * condition(inverse(strand, n)) * farthest);
        EXPECT_GT(apart(want, from), 1e-3 * q_typ[0]);
      },
      s.q, s.q_typ, end);
}

TEST_P(Batch, PointsAndEnergiesAreThoseOfTheStrands) {
  States s(*batch);
  s.shake(1);
  MaterialPoints& points = *batch->material_points();
  ASSERT_EQ(points.count(), GetParam().strands * (segments + 1));
  const auto of_strand = 3 * static_cast<std::size_t>(segments + 1);
  std::vector<double> x(of_strand * alone.size()), u(x.size());
  points.positions(t0, s.q, x);
  points.velocities(t0, s.q, s.v, u);
  Energy energy;
  double power = 0, weighed = 0;  // J
  Momentum momentum;
  for (std::size_t strand = 0; strand < alone.size(); ++strand) {
    const In q = In(s.q).subspan(strand * n, n), v = In(s.v).subspan(strand * n, n);
    std::vector<double> own(of_strand);
    alone[strand]->material_points()->positions(t0, q, own);
    // Some ten products a segment, in another order; both sums err.
    const double per_size = 20 * eps * (segments + 1);
    EXPECT_LE(apart(own, In(x).subspan(strand * of_strand, of_strand)),
              per_size * largest(own));
    alone[strand]->material_points()->velocities(t0, q, v, own);
    EXPECT_LE(apart(own, In(u).subspan(strand * of_strand, of_strand)),
              per_size * largest(own));
    const Energy e = alone[strand]->energetics()->energy(t0, q, v);
    alone[strand]->material_points()->positions(t0, q, own);
    energy.kinetic += e.kinetic;
    energy.potential += e.potential;
    weighed += std::abs(e.potential) + weight(static_cast<int>(strand)) * largest(own);
    power += swept[strand]->energetics()->power(t0, q, v);
    const Momentum m = alone[strand]->energetics()->momentum(t0, q, v).value();
    for (std::size_t k = 0; k < 3; ++k) momentum.angular[k] += m.angular[k];
    const int first = static_cast<int>(strand) * (segments + 1);
    EXPECT_EQ(points.before(first), -1);
    EXPECT_EQ(points.before(first + 2), first + 1);
  }
  // Points are summed in another order; heights of either sign weigh in.
  const Energy sum = batch->energetics()->energy(t0, s.q, s.v);
  EXPECT_NEAR(sum.kinetic, energy.kinetic, rounding * energy.kinetic);
  EXPECT_NEAR(sum.potential, energy.potential, rounding * weighed);
  EXPECT_GT(energy.kinetic, 0);
  EXPECT_NE(energy.potential, 0);
  EXPECT_EQ(batch->energetics()->power(t0, s.q, s.v), power);
  EXPECT_EQ(batch->energetics()->momentum(t0, s.q, s.v).value().angular,
            momentum.angular);
  EXPECT_EQ(points.stretch(t0, s.q), 0);
}

TEST_P(Batch, ExplicitFormIsThatOfTheStrands) {
  States s(*batch);
  s.shake(1);
  std::vector<double> a(s.n);
  ASSERT_NE(batch->explicit_form(), nullptr);
  ASSERT_EQ(batch->explicit_form()->acceleration(t0, s.q, s.v, a), Status::ok);
  each(expect_acceleration, s.q, s.v, a);
}

// All other strands keep their natural strains.
TEST_P(Batch, HasTheNaturalStrainsOfTheStrands) {
  States s(*batch);
  s.shake(1);
  std::vector<double> natural = natural_strains(*batch)->natural();
  ASSERT_EQ(natural.size(), s.n);
  natural[0] += s.q_typ[0];
  natural_strains(*batch)->set_natural(natural);
  std::vector<double> r(s.n);
  ASSERT_EQ(batch->residual(t0, s.q, s.v, s.a, r), Status::ok);
  std::vector<double> first = natural_strains(*alone[0])->natural();
  first[0] += s.q_typ[0];
  natural_strains(*alone[0])->set_natural(first);
  each(expect_residual, s.q, s.v, s.a, r);
}

std::vector<BatchCase> batch_cases() {
  std::vector<BatchCase> cases;
  for (int strands = 1; strands <= 4; ++strands) {
    for (int dofs = 2; dofs <= 3; ++dofs) {
      const std::string size =
          "_" + std::to_string(dofs) + "_modes_" + std::to_string(strands) + "_strands";
      cases.push_back(
          {"super_helix" + size, Unknown::curvature, super_helix, dofs, strands});
      cases.push_back({"articulated_chain" + size, Unknown::joint_angle,
                       articulated_chain, dofs, strands});
    }
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Sizes, Batch, testing::ValuesIn(batch_cases()),
                         [](const auto& test) { return test.param.name; });

}  // namespace tress::test_batch
