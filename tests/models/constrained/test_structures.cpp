#include <gtest/gtest.h>

#include "contract/input_error.h"
#include "models/catalogue.h"
#include "models/constrained/inextensible_chain.h"
#include "models/constrained/joints.h"
#include "models/constrained/tinkertoys.h"
#include "models/effects/gravity.h"
#include "tests/models/constrained/dynamics.h"

namespace tress::test_structures {

using namespace models;

using testing_support::Oracle;
using testing_support::view;

struct Case {
  const char* name;
  Structure structure;
  int size;
  double spin;
  int coordinates, constraints, deficiency;
};

class Structures : public ::testing::TestWithParam<Case> {
 protected:
  static std::unique_ptr<ParticleSystem> build(double drag = 0) {
    ToyShape shape;
    shape.structure = GetParam().structure;
    shape.size = GetParam().size;
    shape.spin = GetParam().spin;
    shape.drag = drag;
    return std::make_unique<ParticleSystem>(tinkertoys(shape));
  }
};

TEST_P(Structures, StartOnTheirConstraintsInPositionAndVelocity) {
  const auto system = build();
  const Oracle at(*system);
  Eigen::VectorXd g(system->layout().constraints);
  Eigen::VectorXd rate(g.size());
  ASSERT_EQ(system->constraint_form()->value(0, view(at.q), view(g)), Status::ok);
  ASSERT_EQ(system->constraint_form()->rate(0, view(at.q), view(at.v), view(rate)),
            Status::ok);
  // Coordinates up to 1 m and speeds up to |spin| m/s are rounded by eps each; angles
  // divide by an arm of at least 1/8 m and the sine of at least pi/24.
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * 8 / 0.13;
  EXPECT_LE(g.lpNorm<Eigen::Infinity>(), rounding);
  EXPECT_LE(rate.lpNorm<Eigen::Infinity>(), rounding * std::abs(GetParam().spin));
  EXPECT_EQ(at.v.norm() > 0, GetParam().spin != 0);
}

TEST_P(Structures, HaveTheirCountsAndRankDeficiency) {
  const auto system = build();
  EXPECT_EQ(system->layout().coordinates, GetParam().coordinates);
  EXPECT_EQ(system->layout().constraints, GetParam().constraints);
  const Eigen::MatrixXd g = Oracle(*system).gradient();
  const Eigen::VectorXd singular = testing_support::singular_values(g);
  // regular structures of these sizes keep singular values above 1e-2, rounding is 1e-16
  const auto rank = (singular.array() > 1e-9 * singular[0]).count();
  EXPECT_EQ(GetParam().constraints - rank, GetParam().deficiency);
}

TEST_P(Structures, EnergyChangesByThePowerOfDragAlongTheExactAcceleration) {
  const auto system = build(0.4);
  const Oracle at(*system);
  // central difference over h: truncation h^2 E'''/6, rounding eps E / h
  const double h = 1e-5;
  const double slope = (at.total_energy(h) - at.total_energy(-h)) / (2 * h);
  const double power = system->energetics()->power(0, view(at.q), view(at.v));
  EXPECT_NEAR(slope, power, 1e-7 * (1 + std::abs(power)));
  EXPECT_EQ(power < 0, GetParam().spin != 0);
}

TEST_P(Structures, SolveIsTheInverseOfTheSparseForm) {
  const auto system = build(0.4);
  const Oracle at(*system);
  const Weights w{1, 0.1, 0.01};
  const Eigen::VectorXd a = Eigen::VectorXd::Zero(at.q.size());
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(at.q.size(), -1, 2);
  const Eigen::VectorXd b = x;
  ASSERT_EQ(system->linearize(0, view(at.q), view(at.v), view(a), w), Status::ok);
  ASSERT_EQ(system->solve(view(x), view(x)), Status::ok);
  EXPECT_LE((at.tangent(w) * x - b).lpNorm<Eigen::Infinity>(),
            1e-14);  // 2 entries of eps
  EXPECT_GT((at.tangent({1, 0, 0}) * x - b).lpNorm<Eigen::Infinity>(), 1e-3);
}

TEST_P(Structures, ResidualTwiceGivesTheSameBits) {
  const auto system = build(0.4);
  const Oracle at(*system);
  const Eigen::VectorXd a = Eigen::VectorXd::LinSpaced(at.q.size(), -1, 2);
  Eigen::VectorXd first(at.q.size()), second(at.q.size());
  ASSERT_EQ(system->residual(0, view(at.q), view(at.v), view(a), view(first)),
            Status::ok);
  ASSERT_EQ(system->residual(0.3, view(at.v), view(at.q), view(a), view(second)),
            Status::ok);
  EXPECT_NE(first, second);
  ASSERT_EQ(system->residual(0, view(at.q), view(at.v), view(a), view(second)),
            Status::ok);
  EXPECT_EQ(first, second);
}

TEST_P(Structures, PatternsAscendInsideTheirColumns) {
  const auto system = build();
  for (const Pattern* p :
       {&system->sparse_form()->pattern(), &system->constraint_form()->pattern()}) {
    ASSERT_EQ(p->start.size(), std::size_t(p->cols) + 1);
    for (std::size_t j = 0; j < std::size_t(p->cols); ++j) {
      EXPECT_LT(p->start[j], p->start[j + 1]);
      for (auto k = std::size_t(p->start[j]) + 1; k < std::size_t(p->start[j + 1]); ++k) {
        EXPECT_LT(p->row[k - 1], p->row[k]);
        EXPECT_LT(p->row[k], p->rows);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Tinkertoys, Structures,
    ::testing::Values(Case{"chain1", Structure::chain, 1, 0, 3, 1, 0},
                      Case{"chain8", Structure::chain, 8, 0, 24, 8, 0},
                      Case{"chain8spinning", Structure::chain, 8, 2, 24, 8, 0},
                      Case{"ring3", Structure::ring, 3, 0, 9, 6, 0},
                      Case{"ring7spinning", Structure::ring, 7, 2, 21, 10, 0},
                      Case{"net1", Structure::net, 1, 0, 3, 1, 0},
                      Case{"net4", Structure::net, 4, 0, 48, 28, 0},
                      Case{"tree1", Structure::tree, 1, 0, 3, 1, 0},
                      Case{"tree4spinning", Structure::tree, 4, 2, 45, 22, 0},
                      Case{"truss1", Structure::truss, 1, 0, 18, 18, 3},
                      Case{"truss4spinning", Structure::truss, 4, 2, 45, 54, 12}),
    [](const auto& tested) { return tested.param.name; });

TEST(ParticleSystem, SwungFromMovingAnchorIsConsistentOnlyWhenItFollows) {
  const auto build = [](Vec v) {
    ParticleScene scene;
    const Node hand = scene.add_anchor(
        orbit({}, {0.1, 0, 0}, {0, 0.1, 0}, 1));  // starts moving along y
    const Node bob = scene.add_particle(1, {0.6, 0, 0}, v);
    scene.constraints.push_back(distance(hand, bob, 0.5));
    const Node held = scene.add_particle(1, {0.1, 0, 0}, {0, 0.2 * 3.14159265358979, 0});
    scene.constraints.push_back(fixed_point(held, hand));
    return ParticleSystem(std::move(scene));
  };
  EXPECT_NO_THROW(build({0, 0, 0}));
  EXPECT_NO_THROW(build({0, 5, 1}));
  EXPECT_THROW(build({0.1, 0, 0}), InputError);
}

TEST(ParticleSystem, WithoutConstraintsFallsFreelyByItsExplicitForm) {
  ParticleScene scene;
  scene.add_particle(2, {});
  scene.add_particle(3, {1, 0, 0});
  scene.effects.push_back(std::make_unique<Gravity>(Vec{0, 0, -9.81}));
  ParticleSystem system(std::move(scene));
  const Oracle at(system);
  ASSERT_NE(system.explicit_form(), nullptr);
  EXPECT_EQ(system.constraint_form(), nullptr);
  Eigen::VectorXd a(6);
  ASSERT_EQ(system.explicit_form()->acceleration(0, view(at.q), view(at.v), view(a)),
            Status::ok);
  const Eigen::VectorXd falling =
      (Eigen::VectorXd(6) << 0, 0, -9.81, 0, 0, -9.81).finished();
  EXPECT_LE((a - falling).norm(), 1e-14);
}

TEST(ParticleSystem, RefusesEmptyScenesBadMassesAndViolatedStarts) {
  const auto lone = [](double mass, double reach) {
    ParticleScene scene;
    const Node x = scene.add_particle(mass, {reach, 0, 0});
    scene.constraints.push_back(distance(scene.add_anchor(Vec{}), x, 1));
    return ParticleSystem(std::move(scene));
  };
  EXPECT_NO_THROW(lone(1, 1));
  EXPECT_THROW(lone(0, 1), InputError);
  EXPECT_THROW(lone(std::nan(""), 1), InputError);
  EXPECT_THROW(lone(1, 1 + 1e-6), InputError);
  EXPECT_THROW(lone(1, std::nan("")), InputError);
  EXPECT_THROW(ParticleSystem(ParticleScene{}), InputError);
}

TEST(InextensibleChain, LongOnesStartConsistentOpenAndClosed) {
  for (const bool closed : {false, true}) {
    ChainShape shape;
    shape.links = 10'000;
    shape.closed = closed;
    ParticleSystem system(inextensible_chain(shape));
    Eigen::VectorXd q(30'000), v(30'000), g(system.layout().constraints);
    system.initial_state(view(q), view(v));
    ASSERT_EQ(system.constraint_form()->value(0, view(q), view(g)), Status::ok);
    EXPECT_EQ(g.size(), closed ? 10'003 : 10'000);
    // coordinates up to 1 m are rounded by eps/2 each
    EXPECT_LE(g.lpNorm<Eigen::Infinity>(), 4 * std::numeric_limits<double>::epsilon());
    EXPECT_EQ(system.sparse_form()->pattern().nonzeros() % 9, 0);
  }
}

TEST(InextensibleChain, FirstLinkOfOneFallsAsAPendulum) {
  ChainShape shape;
  shape.links = 1;
  ParticleSystem system(inextensible_chain(shape));
  // released horizontally: all of gravity, no tension
  EXPECT_LE((Oracle(system).acceleration() - Eigen::Vector3d(0, 0, -9.81)).norm(), 1e-13);
}

TEST(Catalogue, BuildersRefuseSizesTheyDoNotHave) {
  const auto make = [](const char* structure, const char* size) {
    const ModelEntry& entry = find_model("tinkertoys");
    Parameters p(entry.parameters, "model tinkertoys");
    p.set("structure", structure);
    p.set("size", size);
    return entry.make(p);
  };
  EXPECT_NO_THROW((void)make("ring", "3"));
  EXPECT_THROW((void)make("ring", "2"), InputError);
  EXPECT_THROW((void)make("tree", "40"), InputError);
  EXPECT_THROW((void)make("net", "0"), InputError);
  Parameters p(find_model("inextensible_chain").parameters, "model inextensible_chain");
  EXPECT_THROW(p.set("links", "0"), InputError);
  EXPECT_THROW(p.set("length_m", "-1"), InputError);
}

}  // namespace tress::test_structures
