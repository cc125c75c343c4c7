#include <gtest/gtest.h>

#include "models/reduced/super_helix.h"
#include "tests/models/reduced/strand_cases.h"

// A chain written as a tree gives the chain's numbers.

namespace tress::test_branching {

using namespace simulation;

using namespace testing_support;

constexpr std::size_t elements = 12;
// Both sides do the same sums of a few hundred terms in another order or in turned axes,
// and solve with matrices of condition 1e2 at h = 10 ms: eps x 1e2 x some tens.
constexpr double tolerance = 1e-12;
constexpr Weights weights{1, 1e-2, 1e-4};

const ModelSettings curly_chain = {{"elements", "12"},
                                   {"natural_curvature_per_m", "60"},
                                   {"natural_curvature2_per_m", "10"},
                                   {"natural_twist_per_m", "20"},
                                   {"grading", "2"},
                                   {"drag_kg_m_s", "1e-5"},
                                   {"internal_friction_kg_m3_s", "1e-11"}};

/// A system with what was put in and what came out.
struct Solved {
  std::vector<double> q, v, a, r, x;
};

void evaluate(System& system, Solved& s) {
  s.r = s.x = zeros(system);
  ASSERT_EQ(system.residual(t0, s.q, s.v, s.a, s.r), Status::ok);
  ASSERT_EQ(system.linearize(t0, s.q, s.v, s.a, weights), Status::ok);
  ASSERT_EQ(system.solve(s.r, s.x), Status::ok);
}

Solved on_random_state(System& system) {
  States random(system, 5);
  random.shake(0.5);
  Solved s{random.q, random.v, random.a, {}, {}};
  evaluate(system, s);
  return s;
}

std::unique_ptr<System> make(const Strand& strand, const Parameters& parameters) {
  return super_helix(strand, reduced_options(parameters), strand_effects(parameters));
}

constexpr double turn = 0.7;  // rad, of every segment against the one before

/// The frame of segment i of a turned chain, seen from that of the plain one.
Frame turned_by(std::size_t i) {
  return rotation({1, 0, 0}, turn * static_cast<double>(i + 1));
}

/// The same body as `chain`, of circular sections, but with material axes that are turned
/// about the tangent at every joint.
Strand turned(Strand chain) {
  for (std::size_t i = 0; i < chain.segments.size(); ++i) {
    Segment& segment = chain.segments[i];
    segment.mount = rotation({1, 0, 0}, turn);
    segment.natural = turned_by(i).back(segment.natural);
    segment.initial = turned_by(i).back(segment.initial);
  }
  return chain;
}

/// Unknowns or residuals of the plain chain in the turned axes.
std::vector<double> turned(std::vector<double> x, std::size_t dofs) {
  for (std::size_t i = 0; i < elements; ++i) {
    double* p = &x[dofs * i];
    const Vec there = dofs == 3 ? load3(p) : Vec{0, p[0], p[1]};
    const Vec here = turned_by(i).back(there);
    if (dofs == 3) {
      store3(here, p);
    } else {
      p[0] = here.y;
      p[1] = here.z;
    }
  }
  return x;
}

double apart(const std::vector<double>& x, const std::vector<double>& y) {
  return largest(plus(x, -1, y)) / largest(y);
}

class ChainAsTree : public testing::TestWithParam<ModelSettings> {
 protected:
  const Parameters parameters_ =
      parameters_of("super_helix", with(curly_chain, GetParam()));
  const Strand chain_ = strand(parameters_);
  const std::size_t dofs_ = parameters_.word("modes") == "bend" ? 2 : 3;
};

TEST_P(ChainAsTree, TurnedMounts) {
  const auto plain = make(chain_, parameters_);
  const auto tree = make(turned(chain_), parameters_);
  const Solved expected = on_random_state(*plain);
  Solved s{turned(expected.q, dofs_),
           turned(expected.v, dofs_),
           turned(expected.a, dofs_),
           {},
           {}};
  evaluate(*tree, s);
  EXPECT_LE(apart(s.r, turned(expected.r, dofs_)), tolerance);
  EXPECT_LE(apart(s.x, turned(expected.x, dofs_)), tolerance);
}

/// Two strands on one root; segments of the two alternate.
Strand twins(const Strand& one, const Strand& other) {
  Strand tree = one;
  tree.segments.clear();
  for (std::size_t i = 0; i < one.segments.size(); ++i) {
    for (Segment segment : {one.segments[i], other.segments[i]}) {
      segment.parent = i == 0 ? -1 : static_cast<int>(tree.segments.size()) - 2;
      tree.segments.push_back(segment);
    }
  }
  return tree;
}

std::vector<double> interleaved(const std::vector<double>& one,
                                const std::vector<double>& other, std::size_t dofs) {
  std::vector<double> both;
  for (std::size_t i = 0; i < one.size(); i += dofs) {
    for (const auto* x : {&one, &other}) {
      const auto from = x->begin() + static_cast<std::ptrdiff_t>(i);
      both.insert(both.end(), from, from + static_cast<std::ptrdiff_t>(dofs));
    }
  }
  return both;
}

class TwinsOnOneClamp : public ChainAsTree {};  // a free root would couple them

TEST_P(TwinsOnOneClamp, MoveAsOneDoes) {
  const auto plain = make(chain_, parameters_);
  const auto tree = make(twins(chain_, turned(chain_)), parameters_);
  const Solved e = on_random_state(*plain);
  const auto both = [&](const std::vector<double>& x) {
    return interleaved(x, turned(x, dofs_), dofs_);
  };
  Solved s{both(e.q), both(e.v), both(e.a), {}, {}};
  evaluate(*tree, s);
  EXPECT_LE(apart(s.r, both(e.r)), tolerance);
  EXPECT_LE(apart(s.x, both(e.x)), tolerance);
}

std::vector<ModelSettings> variants(const std::vector<std::string>& roots) {
  std::vector<ModelSettings> all;
  for (const std::string& root : roots) {
    for (const std::string modes : {"bend_twist", "bend"}) {
      for (const std::string jacobian : {"exact", "elastic"}) {
        for (const std::string solver : {"recursive", "composite", "sparse"}) {
          all.push_back({{"modes", modes},
                         {"motion", root},
                         {"jacobian", jacobian},
                         {"solver", solver}});
        }
      }
    }
  }
  return all;
}

std::string name_of(const testing::TestParamInfo<ModelSettings>& tested) {
  std::string name;
  for (const auto& [key, word] : tested.param) {
    name += (name.empty() ? "" : "_") + word;
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Reduced, ChainAsTree,
                         testing::ValuesIn(variants({"shake_rotate", "free"})), name_of);
INSTANTIATE_TEST_SUITE_P(Reduced, TwinsOnOneClamp,
                         testing::ValuesIn(variants({"shake_rotate"})), name_of);

/// `chain` split from segment `from` on into two of half the width. In the plane that e1
/// is normal to each half has half the mass and half the stiffness.
Strand split(const Strand& chain, std::size_t from) {
  Strand tree = chain;
  tree.segments.resize(from);
  for (std::size_t i = from; i < chain.segments.size(); ++i) {
    for (int half = 0; half < 2; ++half) {
      Segment segment = chain.segments[i];
      segment.section.a1 /= 2;
      const auto count = static_cast<int>(tree.segments.size());
      segment.parent = i == from ? static_cast<int>(from) - 1 : count - 2;
      tree.segments.push_back(segment);
    }
  }
  return tree;
}

/// Curvatures about e1, one a segment, as unknowns of the split chain.
std::vector<double> fork(const std::vector<double>& planar, std::size_t from,
                         double halves) {
  std::vector<double> x;
  for (std::size_t i = 0; i < planar.size(); ++i) {
    for (std::size_t copy = 0; copy < (i < from ? 1U : 2U); ++copy) {
      x.insert(x.end(), {0, i < from ? planar[i] : halves * planar[i], 0});
    }
  }
  return x;
}

TEST(ForkOfHalves, MovesAsTheWholeInItsPlane) {
  constexpr std::size_t from = 5;
  const ModelSettings planar = {{"elements", "12"},
                                {"motion", "shake"},
                                {"root_tangent", "down"},
                                {"natural_curvature_per_m", "40"}};
  for (const std::string jacobian : {"exact", "elastic"}) {
    for (const std::string solver : {"recursive", "composite", "sparse"}) {
      const ModelSettings settings =
          with(planar, {{"jacobian", jacobian}, {"solver", solver}});
      const Parameters flat =
          parameters_of("super_helix", with(settings, {{"modes", "bend_planar"}}));
      const Parameters full = parameters_of("super_helix", settings);
      const auto whole = make(strand(flat), flat);
      const auto tree = make(split(strand(full), from), full);
      const Solved e = on_random_state(*whole);
      Solved s{fork(e.q, from, 1), fork(e.v, from, 1), fork(e.a, from, 1), {}, {}};
      evaluate(*tree, s);
      EXPECT_LE(apart(s.r, fork(e.r, from, 0.5)), tolerance) << jacobian << solver;
      EXPECT_LE(apart(s.x, fork(e.x, from, 1)), tolerance) << jacobian << solver;
    }
  }
}

}  // namespace tress::test_branching
