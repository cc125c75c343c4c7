#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include "experiments/numerics/fit.h"
#include "experiments/numerics/tip_track.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"
#include "tests/support/apart.h"
#include "tests/support/compliant.h"

namespace tress::test_block_descent {

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

constexpr double step = 0.1;                  // s
constexpr double spring = 300, friction = 2;  // N/m, N s/m: stiff, (h omega)^2 = 3

// Every choice has the same fixed point. Gauss-Seidel's rate is below the square of 2
// s/(1
// + 2 s), s = h^2 k + h c = 3.2, or 0.75; that of multipliers, for an exact descent on
// springs of 100 N/m, below 1 - 1/3: a thousand sweeps leave rounding, carried through
// five steps.
TEST(BlockDescent, ConvergedSweepsAreBackwardEulerOfALinearSystem) {
  for (const int masses : {2, 3, 8, 9}) {
    MassLine line(masses, spring, friction);
    const auto exact = at_end("backward_euler", line, options_of(step, {}), 5 * step);
    for (const char* order : {"root_to_tip", "bilateral"}) {
      for (const char* block : {"1", "2", "5", "0"}) {
        for (const char* chebyshev : {"0", "0.7"}) {
          const Words words{{"sweeps", "1000"},
                            {"sweep_order", order},
                            {"block", block},
                            {"chebyshev", chebyshev}};
          EXPECT_LE(apart(at_end("vbd", line, options_of(step, words), 5 * step), exact),
                    1e-12)
              << masses << " masses, " << order << ", blocks of " << block;
        }
        for (const char* primal : {"1", "4"}) {
          const Words words{{"sweeps", "1000"},        {"sweep_order", order},
                            {"block", block},          {"penalty_per_s2", "200"},
                            {"primal_sweeps", primal}, {"start", "adaptive"}};
          EXPECT_LE(
              apart(at_end("vbd_augmented", line, options_of(step, words), 5 * step),
                    exact),
              1e-12)
              << masses << " masses, " << order << ", blocks of " << block;
        }
      }
    }
  }
}

// A sweep over all nodes at once is a Newton iteration, of linear equations the last.
TEST(BlockDescent, OneSweepOfTheWholeSolvesALinearSystem) {
  MassLine line(20, 3e6, friction);
  const auto exact = at_end("backward_euler", line, options_of(step, {}), 5 * step);
  const Words whole{{"sweeps", "1"}, {"block", "0"}};
  // 3e6 h^2 times the rounding of forces.
  EXPECT_LE(apart(at_end("vbd", line, options_of(step, whole), 5 * step), exact), 1e-10);
  const Words pairs{{"sweeps", "1"}, {"block", "2"}};
  EXPECT_GT(apart(at_end("vbd", line, options_of(step, pairs), 5 * step), exact), 0.01);
}

// After the growth on the way that Gauss-Seidel's incomplete set of eigenvectors brings.
TEST(BlockDescent, ChebyshevConvergesFaster) {
  MassLine line(20, 3000, 0);
  const auto exact = at_end("backward_euler", line, options_of(step, {}), step);
  const auto left = [&](const char* rate) {
    const Words words{{"sweeps", "160"}, {"chebyshev", rate}};
    return apart(at_end("vbd", line, options_of(step, words), step), exact);
  };
  EXPECT_LT(left("0.9"), 0.01 * left("0"));
}

// Rows without compliance are no energy, but have multipliers.
TEST(BlockDescent, RigidRowsAreRefusedByDescentAloneAndHeldByMultipliers) {
  MassLine rigid(4, std::numeric_limits<double>::infinity(), 0);
  EXPECT_THAT(refusal(find_integrator("vbd"), rigid, Formulation::parametric),
              testing::HasSubstr("rows without compliance"));
  EXPECT_EQ(refusal(find_integrator("vbd_augmented"), rigid, Formulation::parametric),
            "");
  const Words words{{"sweeps", "1000"}, {"penalty_per_s2", "1000"}};
  const auto x = at_end("vbd_augmented", rigid, options_of(step, words), 3 * step);
  for (std::size_t i = 0; i + 1 < x.size(); ++i) EXPECT_NEAR(x[i + 1] - x[i], 1, 1e-12);
}

TEST(BlockDescent, ModelsWithoutCompliancesOrQuaternionsAreRefused) {
  const auto why = [](const char* integrator, const char* model) {
    return refusal(find_integrator(integrator), *make_model(model),
                   Formulation::parametric);
  };
  for (const char* integrator : {"vbd", "vbd_augmented", "stable_cosserat_rods"}) {
    EXPECT_EQ(why(integrator, "super_helix"),
              "needs the model's energy as compliant constraints");
    for (const char* model : {"xpbd_cosserat", "corde"}) {
      EXPECT_EQ(why(integrator, model), "") << model;
    }
  }
  EXPECT_EQ(why("vbd", "mass_spring"), "");
  EXPECT_EQ(why("stable_cosserat_rods", "mass_spring"),
            "needs a quaternion for every edge, with a closed form");
}

constexpr double short_step = 2e-3;  // s

// Not as xpbd, which leaves the change of G in the step: the fixed point is backward
// Euler's own, with friction on a turning root, whatever the matrices of the way there.
TEST(BlockDescent, ConvergedSweepsAreBackwardEulersOnStrands) {
  for (const std::string_view model : {"mass_spring", "corde", "xpbd_cosserat"}) {
    const auto system = soft_strand(model);
    const auto exact =
        at_end("backward_euler", *system, options_of(short_step, {}), 10 * short_step);
    const auto off = [&](std::string_view id, Words words, const char* sweeps) {
      words.emplace_back("sweeps", sweeps);
      return apart(at_end(id, *system, options_of(short_step, words), 10 * short_step),
                   exact);
    };
    const std::pair<std::string_view, Words> choices[] = {
        {"vbd", {}},
        {"vbd", {{"second_derivatives", "majorised"}, {"start", "adaptive"}}},
        {"vbd", {{"second_derivatives", "none"}}},
        {"vbd", {{"block", "3"}}},
        {"vbd", {{"block", "0"}}},
        {"vbd_augmented", {}},
        {"vbd_augmented", {{"block", "2"}, {"primal_sweeps", "3"}}}};
    for (const auto& [id, words] : choices) {
      std::string name = std::string(model) + ", " + std::string(id);
      for (const auto& [key, value] : words) name += " " + std::string(key) + "=" + value;
      const double few = off(id, words, "3"), many = off(id, words, "600");
      std::printf("%s: %.1e after 3 sweeps, %.1e converged\n", name.c_str(), few, many);
      // Newton's tolerance through ten steps, of coordinates of order one.
      EXPECT_LE(many, 1e-10) << name;
    }
  }
}

/// Rod without gravity that spins and tumbles: momenta are constant.
std::unique_ptr<System> flying(std::string_view model) {
  ModelSettings settings = {{"elements", "6"},
                            {"radius_m", "1e-3"},
                            {"youngs_modulus_pa", "1e6"},
                            {"motion", "free"},
                            {"gravity_m_s2", "0"}};
  return make_model(model, settings);
}

// Solved whole, momentum is kept and angular momentum lost as by backward Euler. Node by
// node it is not before sweeps have converged: a node pushes off from held neighbours.
TEST(BlockDescent, MomentumInFreeFlightIsBackwardEulersOnceSolved) {
  for (const std::string_view model : {"mass_spring", "xpbd_cosserat"}) {
    const auto system = flying(model);
    const auto momentum = [&](std::string_view id, const Words& words) {
      Drive drive(id, *system, options_of(1e-3, words));
      EXPECT_EQ(drive.to(0.02), Status::ok) << drive.integrator->failure();
      return *system->energetics()->momentum(0.02, drive.integrator->q(),
                                             drive.integrator->v());
    };
    Drive still("backward_euler", *system, options_of(1e-3, {}));
    const Momentum start = *system->energetics()->momentum(0, still.q0, still.v0);
    const Momentum euler = momentum("backward_euler", {});
    const auto size = [](const std::array<double, 3>& x) {
      return std::hypot(x[0], x[1], x[2]);
    };
    const auto off = [&](const std::array<double, 3>& x, const std::array<double, 3>& y) {
      return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]) / size(y);
    };
    const Momentum whole = momentum("vbd", {{"block", "0"}, {"sweeps", "12"}});
    const Momentum nodes = momentum("vbd", {{"sweeps", "3"}});
    std::printf(
        "%s: linear momentum off by %.1e whole, %.1e after 3 sweeps; angular "
        "%.1e, %.1e from backward_euler, whose own is off by %.1e\n",
        std::string(model).c_str(), off(whole.linear, start.linear),
        off(nodes.linear, start.linear), off(whole.angular, euler.angular),
        off(nodes.angular, euler.angular), off(euler.angular, start.angular));
    // Newton's tolerance over the step, of rates.
    EXPECT_LE(off(whole.linear, start.linear), 1e-9) << model;
    EXPECT_LE(off(whole.angular, euler.angular), 1e-8) << model;
    EXPECT_GT(off(nodes.angular, euler.angular), 1e-6) << model;
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

// Springs of a hair are so stiff that bending cannot pass through nodes one by one;
// multipliers carry it.
TEST(BlockDescent, LocksOnAHairAndIsFreedByMultipliersOrAsAWhole) {
  const double locked = from_direct("vbd", {{"sweeps", "20"}});
  const double blocks = from_direct("vbd", {{"sweeps", "20"}, {"block", "8"}});
  const double freed = from_direct("vbd_augmented", {{"sweeps", "20"}});
  const double whole = from_direct("vbd", {{"sweeps", "12"}, {"block", "0"}});
  std::printf(
      "from the direct step: vbd %.3g, by eight nodes %.3g, vbd_augmented %.2g, "
      "whole %.1e\n",
      locked, blocks, freed, whole);
  EXPECT_GE(locked, 0.1);
  EXPECT_GE(blocks, 0.1);
  EXPECT_LE(freed, 0.01);
  EXPECT_LE(whole, 1e-9);  // Newton's tolerance through the run
}

/// Slope of energy and friction, at rates (x - origin)/h, by the coordinates.
std::vector<double> slope(ComplianceForm& form, double t, double h, In origin, In q) {
  std::vector<double> sum(q.size());
  ComplianceForm::Value value;
  for (std::size_t k = 0; k < form.blocks().size(); ++k) {
    const auto& block = form.blocks()[k];
    std::vector<double> x;
    for (const int i : block.coordinates) x.push_back(q[static_cast<std::size_t>(i)]);
    form.evaluate(t, k, x, value);
    for (std::size_t r = 0; r < static_cast<std::size_t>(block.rows); ++r) {
      double rate = value.drift[r];
      for (std::size_t i = 0; i < x.size(); ++i) {
        const auto at = static_cast<std::size_t>(block.coordinates[i]);
        rate += value.gradient[r][i] * (x[i] - origin[at]) / h;
      }
      const double stress = value.c[r] / block.alpha[r] + block.friction[r] * rate;
      for (std::size_t i = 0; i < x.size(); ++i) {
        sum[static_cast<std::size_t>(block.coordinates[i])] +=
            stress * value.gradient[r][i];
      }
    }
  }
  return sum;
}

// The closed form is a step towards the balance of the model's own energy, whatever the
// stiffness about the axes, with friction and a turning wall.
TEST(StableCosseratRods, RepeatedStepsOfAnOrientationBalanceIt) {
  constexpr double t = 0.01, h = 1e-3;
  for (const char* model : {"corde", "xpbd_cosserat"}) {
    const auto system = make_model(model, {{"elements", "3"},
                                           {"motion", "shake_rotate"},
                                           {"ellipticity", "1.5"},
                                           {"natural_curvature_per_m", "8"},
                                           {"natural_twist_per_m", "5"},
                                           {"internal_friction_kg_m3_s", "1e-9"}});
    ComplianceForm& form = *system->compliance_form();
    const auto n = static_cast<std::size_t>(system->layout().coordinates);
    std::vector<double> origin(n), v(n);
    system->initial_state(origin, v);
    std::vector<double> x = origin;
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += (i < 9 ? 1e-3 : 0.1) * std::sin(7.0 * static_cast<double>(i));
    }
    EXPECT_EQ(form.orientations().size(), 3);
    for (const auto& [coordinates, own] : form.orientations()) {
      double square = 0;
      for (std::size_t k = own; k < own + 4; ++k) {
        square += std::pow(x[static_cast<std::size_t>(coordinates[k])], 2);
      }
      for (std::size_t k = own; k < own + 4; ++k) {
        x[static_cast<std::size_t>(coordinates[k])] /= std::sqrt(square);
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [coordinates, own] = form.orientations()[k];
      const auto of = [&, &all = coordinates](In y) {
        std::vector<double> local;
        for (const int i : all) local.push_back(y[static_cast<std::size_t>(i)]);
        return local;
      };
      /// Of the slope, across the quaternion.
      const auto unbalanced = [&, &all = coordinates, first = own](In y) {
        const auto g = slope(form, t, h, origin, y);
        double along = 0, square = 0;
        for (std::size_t i = first; i < first + 4; ++i) {
          const auto at = static_cast<std::size_t>(all[i]);
          along += g[at] * y[at];
          square += g[at] * g[at];
        }
        return std::sqrt(std::max(0.0, square - along * along));
      };
      const double before = unbalanced(x);
      std::vector<double> turned = x;
      for (int times = 0; times < 60; ++times) {
        std::vector<double> local = of(turned);
        form.orient(t, h, k, of(origin), local);
        double square = 0;
        for (std::size_t i = own; i < own + 4; ++i) {
          turned[static_cast<std::size_t>(coordinates[i])] = local[i];
          square += local[i] * local[i];
        }
        EXPECT_NEAR(square, 1, 1e-14);
      }
      EXPECT_GT(before, 1e-6) << model;
      // Rounding of what the square is a difference of.
      EXPECT_LE(unbalanced(turned), 1e-7 * before) << model << ", edge " << k;
    }
  }
}

// The limit of backward Euler's step for orientations of less and less inertia: the
// distance is proportional to it, the section's own being (r/l)^2/2 = 4.5e-4.
TEST(StableCosseratRods, ConvergedSweepsAreBackwardEulersWithoutRotaryInertia) {
  const auto strand_of = [](const char* inertia) {
    return make_model("xpbd_cosserat", {{"elements", "3"},
                                        {"radius_m", "1e-3"},
                                        {"natural_curvature_per_m", "8"},
                                        {"youngs_modulus_pa", "1e6"},
                                        {"motion", "shake_rotate"},
                                        {"norm", "1e4"},
                                        {"edge_inertia", inertia}});
  };
  constexpr double t_end = 20 * short_step;
  const auto positions_of = [](std::vector<double> q) {
    q.resize(9);
    return q;
  };
  const auto limit =
      positions_of(at_end("stable_cosserat_rods", *strand_of("0"),
                          options_of(short_step, {{"sweeps", "1500"}}), t_end));
  std::vector<double> inertias, errors;
  for (const char* inertia : {"0.1", "0.03", "0.01"}) {
    inertias.push_back(std::stod(inertia) + 4.5e-4);
    errors.push_back(apart(positions_of(at_end("backward_euler", *strand_of(inertia),
                                               options_of(short_step, {}), t_end)),
                           limit));
    std::printf("edge inertia %s: %.2e m\n", inertia, errors.back());
  }
  EXPECT_NEAR(log_log_slope(inertias, errors), 1, 0.2);
}

}  // namespace tress::test_block_descent
