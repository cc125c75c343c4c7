#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "contract/input_error.h"
#include "experiments/numerics/tip_track.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"
#include "integrators/position_based/anderson.h"
#include "tests/support/apart.h"
#include "tests/support/compliant.h"

namespace tress::test_anderson {

using namespace experiments;
using namespace testing_support;

using Words = std::vector<std::pair<std::string_view, std::string>>;

Options options_of(double step, const Words& words) {
  Options options;
  options.step = step;
  options.newton_tolerance = 1e-13;
  for (const auto& [key, value] : words) apply(options, key, value, "test");
  return options;
}

/// Largest entries of x <- A x from (1, ..., 1), after every iteration. A is a chain
/// whose slowest mode keeps 0.99 of itself.
std::vector<double> errors_of(int depth, int iterations) {
  constexpr std::size_t n = 8;
  std::array<double, n> x;
  x.fill(1);
  integrators::AndersonMixing mixing(depth, n, std::vector<double>(n, 1.0));
  std::vector<double> errors;
  for (int k = 0; k < iterations; ++k) {
    const std::array<double, n> from = x;
    double most = 0;
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = (0.99 - 0.1 * static_cast<double>(i)) * from[i];
      if (i > 0) x[i] += 0.05 * from[i - 1];
    }
    mixing.mix(from, x);
    for (const double entry : x) most = std::max(most, std::abs(entry));
    errors.push_back(most);
  }
  return errors;
}

// As GMRES, with as many iterations as dimensions and one more; the matrix of differences
// has a condition number of about 1e5.
TEST(AndersonMixing, SolvesALinearSystemInItsDimension) {
  EXPECT_LE(errors_of(8, 9).back(), 1e-9);
  EXPECT_GE(errors_of(0, 9).back(), 0.5);
  EXPECT_LE(errors_of(2, 40).back(), 0.5 * errors_of(0, 40).back());
}

TEST(AndersonMixing, FirstIterationIsPlain) {
  EXPECT_EQ(errors_of(8, 1), errors_of(0, 1));
  EXPECT_NE(errors_of(8, 2), errors_of(0, 2));
}

TEST(AndersonMixing, ForgetsIterationsThatGrow) {
  integrators::AndersonMixing mixing(3, 1, {1.0});
  const auto mixed = [&mixing](double from, double g) {
    mixing.mix(In(&from, 1), InOut(&g, 1));
    return g;
  };
  mixed(0, 1);
  EXPECT_EQ(mixed(1, 1.5), 2);  // f of 1, then 0.5: the secant's root
  EXPECT_EQ(mixed(2, 4), 4);    // f of 2: more than twice as large
  mixing.restart();
  EXPECT_EQ(mixed(4, 5), 5);
}

constexpr double step = 0.1;                  // s
constexpr double spring = 300, friction = 2;  // N/m, N s/m: stiff, (h omega)^2 = 3

// As BlockDescent.ConvergedSweepsAreBackwardEulerOfALinearSystem: the fixed point is that
// of plain sweeps.
TEST(Anderson, ConvergedSweepsAreBackwardEulerOfALinearSystem) {
  for (const int masses : {2, 3, 8, 9}) {
    MassLine line(masses, spring, friction);
    const auto exact = at_end("backward_euler", line, options_of(step, {}), 5 * step);
    for (const char* order : {"root_to_tip", "bilateral"}) {
      const auto off = [&](std::string_view id, Words words) {
        words.insert(words.end(),
                     {{"sweeps", "1000"}, {"sweep_order", order}, {"anderson", "5"}});
        return apart(at_end(id, line, options_of(step, words), 5 * step), exact);
      };
      for (const char* block : {"1", "2", "5", "0"}) {
        EXPECT_LE(off("vbd", {{"block", block}}), 1e-12)
            << masses << ", blocks of " << block;
      }
      EXPECT_LE(off("xpbd", {}), 1e-12) << masses;
    }
  }
}

/// Distance of a line of 20 masses from backward Euler's after one step.
double left(std::string_view id, double stiffness, int sweeps, const char* anderson) {
  MassLine line(20, stiffness, 0);
  const auto exact = at_end("backward_euler", line, options_of(step, {}), step);
  const Words words{{"sweeps", std::to_string(sweeps)}, {"anderson", anderson}};
  return apart(at_end(id, line, options_of(step, words), step), exact);
}

// At (h omega)^2 = 300 plain sweeps need 2387 with vbd and 384 with xpbd, Anderson's 54
// and 35.
TEST(Anderson, TakesFewerSweepsOnAStiffLine) {
  constexpr double stiff = 3e4, wanted = 1e-6;
  EXPECT_LE(left("vbd", stiff, 60, "5"), wanted);
  EXPECT_GT(left("vbd", stiff, 600, "0"), wanted);
  EXPECT_LE(left("xpbd", stiff, 60, "5"), wanted);
  EXPECT_GT(left("xpbd", stiff, 180, "0"), wanted);
}

// At (h omega)^2 = 0.03 three sweeps are enough with and without.
TEST(Anderson, SavesNoSweepOnASoftLine) {
  constexpr double soft = 3, wanted = 1e-6;
  for (const char* id : {"vbd", "xpbd"}) {
    EXPECT_GT(left(id, soft, 2, "5"), wanted) << id;
    EXPECT_LE(left(id, soft, 3, "0"), wanted) << id;
  }
}

/// Of the swinging strand of 20 elements without drag, which sweeps take from the start
/// of a step: how far tips are from those of the direct step, root mean square over the
/// run and over its length.
double from_direct(std::string_view id, const Words& words) {
  constexpr double t_end = 1;
  constexpr int samples = 100;
  const ModelEntry& model = find_model("mass_spring");
  Parameters p(setup_parameters(model), "test");
  set_known(p, find_strand_scene("swing").settings);
  set_known(p, {{"elements", "20"}, {"mass_damping_per_s", "0"}});
  const auto system = model.make(p);
  const auto tips = [&](std::string_view method, const Words& of_method) {
    const TipRun run =
        run_tip(method, *system, options_of(1.0 / 300, of_method), t_end, samples);
    EXPECT_EQ(run.status, Status::ok) << method << ": " << run.failure;
    return run.tip;
  };
  static const std::vector<double> direct = tips("backward_euler", {});
  return tip_error(tips(id, words), direct, p.number("length_m"));
}

// Bending passes through a hair's springs in steps of one node. Acceleration halves the
// distance of xpbd, but what locks vbd is no slow mode that earlier sweeps show.
TEST(Anderson, HalvesTheDistanceOfXpbdOnAHairAndLeavesVbdLocked) {
  const auto off = [](std::string_view id, const char* anderson) {
    const double distance = from_direct(id, {{"sweeps", "20"}, {"anderson", anderson}});
    std::printf("%s, 20 sweeps, anderson %s: %.3g\n", std::string(id).c_str(), anderson,
                distance);
    return distance;
  };
  EXPECT_LE(off("xpbd", "5"), 0.6 * off("xpbd", "0"));
  EXPECT_GE(off("vbd", "5"), 0.5);
}

TEST(Anderson, ExcludesChebyshev) {
  MassLine line(4, spring, 0);
  const Words both{{"chebyshev", "0.8"}, {"anderson", "3"}};
  EXPECT_THROW((void)at_end("vbd", line, options_of(step, both), step), InputError);
}

}  // namespace tress::test_anderson
