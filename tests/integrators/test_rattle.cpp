#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "integrators/catalogue.h"
#include "models/catalogue.h"

namespace tress::test_rattle {

using namespace integrators;
using namespace models;

struct Motion {
  std::vector<double> q, v;
};

/// `from`, `steps` steps of 0.05 s later.
Motion after(System& system, const Motion& from, int steps) {
  Options options;
  options.formulation = Formulation::rattle;
  options.step = 0.05;
  const auto method = make_integrator("rattle", system, options);
  EXPECT_EQ(method->start(0, from.q, from.v), Status::ok);
  EXPECT_EQ(method->advance(steps * options.step), Status::ok) << method->failure();
  return {{method->q().begin(), method->q().end()},
          {method->v().begin(), method->v().end()}};
}

// The step is its own adjoint [Hairer, Lubich, Wanner 2006, section VII.1.4]: with the
// velocity turned round it leads back, at any length of the step. What is left is the
// rounding of g, which projection goes down to, over a step: some 1e-15/0.05.
TEST(Rattle, GoesBackTheWayItCame) {
  const ModelEntry& entry = find_model("inextensible_chain");
  Parameters parameters(entry.parameters, "model inextensible_chain");
  parameters.set("links", "3");
  parameters.set("drag_kg_m_s", "0");
  const auto system = entry.make(parameters);
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  Motion start{std::vector<double>(n), std::vector<double>(n)};
  system->initial_state(start.q, start.v);
  const Motion there = after(*system, start, 3);  // moving
  constexpr int steps = 5;
  Motion turned = after(*system, there, steps);
  for (double& v : turned.v) v = -v;
  const Motion back = after(*system, turned, steps);
  double moved = 0;
  for (std::size_t i = 0; i < n; ++i) {
    moved = std::max(moved, std::abs(turned.q[i] - there.q[i]));
    EXPECT_NEAR(back.q[i], there.q[i], 1e-11) << i;
    EXPECT_NEAR(back.v[i], -there.v[i], 1e-10) << i;
  }
  EXPECT_GT(moved, 0.1);
}

}  // namespace tress::test_rattle
