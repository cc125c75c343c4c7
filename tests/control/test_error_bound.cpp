// How often the true error of a run lies within the bound that is printed beside its
// estimate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "simulation/errors/error_bars.h"
#include "simulation/scene_changes/changes.h"
#include "tests/control/hairs.h"

namespace tress::test_error_bound {

using namespace simulation;
using namespace testing_support;

constexpr const char* models[] = {"super_helix", "articulated_chain", "der"};
constexpr const char* methods[] = {
    "id = \"backward_euler\"\ndt_s = 0.002", "id = \"implicit_midpoint\"\ndt_s = 0.002",
    "id = \"bdf2\"\ndt_s = 0.002", "id = \"tr_bdf2\"\nposition_tol_rel = 1e-3",
    "id = \"esdirk43\"\nposition_tol_rel = 1e-3"};
constexpr const char* exact = "id = \"esdirk43\"\nposition_tol_rel = 1e-6";
constexpr const char* duration = "0.2";
constexpr double coverage = 0.9;

/// True error over estimate of every run.
class Coverage {
 public:
  /// The true error is the distance from `reference`, over the frames before the run
  /// parts from it or from the finer run of its estimate.
  void add(const Scene& scene, const Scene& reference, const ErrorBar& estimate) {
    ASSERT_EQ(estimate.missing, "");
    const ErrorBar found = distance(scene, reference, 1, 1);
    ASSERT_EQ(found.missing, "");
    if (estimate.frames.empty()) return;  // parted at once: no estimate, and no bound
    double largest = 0;
    const std::size_t frames = std::min(found.frames.size(), estimate.frames.size());
    for (std::size_t k = 0; k < frames; ++k) {
      largest = std::max(largest, found.frames[k].largest);
    }
    ratios_.push_back(largest / estimate.strands.at(0).error.largest);
  }

  std::size_t runs() const { return ratios_.size(); }
  /// Prints quantiles.
  double within(double bound) {
    std::ranges::sort(ratios_);
    const auto at = [&](double share) {
      return ratios_[static_cast<std::size_t>(share * static_cast<double>(runs() - 1))];
    };
    std::printf(
        "%zu runs, true error over estimate: median %.2f, 90 %% %.2f, most %.2f\n",
        runs(), at(0.5), at(0.9), ratios_.back());
    const auto count =
        std::ranges::count_if(ratios_, [&](double x) { return x <= bound; });
    return static_cast<double>(count) / static_cast<double>(runs());
  }

 private:
  std::vector<double> ratios_;
};

TEST(ErrorBound, CoversTheTimeErrorOfNineRunsInTen) {
  Coverage found;
  for (const ControlledHair& hair : controlled_hairs()) {
    for (const char* const model : models) {
      for (const char* const method : methods) {
        const Scene scene = scene_of(hair, model, method, duration, 8);
        found.add(scene, scene_of(hair, model, exact, duration, 8), time_error(scene, 1));
      }
    }
  }
  EXPECT_TRUE(time_population.starts_with(std::to_string(found.runs()) + " runs"));
  EXPECT_GE(found.within(time_bound), coverage);
}

/// References have four times the elements, and an error of 1/16 at order 2.
TEST(ErrorBound, CoversTheSpaceErrorOfNineRunsInTen) {
  Coverage found;
  for (const ControlledHair& hair : controlled_hairs()) {
    for (const char* const model : models) {
      const Scene scene = scene_of(
          hair, model, "id = \"esdirk43\"\nposition_tol_rel = 1e-5", duration, 8);
      found.add(scene, with_elements(scene, 32), space_error(scene, 1));
    }
  }
  EXPECT_TRUE(space_population.starts_with(std::to_string(found.runs()) + " runs"));
  EXPECT_GE(found.within(space_bound), coverage);
}

}  // namespace tress::test_error_bound
