#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cstdio>

#include "experiments/problems/strand_scenes.h"
#include "models/effects/body.h"
#include "models/effects/wind.h"
#include "models/reduced/super_helix.h"
#include "tests/models/reduced/strand_cases.h"

namespace tress::test_solvers {

using namespace experiments;

using namespace testing_support;

constexpr std::array solvers = {"composite", "recursive", "sparse"};

const ModelSettings curly = {{"natural_curvature_per_m", "60"},
                             {"natural_curvature2_per_m", "10"},
                             {"natural_twist_per_m", "20"},
                             {"ellipticity", "1.3"},
                             {"grading", "2"},
                             {"internal_friction_kg_m3_s", "1e-11"}};

std::vector<StrandCase> solver_cases() {
  std::vector<StrandCase> all;
  for (const std::string modes : {"bend_twist", "bend", "bend_planar"}) {
    const ModelSettings shape = modes == "bend_planar" ? ModelSettings{} : curly;
    for (const std::string root : {"fixed", "shake_rotate"}) {
      for (const std::string model : {"super_helix", "articulated_chain"}) {
        all.push_back({model + "_" + modes + "_" + root, find_model(model).id,
                       with(shape, {{"modes", modes}, {"motion", root}})});
      }
    }
    all.push_back({"super_clothoid_" + modes, "super_clothoid",
                   with(shape, {{"modes", modes}, {"motion", "shake_rotate"}})});
    if (modes == "bend_planar") continue;
    all.push_back({"super_helix_" + modes + "_free", "super_helix",
                   with(shape, {{"modes", modes}, {"motion", "free"}})});
    for (const std::string tree : {"algae", "complex_tree"}) {
      all.push_back({"tree_" + tree + "_" + modes,
                     "super_helix_tree",
                     {{"tree", tree}, {"modes", modes}, {"motion", "shake_rotate"}}});
    }
  }
  for (const std::string model : {"super_helix", "super_clothoid"}) {
    all.push_back({model + "_tree_algae_free",
                   find_model(model + "_tree").id,
                   {{"tree", "algae"}, {"motion", "free"}}});
  }
  return all;
}

/// Of S scaled to unit diagonal; `system` holds S factored.
double scaled_condition(System& system) {
  const int n = system.layout().coordinates;
  Eigen::MatrixXd inverse(n, n);
  std::vector<double> b = zeros(system), x = zeros(system);
  for (int j = 0; j < n; ++j) {
    std::ranges::fill(b, 0.0);
    b[static_cast<std::size_t>(j)] = 1;
    EXPECT_EQ(system.solve(b, x), Status::ok);
    inverse.col(j) = Eigen::Map<const Eigen::VectorXd>(x.data(), n);
  }
  const Eigen::MatrixXd s = inverse.inverse();
  const Eigen::VectorXd size = s.diagonal().cwiseAbs().cwiseSqrt();
  const Eigen::MatrixXd scaled =
      size.cwiseInverse().asDiagonal() * s * size.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd scaled_inverse = size.asDiagonal() * inverse * size.asDiagonal();
  return scaled.norm() * scaled_inverse.norm();
}

class Solvers : public testing::TestWithParam<StrandCase> {};

TEST_P(Solvers, AgreeOnRandomStates) {
  for (const std::string jacobian : {"elastic", "exact"}) {
    std::array<std::unique_ptr<System>, solvers.size()> systems;
    for (std::size_t k = 0; k < solvers.size(); ++k) {
      systems[k] = GetParam().make({{"jacobian", jacobian}, {"solver", solvers[k]}});
    }
    System& composite = *systems[0];
    unsigned seed = 1;
    for (const double h : {0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
      States s(composite, seed++);
      s.shake(0.5);
      std::vector<double> b = zeros(composite);
      ASSERT_EQ(composite.residual(t0, s.q, s.v, s.a, b), Status::ok);
      std::array<std::vector<double>, solvers.size()> x;
      for (std::size_t k = 0; k < solvers.size(); ++k) {
        SCOPED_TRACE(std::string(solvers[k]) + ", " + jacobian +
                     ", h = " + std::to_string(h));
        x[k] = zeros(composite);
        ASSERT_EQ(systems[k]->linearize(t0, s.q, s.v, s.a, {1, h, h * h}), Status::ok);
        ASSERT_EQ(systems[k]->solve(b, x[k]), Status::ok);
      }
      // 1e-10, but where the numbers of the matrix themselves, rounded to eps, leave its
      // solution less certain than that: eps cond. The twist of a thin strand has next to
      // no mass, so with twist that is so for h below some 1e-4 s.
      const double tolerance =
          h >= 1e-4 ? 1e-10 : std::max(1e-10, eps * scaled_condition(composite));
      for (std::size_t k = 1; k < solvers.size(); ++k) {
        EXPECT_LE(relative_difference(x[k], x[0], s.a_typ), tolerance)
            << solvers[k] << ", " << jacobian << ", h = " << h;
      }
    }
  }
}

/// The elastic Jacobian has no derivatives of inertial and geometric terms, but all of
/// drag: with y = S^-1 b of the strand with drag and D y = r_v y the force of drag at
/// rates y, the strand without drag has S y = b - w.vel D y.
TEST_P(Solvers, StiffTangentHoldsTheDerivativesOfEffects) {
  const Weights w{1, 1e-3, 1e-6};
  // h nu L = 1e-5 kg against a hair's 6.5e-7 kg; trees are heavier.
  const ModelSettings drag{{"drag_kg_m_s", "0.1"}}, none{};
  const auto force = [](System& system, In q, In v) {
    std::vector<double> r = zeros(system), a = zeros(system);
    EXPECT_EQ(system.residual(t0, q, v, a, r), Status::ok);
    return r;
  };
  const auto by_drag = GetParam().make(drag), bare = GetParam().make(none);
  for (const std::string solver : solvers) {
    const ModelSettings stiff{{"jacobian", "elastic"}, {"solver", solver}};
    const auto with_drag = GetParam().make(with(stiff, drag));
    const auto without = GetParam().make(stiff);
    States s(*with_drag, 3);
    s.shake(0.5);
    const std::vector<double> b = force(*with_drag, s.q, s.v), still = zeros(*with_drag);
    std::vector<double> y = still, x = still;
    ASSERT_EQ(with_drag->linearize(t0, s.q, s.v, s.a, w), Status::ok);
    ASSERT_EQ(with_drag->solve(b, y), Status::ok);
    ASSERT_EQ(without->linearize(t0, s.q, s.v, s.a, w), Status::ok);
    ASSERT_EQ(without->solve(b, x), Status::ok);
    const double without_drag = relative_difference(x, y, s.a_typ);
    // At rates of typical size: linear in them up to inertial terms, which the bare
    // strand has alike. What rounding leaves of the difference: eps |r| over it.
    double fastest = 0, largest_force = 0, largest_drag = 0;
    for (std::size_t k = 0; k < y.size(); ++k) {
      fastest = std::max(fastest, std::abs(y[k]) / s.v_typ[k]);
    }
    std::vector<double> rate = y, rest = b;
    for (double& entry : rate) entry /= fastest;
    const auto r = force(*by_drag, s.q, rate), r0 = force(*by_drag, s.q, still);
    const auto i = force(*bare, s.q, rate), i0 = force(*bare, s.q, still);
    for (std::size_t k = 0; k < rest.size(); ++k) {
      const double of_drag = (r[k] - r0[k]) - (i[k] - i0[k]);
      largest_force = std::max({largest_force, std::abs(r[k]), std::abs(i[k])});
      largest_drag = std::max(largest_drag, std::abs(of_drag));
      rest[k] -= w.vel * fastest * of_drag;
    }
    const double tolerance = 1e-10 + 100 * eps * largest_force / largest_drag;
    EXPECT_GT(without_drag, 1e3 * tolerance) << "drag should matter";
    ASSERT_EQ(without->solve(rest, x), Status::ok);
    EXPECT_LE(relative_difference(x, y, s.a_typ), tolerance) << solver;
  }
}

INSTANTIATE_TEST_SUITE_P(Reduced, Solvers, testing::ValuesIn(solver_cases()),
                         [](const auto& tested) { return tested.param.name; });

/// In contact with a plane at the height of the root, in wind and with drag, from which
/// the pivots of the exact Jacobian get every sign.
std::unique_ptr<System> loaded_strand(std::string_view model,
                                      const ModelSettings& settings) {
  const Parameters parameters = parameters_of(model, settings);
  const Strand made = strand(parameters);
  Effects effects = strand_effects(parameters);
  effects.push_back(std::make_shared<Body>(
      Plane{}, StrandPlace{},
      BodyContact{.stiffness = 1e5, .damping = 1, .friction = 0.3, .offset = 1e-4}));
  Parameters wind(wind_parameters(), "effects.wind");
  wind.set("velocity_m_s", "10,3,2");
  wind.set("law", "quadratic");
  effects.push_back(make_wind(wind, made.root));
  return find_model(model).on_strand(made, parameters, effects);
}

// Where contact and drag leave next to nothing of a segment's pivot the elimination
// without exchange of rows loses as many digits; sparse and composite exchange them.
TEST(ExactRecursion, KeepsTheDigitsThatSmallPivotsCost) {
  double worst = 0;
  for (const std::string model : {"super_helix", "articulated_chain"}) {
    for (const std::string root : {"fixed", "free"}) {
      for (const std::string elements : {"10", "40"}) {
        const ModelSettings settings = {
            {"elements", elements},        {"motion", root},
            {"root_tangent", "x"},         {"natural_curvature_per_m", "300"},
            {"natural_twist_per_m", "60"}, {"drag_kg_m_s", "1e-4"},
            {"jacobian", "exact"}};
        std::array<std::unique_ptr<System>, solvers.size()> systems;
        for (std::size_t k = 0; k < solvers.size(); ++k) {
          systems[k] = loaded_strand(model, with(settings, {{"solver", solvers[k]}}));
        }
        System& composite = *systems[0];
        for (unsigned seed = 1; seed <= 40; ++seed) {
          States s(composite, seed);
          const double h = std::pow(10, -3 + 0.05 * seed);  // s, from 1e-3 to 0.1
          s.q = plus(s.q, 5, s.random(s.q_typ));
          s.v = s.random(s.v_typ);
          s.a = zeros(composite);
          std::vector<double> b = zeros(composite);
          ASSERT_EQ(composite.residual(t0, s.q, s.v, s.a, b), Status::ok);
          std::array<std::vector<double>, solvers.size()> x;
          for (std::size_t k = 0; k < solvers.size(); ++k) {
            x[k] = zeros(composite);
            ASSERT_EQ(systems[k]->linearize(t0, s.q, s.v, s.a, {1, h, h * h}),
                      Status::ok);
            ASSERT_EQ(systems[k]->solve(b, x[k]), Status::ok);
          }
          const double unit = eps * scaled_condition(composite);
          const double recursive = relative_difference(x[1], x[0], s.a_typ);
          worst = std::max(worst, recursive / unit);
          // Ten for the roundings of an elimination that exchanges rows. The recursion
          // accepts sums of a hundred times a pivot, of which as much may be rounding.
          EXPECT_LE(relative_difference(x[2], x[0], s.a_typ), std::max(1e-13, 10 * unit));
          EXPECT_LE(recursive, std::max(1e-13, 100 * unit))
              << model << ", " << root << ", " << elements << ", seed " << seed;
        }
      }
    }
  }
  std::printf("worst difference over eps cond: %.2g\n", worst);
}

class Trajectories : public testing::TestWithParam<StrandCase> {};

TEST_P(Trajectories, OfAllSolversAreTheSame) {
  constexpr double step = 2e-4, t_end = 0.2;  // 1000 steps, below the limit of 0.5 ms
  const auto run = [&](const std::string& solver) {
    const auto system = GetParam().make({{"jacobian", "elastic"}, {"solver", solver}});
    Options options;
    options.step = step;
    return simulate("linearly_implicit_euler", *system, options, initial_state(*system),
                    t_end);
  };
  const Simulation composite = run("composite");
  ASSERT_EQ(composite.status, Status::ok) << composite.failure;
  ASSERT_EQ(composite.stats.steps, 1000);
  for (const std::string solver : {"recursive", "sparse"}) {
    const Simulation other = run(solver);
    ASSERT_EQ(other.status, Status::ok) << other.failure;
    // 1000 steps each add a difference of eps cond = 2e-11 of the step's own change, and
    // the shaken strand, which the step damps, does not amplify it.
    const std::vector<double> same(other.state.q.size(), 1.0);
    EXPECT_LE(relative_difference(other.state.q, composite.state.q, same), 1e-9);
    EXPECT_LE(relative_difference(other.state.v, composite.state.v, same), 1e-9);
  }
}

std::vector<StrandCase> shaken() {
  std::vector<StrandCase> all;
  for (const std::string model : {"super_helix", "articulated_chain"}) {
    for (const std::string scene : {"shake", "shake_rotate"}) {
      all.push_back(
          {model + "_" + scene, find_model(model).id, find_strand_scene(scene).settings});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Reduced, Trajectories, testing::ValuesIn(shaken()),
                         [](const auto& tested) { return tested.param.name; });

/// Stiffness matrix of a super-helix: diagonal, length times (GJ, EI1, EI2).
std::vector<double> stiffness(const Strand& strand) {
  std::vector<double> k;
  for (const Segment& s : strand.segments) {
    k.push_back(s.length * strand.material.shear_modulus * s.section.torsion());
    k.push_back(s.length * strand.material.youngs_modulus * s.section.inertia1());
    k.push_back(s.length * strand.material.youngs_modulus * s.section.inertia2());
  }
  return k;
}

// Relative residual |S x - b| / |b| of the weight of a nearly straight strand, with S by
// the inverse dynamics, which are linear in a, instead of by any Jacobian. Without
// rotational inertia S becomes singular in the twists as h -> 0.
TEST(PlainRecursion, LosesDigitsThatTheJosephFormKeeps) {
  const ModelSettings settings = {{"elements", "20"},
                                  {"jacobian", "elastic"},
                                  {"rotary_inertia", "off"},
                                  {"root_tangent", "x"}};
  const Strand made = strand(parameters_of("super_helix", settings));
  const std::vector<double> k = stiffness(made);
  const auto joseph = make_model("super_helix", settings);
  const auto plain =
      make_model("super_helix", with(settings, {{"solver", "recursive_plain"}}));
  const std::vector<double> zero = zeros(*joseph);
  States s(*joseph, 3);
  const std::vector<double> q = s.random(std::vector<double>(s.n, 1.0));  // up to 1/m
  std::vector<double> b = zero;
  ASSERT_EQ(joseph->residual(0, q, zero, zero, b), Status::ok);
  const double load = largest(b);
  const auto relative_residual = [&](System& system, double h) {
    std::vector<double> x = zero, r = zero;
    EXPECT_EQ(system.linearize(0, q, zero, zero, {1, 0, h * h}), Status::ok);
    EXPECT_EQ(system.solve(b, x), Status::ok);
    EXPECT_EQ(joseph->residual(0, q, zero, x, r), Status::ok);
    double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      worst = std::max(worst, std::abs(r[i] - b[i] + h * h * k[i] * x[i] - b[i]));
    }
    return worst / load;
  };
  for (const double h : {1e-3, 1e-4, 1e-5, 1e-6, 0.0}) {
    const double kept = relative_residual(*joseph, h);
    const double lost = relative_residual(*plain, h);
    std::printf("h = %-7g relative residual: Joseph form %.1e, plain %.1e\n", h, kept,
                lost);
    // The Joseph form solves a matrix whose numbers are rounded: eps |S| |x| / |b|, at
    // most eps cond.
    EXPECT_EQ(joseph->linearize(0, q, zero, zero, {1, 0, h * h}), Status::ok);
    EXPECT_LE(kept, eps * scaled_condition(*joseph)) << h;
    if (h > 1e-4) continue;  // stiffness hides the massless twist
    EXPECT_GE(lost, 1e5 * kept) << h;
    if (h == 0) {
      EXPECT_GE(lost, 1) << "some digit is left";
    }
  }
}

// Under elastic_local nothing of a distal segment's stiffness is handed on, so that what
// the root's first unknown meets, 1/x of a load on it alone, holds the step's square
// once, in its own stiffness: it is linear in w.pos. Hair whose stiffness outweighs its
// inertia a thousandfold at the longest step tells that from any other.
TEST(LessImplicit, HandsOnNoStiffnessOfDistalSegments) {
  const auto system = StrandCase{
      "hair",
      find_model("super_helix").id,
      {{"modes", "bend_planar"},
       {"elements", "6"}}}.make({{"jacobian", "elastic_local"}});
  std::vector<double> q = zeros(*system), v = zeros(*system), a = zeros(*system);
  system->initial_state(q, v);
  const auto met = [&](double square) {
    EXPECT_EQ(system->linearize(0, q, v, a, {1, 0, square}), Status::ok);
    std::vector<double> b = zeros(*system), x = zeros(*system);
    b[0] = 1;
    EXPECT_EQ(system->solve(b, x), Status::ok);
    return 1 / x[0];
  };
  const double inertia = met(0), once = met(0.1), twice = met(0.2);
  EXPECT_GT(once, 1000 * inertia);
  EXPECT_NEAR(twice - once, once - inertia, 1e-12 * twice);
}

}  // namespace tress::test_solvers
