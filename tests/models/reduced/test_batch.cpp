#include <gtest/gtest.h>

#include "contract/forms/explicit_form.h"
#include "integrators/catalogue.h"
#include "models/clothoid/super_clothoid.h"
#include "models/groom/strand_block.h"
#include "models/reduced/articulated_chain.h"
#include "models/reduced/force_transport.h"
#include "models/reduced/super_helix.h"
#include "tests/models/reduced/batch_strands.h"

namespace tress::test_batch {

using namespace simulation;

using namespace testing_support;

struct BatchCase {
  std::string name;
  decltype(super_helix_batch)* batch;
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
      alone.push_back(GetParam().alone(strands.back(), options, acting.back()));
    }
    batch = GetParam().batch(strands, options, std::move(acting));
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
  std::vector<std::unique_ptr<System>> alone;
  std::unique_ptr<System> batch;
  std::size_t n = 0;  // unknowns of a strand
};

TEST_P(Batch, ResidualIsThatOfTheStrands) {
  States s(*batch);
  s.shake(1);
  std::vector<double> r(s.n), without(s.n);
  ASSERT_EQ(batch->residual(t0, s.q, s.v, s.a, r), Status::ok);
  each(
      [](System& strand, In q, In v, In a, In got) {
        std::vector<double> want(got.size()), at_rest(got.size());
        const std::vector<double> zero(got.size());
        ASSERT_EQ(strand.residual(t0, q, v, a, want), Status::ok);
        // Terms that cancel: inertia against everything else.
        ASSERT_EQ(strand.residual(t0, q, v, zero, at_rest), Status::ok);
        const double terms = largest(want) + 2 * largest(at_rest);
        EXPECT_LE(apart(got, want), rounding * terms);
      },
      s.q, s.v, s.a, r);
}

// Recursions are backward stable: |x - S^-1 b| <= rounding cond(S) |x|.
TEST_P(Batch, SolvesAsTheStrandsDo) {
  States s(*batch);
  s.shake(1);
  for (const Weights w : {Weights{1, 0, 0}, backward_euler, Weights{0.5, 2 * h, h}}) {
    const std::vector<double> b = s.random(s.a_typ);
    std::vector<double> x = b;
    ASSERT_EQ(batch->linearize(t0, s.q, s.v, s.a, w), Status::ok);
    ASSERT_EQ(batch->solve(x, x), Status::ok);
    each(
        [&](System& strand, In q, In v, In a, In from, In got) {
          std::vector<double> want(from.begin(), from.end());
          ASSERT_EQ(strand.linearize(t0, q, v, a, w), Status::ok);
          ASSERT_EQ(strand.solve(want, want), Status::ok);
          EXPECT_LE(apart(got, want),
                    rounding * condition(inverse(strand, n)) * largest(want));
        },
        s.q, s.v, s.a, b, x);
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

// Points of all strands but the first at once: a strand's own blocks are those of the
// strand alone, and no strand feels another one's forces.
TEST_P(Batch, RespondsToForcesOnPointsAsTheStrandsDo) {
  States s(*batch);
  s.shake(1);
  std::vector<double> zero(s.n);
  ASSERT_EQ(batch->linearize(t0, s.q, s.v, zero, backward_euler), Status::ok);
  MaterialPoints& points = *batch->material_points();
  const std::vector<int> own{1, 2, 4, segments};
  std::vector<int> all;
  for (int strand = alone.size() > 1 ? 1 : 0; strand < GetParam().strands; ++strand) {
    for (const int point : own) all.push_back(strand * (segments + 1) + point);
  }
  std::vector<double> blocks(9 * all.size() * all.size()), f(3 * all.size());
  const bool known = dynamic_cast<StrandBlock&>(*batch).responds_at_once();
  EXPECT_EQ(known, GetParam().batch != force_transport_batch);
  ASSERT_EQ(points.responses(t0, s.q, all, blocks), known);
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = std::sin(1 + static_cast<double>(i));
  std::vector<double> pulled(s.n);
  ASSERT_EQ(points.pull_back(t0, s.q, all, f, pulled), known);
  if (!known) return;
  std::size_t first = 0;  // of the strand's points among all
  for (std::size_t k = alone.size() > 1 ? 1 : 0; k < alone.size(); ++k) {
    SCOPED_TRACE(k);
    const In q = In(s.q).subspan(k * n, n), v = In(s.v).subspan(k * n, n);
    ASSERT_EQ(alone[k]->linearize(t0, q, v, std::vector<double>(n), backward_euler),
              Status::ok);
    std::vector<double> want(9 * own.size() * own.size());
    MaterialPoints& of_strand = *alone[k]->material_points();
    ASSERT_TRUE(of_strand.responses(t0, q, own, want));
    const double off = rounding * condition(inverse(*alone[k], n)) * largest(want);
    EXPECT_GT(largest(want), 0);
    for (std::size_t of = 0; of < all.size(); ++of) {
      for (std::size_t on = 0; on < own.size(); ++on) {
        const double* const got = &blocks[9 * (of * all.size() + first + on)];
        const bool same = of >= first && of < first + own.size();
        for (std::size_t e = 0; e < 9; ++e) {
          const double wanted = same ? want[9 * ((of - first) * own.size() + on) + e] : 0;
          EXPECT_NEAR(got[e], wanted, same ? off : 0);
        }
      }
    }
    std::vector<double> want_b(n);
    ASSERT_TRUE(of_strand.pull_back(t0, q, own, In(f).subspan(3 * first, 3 * own.size()),
                                    want_b));
    EXPECT_LE(apart(want_b, In(pulled).subspan(k * n, n)), rounding * largest(want_b));
    first += own.size();
  }
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
    power += alone[strand]->energetics()->power(t0, q, v);
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
  each(
      [](System& strand, In q, In v, In got) {
        std::vector<double> want(got.size());
        ASSERT_EQ(strand.explicit_form()->acceleration(t0, q, v, want), Status::ok);
        EXPECT_EQ(apart(got, want), 0);
      },
      s.q, s.v, a);
}

std::vector<BatchCase> batch_cases() {
  std::vector<BatchCase> cases;
  for (int strands = 1; strands <= 4; ++strands) {
    for (int dofs = 1; dofs <= 3; ++dofs) {
      const std::string size =
          "_" + std::to_string(dofs) + "_modes_" + std::to_string(strands) + "_strands";
      cases.push_back(
          {"super_helix" + size, super_helix_batch, super_helix, dofs, strands});
      cases.push_back(
          {"super_clothoid" + size, super_clothoid_batch, super_clothoid, dofs, strands});
      cases.push_back({"articulated_chain" + size, articulated_chain_batch,
                       articulated_chain, dofs, strands});
      cases.push_back({"force_transport" + size, force_transport_batch, force_transport,
                       dofs, strands});
    }
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Sizes, Batch, testing::ValuesIn(batch_cases()),
                         [](const auto& test) { return test.param.name; });

}  // namespace tress::test_batch
