#include <gtest/gtest.h>

#include <Eigen/LU>

#include "integrators/catalogue.h"
#include "models/effects/gravity.h"
#include "models/effects/linear_drag.h"
#include "models/input_error.h"
#include "models/reduced/articulated_chain.h"
#include "models/reduced/force_transport.h"
#include "models/reduced/super_helix.h"
#include "tests/models/reduced/strand_cases.h"

namespace tress {
namespace {

using namespace testing_support;

constexpr int segments = 6;
constexpr double h = 3e-4;  // s
constexpr Weights backward_euler{1, h, h* h};

/// A force that reads all that points have, and differs from point to point:
/// f = m (-a (1 + i) x - b v + c tangent), i the index of the point.
class Tether final : public Effect {
 public:
  std::string_view name() const override { return "tether"; }
  Needs needs() const override {
    return {.position = true, .velocity = true, .tangent = true, .derivatives = true};
  }
  void add_load(double, const Points& p, InOut f) const noexcept override {
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      const Vec load = pull(i) * load3(&p.x[3 * i]) - drag * load3(&p.v[3 * i]) +
                       along * load3(&p.tangent[3 * i]);
      store3(load3(&f[3 * i]) + p.mass[i] * load, &f[3 * i]);
    }
  }
  void add_derivatives(double, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override {
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      for (std::size_t k = 0; k < 9; k += 4) {
        blocks[9 * i + k] += p.mass[i] * (pos * pull(i) - vel * drag);
      }
    }
  }
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double, const Points&) const noexcept override { return 0; }

 private:
  static double pull(std::size_t i) { return -20.0 * static_cast<double>(1 + i); }
  static constexpr double drag = 3, along = 5;  // 1/s, m/s^2
};

/// Four strands that have nothing in common but the number of segments.
Strand strand(int lane, int dofs) {
  const double k = lane + 1;
  Material material;
  material.density = 1000 + 100 * k;
  material.youngs_modulus = 1e9 * k;
  material.internal_friction = 1e-12 * (5 - k);
  // In the plane of e0 and e2 where there is one bending plane only.
  const Vec natural = dofs == 1 ? Vec{0, 3 * k, 0} : Vec{4 - k, 3 * k, -2 * k};
  const Vec initial = dofs == 1 ? Vec{0, 5 - k, 0} : Vec{k, 5 - k, 2.0};
  Strand made = make_strand(material, {4e-5 + 1e-5 * k, 6e-5},
                            {.elements = segments, .length = 0.05 * k, .grading = k},
                            uniform_shape(natural), uniform_shape(initial));
  made.root.position = {0.1 * k, -0.2, 0.3};
  made.root.frame = rotation({0, 0, 1}, 0.3 * k);
  if (lane > 0) made.root.translations = {{{0, 1, 0.5}, sine(0.01 * k, 3)}};
  if (lane > 1) made.root.rotations = {{{0, 0.6, 0.8}, one_minus_cosine(0.4, 2)}};
  return made;
}

Effects effects(int lane) {
  const auto gravity = std::make_shared<Gravity>(Vec{0, 1, -9.81});
  const auto drag = std::make_shared<LinearDrag>(2e-5, 0.5);
  switch (lane) {
    case 0:
      return {gravity, drag};
    case 1:
      return {};
    case 2:
      return {std::make_shared<Tether>()};
    default:
      return {std::make_shared<Gravity>(Vec{2, 0, -5}), drag, std::make_shared<Tether>()};
  }
}

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
    options.tangent = ReducedTangent::stiff;
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

// A number takes part in at most some hundred operations per segment, whose rounding
// errors of eps each add up: those of results are within this of the largest term.
constexpr double rounding = 100 * segments * eps;

double apart(In x, In y) {
  double most = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i] - y[i])) return std::numeric_limits<double>::infinity();
    most = std::max(most, std::abs(x[i] - y[i]));
  }
  return most;
}

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

/// The inverse of S(w), column by column.
Eigen::MatrixXd inverse(System& strand, std::size_t n) {
  Eigen::MatrixXd columns(n, n);
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    std::vector<double> unit(n);
    unit[static_cast<std::size_t>(k)] = 1;
    EXPECT_EQ(strand.solve(unit, unit), Status::ok);
    columns.col(k) = Eigen::Map<const Eigen::VectorXd>(unit.data(), columns.rows());
  }
  return columns;
}

double condition(const Eigen::MatrixXd& inverse) {
  return inverse.lpNorm<Eigen::Infinity>() * inverse.inverse().lpNorm<Eigen::Infinity>();
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
  const auto integrator = make_integrator("semi_implicit_euler", system, given);
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
  double power = 0;
  Momentum momentum;
  for (std::size_t strand = 0; strand < alone.size(); ++strand) {
    const In q = In(s.q).subspan(strand * n, n), v = In(s.v).subspan(strand * n, n);
    std::vector<double> own(of_strand);
    alone[strand]->material_points()->positions(t0, q, own);
    EXPECT_EQ(apart(own, In(x).subspan(strand * of_strand, of_strand)), 0);
    alone[strand]->material_points()->velocities(t0, q, v, own);
    EXPECT_EQ(apart(own, In(u).subspan(strand * of_strand, of_strand)), 0);
    const Energy e = alone[strand]->energetics()->energy(t0, q, v);
    energy.kinetic += e.kinetic;
    energy.potential += e.potential;
    power += alone[strand]->energetics()->power(t0, q, v);
    Momentum m;
    ASSERT_TRUE(alone[strand]->energetics()->momentum(t0, q, v, m));
    for (std::size_t k = 0; k < 3; ++k) momentum.angular[k] += m.angular[k];
    const int first = static_cast<int>(strand) * (segments + 1);
    EXPECT_EQ(points.before(first), -1);
    EXPECT_EQ(points.before(first + 2), first + 1);
  }
  EXPECT_EQ(batch->energetics()->energy(t0, s.q, s.v).kinetic, energy.kinetic);
  EXPECT_EQ(batch->energetics()->energy(t0, s.q, s.v).potential, energy.potential);
  EXPECT_EQ(batch->energetics()->power(t0, s.q, s.v), power);
  Momentum total;
  ASSERT_TRUE(batch->energetics()->momentum(t0, s.q, s.v, total));
  EXPECT_EQ(total.angular, momentum.angular);
  double stretch = 1;
  EXPECT_TRUE(points.stretch(t0, s.q, stretch));
  EXPECT_EQ(stretch, 0);
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

class BatchOf : public testing::Test {
 protected:
  BatchOf() { options.tangent = ReducedTangent::stiff; }
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
  options.tangent = ReducedTangent::exact;
  expect_refused("stiff tangent");
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

}  // namespace
}  // namespace tress
