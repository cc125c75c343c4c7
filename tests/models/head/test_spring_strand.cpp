// The kernel of springs with the exact Jacobian against the System of one strand: each
// step of Newton's.
#include <gtest/gtest.h>

#include "models/head/maximal/edge_model.h"
#include "models/head/maximal/spring_strand.h"
#include "models/maximal/nodal_strand.h"
#include "tests/models/head/kernel_strand.h"
#include "tests/models/head/spring_strands.h"

namespace tress::test_spring_strand {

using namespace models;
using namespace testing_support;

using Kernel = SpringStrand<One, true>;

constexpr double t = 0.07;
constexpr std::size_t which = 3;

/// A strand in SI units.
struct Springs {
  explicit Springs(const RodCase& c) {
    const Strand strand = rod(c, which);
    const Segment& first = strand.segments.front();
    const NodalStrand nodal(strand, "mass_spring", 0);
    const double density = strand.material.density * first.section.area();
    const Vec bending = stiffness(strand.material, first.section);
    m.length = first.length;
    m.mass = density * first.length;
    m.drag = (c.drag + c.mass_damping * density) * first.length;
    m.stretch = strand.material.youngs_modulus * first.section.area() / first.length;
    m.bending = (bending.y + bending.z) / (2 * first.length);
    m.friction = strand.material.internal_friction / first.length;
    m.rate = typical_rate(strand);
    const Frame& wall = nodal.root.place.frame;
    for (std::size_t i = 0; i < strand.segments.size(); ++i) {
      const Vec e0 = i > 0 ? nodal.natural[i - 1].e0 : wall.e0, e1 = nodal.natural[i].e0;
      const Vec kb = 2 / (1 + dot(e0, e1)) * cross(e0, e1);
      edges.push_back(
          {One(i > 0 ? norm(kb) : dot(wall.e1, kb)), One(i > 0 ? 0 : dot(wall.e2, kb))});
    }
    const RootPose pose = strand.root.at(t);
    root = pose.x;
    clamp.frame = {Vec3<One>(pose.frame.e0), Vec3<One>(pose.frame.e1),
                   Vec3<One>(pose.frame.e2)};
    clamp.v = Vec3<One>(pose.v);
    clamp.omega = Vec3<One>(pose.omega);
  }

  SpringMaterial<One> m;
  std::vector<SpringEdge<One>> edges;
  LaneClamp<One> clamp;
  Vec root;
};

BentState state(System& system, double seed) {
  return bent_state(system, seed, static_cast<std::size_t>(system.layout().coordinates));
}

/// Corrections of the kernel, one after the other.
class Corrections {
 public:
  Corrections(const Springs& springs, const RodCase& c, Weights w)
      : springs_(springs),
        w_(w),
        kernel_(c.elements, Vec3<One>(rod_options(c).gravity)),
        placed_(springs.edges.size()),
        now_(placed_),
        factors_(placed_.size()),
        tensions_(placed_.size()),
        correction_(3 * placed_.size()) {}

  /// Stresses from there.
  void hold(const BentState& s) {
    take_tensions<3>(springs_.m, tensions_.size(), edges(s.q).data(), One(1),
                     tensions_.data());
  }
  double newton(const BentState& s) {
    const auto q = edges(s.q), v = packed(spring_edges(s.v, {})),
               a = packed(spring_edges(s.a, {}));
    return kernel_.newton(springs_.m, springs_.edges.data(), springs_.clamp, w_, q.data(),
                          v.data(), a.data(), nullptr, correction_.data(), placed_.data(),
                          factors_.data(), tensions_.data())[0];
  }
  double again(const BentState& s) {
    const auto q = edges(s.q), v = packed(spring_edges(s.v, {})),
               a = packed(spring_edges(s.a, {}));
    return kernel_.again(springs_.m, springs_.edges.data(), springs_.clamp, w_, q.data(),
                         v.data(), a.data(), nullptr, correction_.data(), placed_.data(),
                         factors_.data(), now_.data())[0];
  }
  std::vector<double> correction() const { return plain(correction_); }

