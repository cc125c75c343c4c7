#include <gtest/gtest.h>

#include <random>

#include "models/head/chain_strand.h"
#include "models/head/clothoid_strand.h"
#include "models/head/helix_strand.h"
#include "models/head/reduced/reduced_model.h"
#include "tests/models/head/hairs.h"
#include "tests/support/apart.h"

/// Newton's corrections of a head's strands against those of the same strands by
/// themselves with the exact Jacobian (models/reduced/exact_tangent.h).
namespace tress::test_exact_head {

using namespace simulation;
using testing_support::Case;
using testing_support::chains;
using testing_support::HairModel;
using testing_support::helices;
using testing_support::options;
using testing_support::strand;
using T = PackOf<double, 4>;

template <class Kind>
struct Hair;
template <>
struct Hair<HelixKind<T>> {
  static constexpr const HairModel& model = helices;
};
template <>
struct Hair<ChainKind<T>> {
  static constexpr const HairModel& model = chains;
};
template <>
struct Hair<ClothoidKind<T>> {
  static constexpr const HairModel& model = testing_support::clothoids;
};

/// q, v and a of strands away from rest, in SI, and what is of them in a head.
struct States {
  std::vector<double> q, v, a;
};
States moved(const System& system, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto n = static_cast<std::size_t>(system.layout().coordinates);
  States s{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  std::vector<double> size(n), rate(n);
  system.initial_state(s.q, s.v);
  system.scale(size, rate);
  for (std::size_t i = 0; i < n; ++i) {
    s.q[i] += size[i] * any(generator);
    s.v[i] = 0.3 * rate[i] * any(generator);
    s.a[i] = 0.1 * rate[i] * rate[i] / size[i] * any(generator);
  }
  return s;
}

template <class Kind>
class OfHair : public testing::Test {};
using Kinds = testing::Types<HelixKind<T>, ChainKind<T>, ClothoidKind<T>>;
TYPED_TEST_SUITE(OfHair, Kinds);

// The same matrix and residual in other orders of summation: 1e-16 times the number
// cond(S) of each, some 1e6, up to 1e-9 of chains, whose joints leave three digits.
TYPED_TEST(OfHair, CorrectionsAreThoseOfTheStrandAlone) {
  using Model = ReducedModel<TypeParam>;
  constexpr double t = 0.13, h = 1.0 / 300;
  Case c{.name = "", .moves = true, .model = &Hair<TypeParam>::model};
  c.method = &testing_support::newton;
  const HeadOptions of_head = options(c);
  HeadUnits units = HeadUnits::of(of_head.longest);
  const Strand first = strand(c, 0);
  units.weigh(0, first.material.density * first.segments.front().section.area());
  const Model model(of_head, units);
  const std::size_t n = model.unknowns();
  typename Model::Strand of_strands;
  std::vector<typename Model::Element> elements(model.elements());
  std::vector<T> q(n), v(n), a(n), x(n);
  typename Model::Scratch scratch(model);
  std::vector<std::vector<double>> want;
  const double unit = model.unit(units, 0), tau = units.time;
  for (int lane = 0; lane < T::lanes; ++lane) {
    const Strand one = strand(c, static_cast<std::size_t>(lane));
    model.describe(one, of_head.motion.position, units, lane, of_strands, elements.data(),
                   q.data(), v.data());
    const auto system = c.model->alone(
        one, {.quadrature = c.points},
        {std::make_shared<Gravity>(of_head.gravity),
         std::make_shared<LinearDrag>(of_head.drag, of_head.mass_damping)});
    const States s = moved(*system, static_cast<std::uint32_t>(lane));
    for (std::size_t i = 0; i < n; ++i) {
      q[i].set(lane, s.q[i] / unit);
      v[i].set(lane, s.v[i] * tau / unit);
      a[i].set(lane, s.a[i] * tau * tau / unit);
    }
    std::vector<double> r(n), solved(n);
    ASSERT_EQ(system->residual(t, s.q, s.v, s.a, r), Status::ok);
    ASSERT_EQ(system->linearize(t, s.q, s.v, s.a, {1, h, h * h}), Status::ok);
    ASSERT_EQ(system->solve(r, solved), Status::ok);
    want.push_back(solved);
  }
  RootPose pose = of_head.motion.at(t);
  pose.v = (tau / units.length) * pose.v;
  pose.a = (tau * tau / units.length) * pose.a;
  pose.omega = tau * pose.omega;
  pose.alpha = (tau * tau) * pose.alpha;
  const double step = h / tau;
  model.newton(of_strands, elements.data(), model.clamp(of_strands, pose),
               {1, step, step * step}, q.data(), v.data(), a.data(), x.data(), scratch);
  for (int lane = 0; lane < T::lanes; ++lane) {
    const std::vector<double>& alone = want[static_cast<std::size_t>(lane)];
    std::vector<double> own(n);
    for (std::size_t i = 0; i < n; ++i) own[i] = unit / (tau * tau) * x[i][lane];
    EXPECT_LE(apart(own, alone), 1e-9 * apart(alone, std::vector<double>(n))) << lane;
    EXPECT_GT(apart(alone, std::vector<double>(n)), 1) << lane;
  }
}

}  // namespace tress::test_exact_head
