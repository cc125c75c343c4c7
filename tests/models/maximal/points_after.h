#pragma once

#include <string_view>
#include <vector>

#include "contract/forms/material_points.h"
#include "tests/models/reduced/strand_cases.h"

namespace tress::testing_support {

using namespace simulation;

/// Where a strand's points are at t, by the trapezoidal rule.
inline std::vector<double> points_after(std::string_view model,
                                        const ModelSettings& settings, double t,
                                        std::vector<double>& q) {
  const auto system = make_model(model, settings);
  State start{zeros(*system), zeros(*system)};
  system->initial_state(start.q, start.v);
  Options options;
  options.step = 1e-3;
  if (system->layout().constraints > 0) options.formulation = Formulation::projection;
  const Simulation run =
      simulate("generalized_alpha", *system, options, start, t, [&](double, In now, In) {
        q.assign(now.begin(), now.end());
        return true;
      });
  EXPECT_EQ(run.status, Status::ok) << run.failure;
  MaterialPoints& at = *system->material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(at.count()));
  at.positions(t, q, x);
  return x;
}

}  // namespace tress::testing_support