 private:
  std::vector<One> edges(const std::vector<double>& q) const {
    return packed(spring_edges(q, springs_.root));
  }

  const Springs& springs_;
  Weights w_;
  Kernel kernel_;
  std::vector<Kernel::Placed> placed_, now_;
  std::vector<Kernel::Factor> factors_;
  std::vector<One> tensions_, correction_;
};

/// S^-1 r of the System at r(`at`), S(`linear`): of its nodes.
std::vector<double> wanted(System& system, Weights w, const BentState& linear,
                           const BentState& at) {
  std::vector<double> r(at.q.size()), x(r.size());
  EXPECT_EQ(system.linearize(t, linear.q, linear.v, linear.a, w), Status::ok);
  EXPECT_EQ(system.residual(t, at.q, at.v, at.a, r), Status::ok);
  EXPECT_EQ(system.solve(r, x), Status::ok);
  return x;
}

class SpringStrands : public testing::TestWithParam<RodCase> {};

// Both eliminate some ten numbers an edge with roundings of 1e-16 of the largest;
// stretching is up to 1e8 times as stiff as bending at these steps.
constexpr double rounding = 1e-16 * 1e8;
// Each computes the length of an edge within two roundings; the tensions that follow from
// these accelerate the lightest node. What is left of a small correction is not better.
constexpr double of_length = 4 * 1.1e-16;

TEST_P(SpringStrands, TakeTheStepOfTheSystem) {
  const RodCase& c = GetParam();
  const Springs springs(c);
  const auto system = spring_alone(rod(c, which), rod_options(c), newton);
  StressForm& stresses = *system->stress_form();
  const BentState first = state(*system, 0), second = state(*system, 1);
  for (const double h : {1e-4, 1e-3, 1e-2}) {
    SCOPED_TRACE(h);
    const Weights w{1, h, h * h};
    Corrections of(springs, c, w);
    std::vector<std::vector<double>> seen;
    const auto check = [&](const std::vector<double>& want, double size) {
      const double most = apart(want, std::vector<double>(want.size()));
      const double off = rounding * most + of_length * springs.m.stretch[0] *
                                               springs.m.length[0] /
                                               (springs.m.mass[0] / 2);
      EXPECT_LE(apart(of.correction(), spring_edges(want, {})), off);
      const double scale =
          std::max(w.pos, w.vel / springs.m.rate[0]) / springs.m.length[0];
      EXPECT_NEAR(size, scale * most, scale * off);
      for (const auto& other : seen) EXPECT_GT(apart(want, other), 10 * rounding * most);
      seen.push_back(want);
    };
    of.hold(first);
    const double at_first = of.newton(first);
    check(wanted(*system, w, first, first), at_first);
    const double again = of.again(second);
    check(wanted(*system, w, first, second), again);

    // Held, then followed from the end of this correction.
    of.hold(second);
    const double held = of.newton(first);
    stresses.take_stresses(t, second.q, StressForm::Stresses::held);
    std::vector<double> change = wanted(*system, w, first, first);
    check(change, held);
    BentState third = first;
    for (std::size_t i = 0; i < change.size(); ++i) {
      third.q[i] -= w.pos * change[i];
      third.v[i] -= w.vel * change[i];
      third.a[i] -= change[i];
    }
    const double followed = of.newton(third);
    stresses.take_stresses(t, first.q, StressForm::Stresses::followed);
    check(wanted(*system, w, third, third), followed);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, SpringStrands,
    testing::Values(RodCase{"Still"}, RodCase{.name = "Moved", .moves = true},
                    RodCase{.name = "OneEdge", .elements = 1, .moves = true},
                    RodCase{.name = "TwoEdges", .elements = 2, .moves = true},
                    RodCase{.name = "Tight", .moves = true, .curl = 4},
                    RodCase{.name = "Rubbed", .moves = true, .friction = 2e-9},
                    RodCase{.name = "Soft", .moves = true, .youngs_modulus = 1e6}),
    [](const auto& of) { return of.param.name; });

}  // namespace tress::test_spring_strand
