// The kernel of discrete rods against the System of one strand: each step of Newton's.
#include <gtest/gtest.h>

#include "models/head/maximal/der_strand.h"
#include "models/head/maximal/edge_model.h"
#include "models/maximal/joint_strain.h"
#include "models/maximal/nodal_strand.h"
#include "tests/models/head/der_strands.h"
#include "tests/models/head/kernel_strand.h"
#include "tests/support/apart.h"

namespace tress::test_der_strand {

using namespace models;
using namespace testing_support;

/// A strand in SI units, and a state of it that has nothing special: bent, twisted,
/// stretched and moving.
struct Rod {
  explicit Rod(const RodCase& of) : c(of), edges(n()) {
    const Strand strand = rod(c, 3);
    const Segment& first = strand.segments.front();
    const NodalStrand nodal(strand, "der", n());
    const double density = strand.material.density * first.section.area();
    m.length = first.length;
    m.mass = density * first.length;
    m.drag = (c.drag + c.mass_damping * density) * first.length;
    m.inertia = strand.material.density * first.section.polar() * first.length;
    m.stretch = strand.material.youngs_modulus * first.section.area() / first.length;
    m.stiffness = 1 / first.length * stiffness(strand.material, first.section);
    m.friction = strand.material.internal_friction / first.length;
    m.rate = typical_rate(strand);
    for (std::size_t i = 0; i < n(); ++i) {
      const Frame& before = i > 0 ? nodal.natural[i - 1] : nodal.root.place.frame;
      const Vec rest = joint_strain(before, nodal.natural[i]);
      edges[i] = {Vec3<One>(rest), Vec3<One>(nodal.initial[i].e0),
                  Vec3<One>(nodal.initial[i].e1), One(rest.x)};
    }
    const RootPose pose = strand.root.at(t);
    root = pose.x;
    clamp.frame = {Vec3<One>(pose.frame.e0), Vec3<One>(pose.frame.e1),
                   Vec3<One>(pose.frame.e2)};
    clamp.v = Vec3<One>(pose.v);
    clamp.omega = Vec3<One>(pose.omega);
  }
  std::size_t n() const { return static_cast<std::size_t>(c.elements); }

  static constexpr double t = 0.07;
  RodCase c;
  DerMaterial<One> m;
  std::vector<DerEdge<One>> edges;
  LaneClamp<One> clamp;
  Vec root;
};

BentState state(System& system, double seed, const Rod* unstretched) {
  const std::size_t nodes = static_cast<std::size_t>(system.layout().coordinates) / 4 * 3;
  BentState s = bent_state(system, seed, nodes);
  if (unstretched == nullptr) return s;
  const std::vector<double> edges = as_edges(s.q, unstretched->root);
  Vec x = unstretched->root;
  for (std::size_t i = 0; i < nodes / 3; ++i) {
    const Vec e = load3(&edges[4 * i]);
    x = x + unstretched->m.length[0] / norm(e) * e;
    store3(x, &s.q[3 * i]);
  }
  return s;
}

/// S^-1 r of the System at r(`at`), S(`linear`), in the head's coordinates.
std::vector<double> wanted(System& system, Weights w, const BentState& linear,
                           const BentState& at) {
  std::vector<double> r(at.q.size()), x(r.size());
  EXPECT_EQ(system.linearize(Rod::t, linear.q, linear.v, linear.a, w), Status::ok);
  EXPECT_EQ(system.residual(Rod::t, at.q, at.v, at.a, r), Status::ok);
  EXPECT_EQ(system.solve(r, x), Status::ok);
  return as_edges(x, {});
}

/// `off`: of the largest correction.
template <bool exact>
void compare(const RodCase& c, double h, bool unstretched, double off) {
  const Rod rod(c);
  const auto system = rod_alone(c, 3, exact ? "exact" : "elastic");
  const BentState first = state(*system, 0, unstretched ? &rod : nullptr),
                  second = state(*system, 1, unstretched ? &rod : nullptr);
  const Weights w{1, h, h * h};
  const DerStrand<One, exact> kernel(c.elements, Vec3<One>(rod_options(c).gravity));
  std::vector<typename DerStrand<One, exact>::Placed> placed(rod.n()), now(rod.n());
  std::vector<typename DerStrand<One, exact>::Factor> factors(rod.n());
  std::vector<One> correction(4 * rod.n()), tensions(rod.n());
  const auto of = [&](const BentState& s) {
    return std::array{packed(as_edges(s.q, rod.root)), packed(as_edges(s.v, {})),
                      packed(as_edges(s.a, {}))};
  };
  const auto check = [&](const std::vector<double>& want, double size) {
    const std::vector<double> got = plain(correction);
    double most = 0, typical = 0;
    Vec x;
    for (std::size_t i = 0; i < rod.n(); ++i) {
      x = x + load3(&want[4 * i]);
      for (const double entry : {x.x, x.y, x.z}) {
        most = std::max(most, std::abs(entry));
      }
      typical = std::max(typical, std::abs(want[4 * i + 3]));
    }
    EXPECT_LE(apart(got, want), off * std::max(most, typical));
    EXPECT_GT(typical, 0);
    const double length = rod.m.length[0], rate = rod.m.rate[0];
    const double scale = std::max(w.pos, w.vel / rate);
    EXPECT_NEAR(size, scale * std::max(most / length, typical), off * size);
  };
  const auto [q, v, a] = of(first);
  take_tensions<4>(rod.m, rod.n(), q.data(), One(1), tensions.data());
  double size = kernel.newton(rod.m, rod.edges.data(), rod.clamp, w, q.data(), v.data(),
                              a.data(), nullptr, correction.data(), placed.data(),
                              factors.data(), tensions.data())[0];
  check(wanted(*system, w, first, first), size);
  const auto [q2, v2, a2] = of(second);
  size = kernel.again(rod.m, rod.edges.data(), rod.clamp, w, q2.data(), v2.data(),
                      a2.data(), nullptr, correction.data(), placed.data(),
                      factors.data(), now.data())[0];
  check(wanted(*system, w, first, second), size);
}

class DerStrands : public testing::TestWithParam<RodCase> {};

// Both eliminate some ten numbers an edge with roundings of 1e-16 of the largest;
// stretching is up to 1e8 times as stiff as bending at these steps.
constexpr double rounding = 1e-16 * 1e8;

TEST_P(DerStrands, TakeTheStepOfTheSystem) {
  for (const double h : {1e-4, 1e-3, 1e-2}) {
    SCOPED_TRACE(h);
    compare<false>(GetParam(), h, false, rounding);
    RodCase frictionless = GetParam();
    frictionless.friction = 0;
    compare<true>(frictionless, h, false, rounding);
    // Slopes of rates of friction by lengths are left out. Edges at rest lengthen by
    // loads over EA, some 1e-5 of an edge where rotations are of order one.
    if (GetParam().youngs_modulus > 1e9) compare<true>(GetParam(), h, true, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, DerStrands,
    testing::Values(RodCase{"Still"}, RodCase{.name = "Moved", .moves = true},
                    RodCase{.name = "OneEdge", .elements = 1, .moves = true},
                    RodCase{.name = "TwoEdges", .elements = 2, .moves = true},
                    RodCase{.name = "Tight", .moves = true, .curl = 4},
                    RodCase{.name = "Soft", .moves = true, .youngs_modulus = 1e6}),
    [](const auto& of) { return of.param.name; });

}  // namespace tress::test_der_strand
