#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "models/catalogue.h"
#include "tests/support/drive.h"

namespace tress::testing_support {

/// Returns the coordinates of `double_pendulum` after 2 s.
inline std::vector<double> double_pendulum(std::string_view id, const Options& options) {
  const models::ModelEntry& entry = models::find_model("double_pendulum");
  const auto system = entry.make(Parameters(entry.parameters, "model"));
  Drive drive(id, *system, options);
  EXPECT_EQ(drive.to(2), Status::ok) << drive.integrator->failure();
  return {drive.integrator->q().begin(), drive.integrator->q().end()};
}

/// Expects at least `order` between any two of these numbers of steps, each twice the one
/// before. Returns the last error. The mass matrix depends on the coordinates.
inline double expect_order_on_double_pendulum(std::string_view id, Options options,
                                              std::initializer_list<int> numbers,
                                              double order) {
  Options fine;
  fine.rtol = fine.atol = 1e-15;
  const std::vector<double> exact = double_pendulum("gsl_rk8pd", fine);
  double before = 0;
  for (const int steps : numbers) {
    options.step = 2. / steps;
    const std::vector<double> end = double_pendulum(id, options);
    double error = 0;
    for (std::size_t i = 0; i < end.size(); ++i) {
      error = std::max(error, std::abs(end[i] - exact[i]));
    }
    if (before > 0) {
      EXPECT_GE(std::log2(before / error), order) << steps << " steps: " << error;
    }
    before = error;
  }
  return before;
}

}  // namespace tress::testing_support
