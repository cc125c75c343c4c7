// What physics rules out ends a run with a reason; what it allows goes on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulation/run/remedy.h"
#include "simulation/run/world.h"
#include "tests/support/refusal.h"

namespace tress::test_guard {

using namespace simulation;
using testing_support::refusal;

struct Said {
  std::string model, integrator, dt, more, root = "motion = \"fixed\"\n",
                                           effects = "[effects.gravity]\n";
  std::string top = {};
};

/// Adaptive methods take no `dt`, but the lines behind it.
Scene scene(const Said& said) {
  const bool adaptive = integrators::find_integrator(said.integrator).adaptive;
  return parse_scene("title = \"guarded\"\nduration_s = 0.3\n" + said.top +
                         "[model]\nid = \"" + said.model + "\"\n[integrator]\nid = \"" +
                         said.integrator + (adaptive ? "\"\n# " : "\"\ndt_s = ") +
                         said.dt + "\n[material]\nname = \"hair.asian\"\n[strand]\n" +
                         said.more + "[root]\n" + said.root + said.effects,
                     "guarded.toml");
}

/// Why it ended before its time; empty: it did not.
std::string ending(const Scene& scene) {
  World world(scene);
  for (std::size_t f = 1; f <= scene.last_frame(); ++f) {
    if (world.advance(scene.time_of(f)) != Status::ok) return world.failure();
  }
  return {};
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Tip of a strand of 0.1 m at a time.
Vec tip_at(double t, const std::string& integrator, const std::string& strand,
           const std::string& root, const std::string& drag) {
  World world(parse_scene(
      "title = \"tip\"\nduration_s = 1\n[model]\nid = "
      "\"super_helix\"\n[integrator]\n" +
          integrator +
          "[material]\nname = \"hair.caucasian\"\n"
          "internal_friction_kg_m3_s = 1e-11\n[strand]\nlength_m = "
          "0.1\n" +
          strand + "[root]\n" + root +
          "[effects.gravity]\n[effects.linear_drag]\ndrag_kg_m_s = " + drag + "\n",
      "tip.toml"));
  EXPECT_EQ(world.advance(t), Status::ok) << world.failure();
  return load3(&world.positions()[world.positions().size() - 3]);
}

/// The root moves by the length within six steps of 33 ms. Its power in the middle of a
/// step is far above that at both ends: guarded steps took its work for a gain of energy.
TEST(Guarded, WorkInTheMiddleOfAStepIsNoGain) {
  const auto tip = [](const std::string& id) {
    return tip_at(0.5, "id = \"" + id + "\"\ndt_s = 0.033333333333333333\n",
                  "elements = 6\nroot_tangent = [0, 0, -1]\n",
                  "motion = \"translate\"\ndistance_m = 0.1\ntime_s = 0.2\n", "2e-4");
  };
  EXPECT_EQ(norm(tip("guarded") - tip("tr_bdf2")), 0);
  EXPECT_EQ(norm(tip("guarded_esdirk43") - tip("esdirk43")), 0);
}

/// The mass of twist of a bent strand changes much within a step, so that a Rosenbrock
/// method and its comparison solution are wrong alike, by 12 % of the length here. The
/// defect of the equations at the end of a step shows it.
TEST(Rodas5p, KeepsToItsToleranceWhereTheMassChanges) {
  const auto tip = [](const std::string& id, const std::string& tolerance) {
    return tip_at(0.3, "id = \"" + id + "\"\nposition_tol_rel = " + tolerance + "\n",
                  "elements = 8\nposition_m = [0.1, 0, 0]\n",
                  "motion = \"rotate\"\nfrequency_hz = 2\nangle_rad = 0.8\n", "2e-5");
  };
  EXPECT_LE(norm(tip("rodas5p", "1e-2") - tip("esdirk43", "1e-5")), 1e-2 * 0.1);
}

TEST(Rodas5p, RefusesAnApproximateJacobian) {
  const std::string text =
      "title = \"rosenbrock\"\nduration_s = 1\n[model]\nid = \"super_helix\"\njacobian "
      "= \"elastic\"\n[integrator]\nid = \"rodas5p\"\ndt_s = 1e-3\n[material]\nname = "
      "\"hair.asian\"\n[strand]\nelements = 4\n";
  EXPECT_EQ(
      refusal([&] { parse_scene(text, "r.toml"); }),
      "rodas5p with jacobian = \"elastic\": an approximate Jacobian lowers its order "
      "or makes it unstable (r.toml:4:6): give [model] jacobian = \"exact\"");
}

/// Ten Gauss-Seidel sweeps of 20 stiff springs a step of 4.4 ms do not hold them: energy
/// of 1e4 m g L, and simulate called it ok.
const Said gaining{"mass_spring", "xpbd", "0.0044", "elements = 20\n"};

TEST(Guard, EndsAPassiveSceneThatGainsEnergy) {
  const std::string why = ending(scene(gaining));
  EXPECT_TRUE(says(why, "more energy than at the start")) << why;
  EXPECT_TRUE(says(why, "at t = 0.0")) << why;
  EXPECT_TRUE(says(why, "strand 0, point ")) << why;
  EXPECT_TRUE(says(why, "try more sweeps, or backward_euler")) << why;
}

TEST(Guard, AdvisesMoreWorkWhereThatIsUsedUp) {
  Options options;
  options.max_work = 5e4;
  EXPECT_EQ(remedy("implicit_midpoint", options, Limit::work),
            "try more than max_work = 50000");
}

TEST(Guard, NamesEsdirk43WhereTheStagesOfRadau5HaveNoSolution) {
  const std::string words = remedy("radau5", Options{});
  EXPECT_TRUE(says(words, "try a shorter step than 0.001 s, or esdirk43")) << words;
}

/// SUNDIALS refuses weights of 0, and finds no solution on index 3 at a small rtol.
TEST(Guard, AdvisesTolerancesThatAMethodCanMeet) {
  Options options;
  EXPECT_EQ(remedy("ida", options), "try a smaller tolerance than rtol = 1e-06");
  options.formulation = Formulation::index2_ggl;
  EXPECT_EQ(remedy("ida", options), "try a larger tolerance than rtol = 1e-06");
  options.formulation = Formulation::index3;
  const std::string index3 = remedy("ida", options);
  EXPECT_TRUE(says(index3, "try a larger tolerance than rtol = 1e-06")) << index3;
  EXPECT_TRUE(says(index3, "formulation = \"index2_ggl\"")) << index3;
  options.atol = 0;
  EXPECT_TRUE(says(remedy("ida", options), "try atol > 0"));
}

/// What ends after a number of sweeps gains energy at shorter steps as well, and
/// oscillations of force_transport grow at any step (docs/theory/models).
TEST(Guard, NamesNoStepThatIsNotKnownToHelp) {
  Options options;
  options.step = 2e-3;
  for (const char* method :
       {"xpbd", "xpbd_bdf2", "vbd", "vbd_augmented", "stable_cosserat_rods"}) {
    const std::string words = remedy(method, options);
    EXPECT_TRUE(says(words, "more sweeps")) << words;
    EXPECT_FALSE(says(words, "try a shorter step")) << words;
  }
  for (const char* method : {"backward_euler", "rk4"}) {
    const std::string grows = remedy(method, options, Limit::none, "force_transport");
    EXPECT_TRUE(says(grows, "which damp")) << grows;
    EXPECT_FALSE(says(grows, "try a shorter step")) << grows;
    EXPECT_TRUE(says(remedy(method, options), "try a shorter step than 0.002 s"));
  }
}

/// Below some rtol, multipliers of index 3 and 2 meet no tolerance of a variable step.
TEST(Guard, AdvisesLargerTolerancesWhereNoSmallerOneHelps) {
  Options options;
  options.rtol = 1e-6;
  EXPECT_TRUE(says(remedy("ida", options), "try a smaller tolerance than rtol = 1e-06"));
  options.formulation = Formulation::index3;
  EXPECT_TRUE(says(remedy("ida", options), "try a larger tolerance than rtol = 1e-06"));
  EXPECT_TRUE(says(remedy("ida", options), "index2_ggl"));
  options.formulation = Formulation::index2_ggl;
  EXPECT_TRUE(says(remedy("ida", options), "try a larger tolerance than rtol = 1e-06"));
  options.atol = 0;
  EXPECT_TRUE(says(remedy("ida", options), "try atol > 0"));
}

/// Axes 0.5 mm apart of strands 20 mm thick: no step resolves their contact.
TEST(Guard, NamesAnOverlapAtTheStart) {
  const auto strand = [](const std::string& place, const std::string& along) {
    return "[[strand]]\nlength_m = 0.08\nelements = 16\nposition_m = " + place +
           "\nroot_tangent = " + along + "\nnormal = [0, 0, 1]\n";
  };
  const std::string why = ending(parse_scene(
      "title = \"overlap\"\nduration_s = 0.1\n[integrator]\nid = \"backward_euler\"\n"
      "dt_s = 0.002\n" +
          strand("[0, 0, 0]", "[1, 0, 0]") +
          strand("[0.03, -0.04, -0.0005]", "[0, 1, 0]") +
          strand("[0.05, -0.04, -0.012]", "[0, 1, 0]") +
          "[root]\n[effects.gravity]\n[effects.linear_drag]\n"
          "[effects.strand_friction]\nfriction = 0.4\nthickness_m = 0.02\n",
      "overlap.toml"));
  EXPECT_TRUE(says(why, "strands 0 and 1 overlap by 0.0195 m at t = 0")) << why;
  EXPECT_FALSE(says(why, "try a shorter step")) << why;
}

/// Without weight, from rest: a thin body at 1.9 m/s strikes a strand, whose energy comes
/// from it alone. Steps of 0.05 ms sample its power too seldom for a tenth of the work.
TEST(Guard, LetsAMovingBodyStrikeAWeightlessStrand) {
  const std::string struck =
      "title = \"struck\"\nduration_s = 0.056\n[model]\nid = \"super_helix\"\n"
      "[integrator]\nid = \"backward_euler\"\ndt_s = 5e-5\n[material]\n"
      "internal_friction_kg_m3_s = 1e-11\n[strand]\nlength_m = 0.1\nelements = 10\n"
      "[root]\n[effects.linear_drag]\ndrag_kg_m_s = 1e-6\n[effects.body]\n"
      "shape = \"ellipsoid\"\nstiffness_n_m2 = 100\nhalf_axes_m = [0.02, 0.05, 3e-4]\n"
      "centre_m = [0.06, 0, -0.052]\nmoves = \"keyframes\"\n"
      "keyframes = [[0, 0, 0, 0, 0], [0.1, 0, 0, 0.1, 0]]\n";
  EXPECT_EQ(ending(parse_scene(struck, "struck.toml")), "");
}

/// A rigid plane rises under a free strand without weight, and stops: all energy is that
/// of impulses.
TEST(Guard, LetsARigidPlaneThrowAStrand) {
  for (const char* method : {"backward_euler", "bdf2", "tr_bdf2", "esdirk43"}) {
    const std::string thrown =
        std::string(
            "title = \"thrown\"\nduration_s = 0.1\n[model]\nid = "
            "\"super_helix\"\n[integrator]\nid = \"") +
        method +
        "\"\ndt_s = 2e-3\n[strand]\nlength_m = 0.08\nelements = 8\nposition_m = [0, 0, "
        "0.002]\nroot_tangent = [0, 1, 0]\nnormal = [0, 0, 1]\n[root]\nmotion = "
        "\"free\"\n[effects.body]\nshape = \"plane\"\nfriction_law = \"exact\"\n"
        "normal = \"rigid\"\nmoves = \"keyframes\"\nkeyframes = [[0, 0, 0, 0, 0], "
        "[0.06, 0, 0, 0.03, 0]]\n";
    EXPECT_EQ(ending(parse_scene(thrown, "thrown.toml")), "") << method;
  }
}

/// A hair swings through a rod of 2 mm while no frame is near it, and its points pass
/// before and behind it.
TEST(World, TakesTheDepthInBodiesAtAllSteps) {
  const Scene thin = parse_scene(
      "title = \"thin\"\nduration_s = 0.5\nframes_per_s = 10\n[integrator]\n"
      "id = \"backward_euler\"\ndt_s = 0.002\n[strand]\nlength_m = 0.1\nelements = 12\n"
      "root_tangent = [0, 0, -1]\n[root]\nmotion = \"shake\"\namplitude_m = 0.05\n"
      "frequency_hz = 2\ndirection = [1, 0, 0]\n[effects.gravity]\n"
      "[effects.linear_drag]\ndrag_kg_m_s = 3e-5\n[effects.body]\nshape = \"capsule\"\n"
      "radius_m = 0.001\nlength_m = 0.1\ncentre_m = [0.02, 0, -0.06]\n"
      "rotation_rad = [1.5708, 0, 0]\n",
      "thin.toml");
  World world(thin);
  double deepest = 0;
  for (std::size_t f = 1; f <= thin.last_frame(); ++f) {
    ASSERT_EQ(world.advance(thin.time_of(f)), Status::ok) << world.failure();
    deepest = std::max(deepest, world.take_depth());
    EXPECT_EQ(world.take_depth(), 0);
  }
  EXPECT_GT(deepest, 1e-4);
  EXPECT_LT(deepest, 1.04e-3);  // radii of rod and hair
}

TEST(Guard, AdvisesAgainstTooManySteps) {
  const std::string tight = "1e-3\nmax_steps = 5";
  const std::string adaptive = ending(scene({"der", "gsl_rkf45", tight, ""}));
  EXPECT_TRUE(says(adaptive, "max_steps steps needed at t = ")) << adaptive;
  EXPECT_TRUE(says(adaptive, "try a larger tolerance than rtol = 1e-06")) << adaptive;
  EXPECT_TRUE(says(adaptive, "or more than max_steps = 5")) << adaptive;
  const std::string fixed = ending(scene({"der", "backward_euler", tight, ""}));
  EXPECT_TRUE(says(fixed, "try a longer step than 0.001 s")) << fixed;
}

/// Frames are 20 ms apart: 20 steps, or exchanges of strands that touch.
TEST(Guard, CountsStepsFromFrameToFrame) {
  const std::string touch = "[effects.gravity]\n[effects.strand_interaction]\n";
  for (const std::string& effects : {std::string("[effects.gravity]\n"), touch}) {
    const auto ends = [&](const std::string& most) {
      return ending(scene({"super_helix", "backward_euler", "1e-3\nmax_steps = " + most,
                           "", "motion = \"fixed\"\n", effects}));
    };
    EXPECT_EQ(ends("20"), "") << effects;
    EXPECT_TRUE(says(ends("19"), "more than max_steps")) << effects << ends("19");
  }
}

TEST(Guard, KnowsByTheRunThatItsWorkIsUsedUp) {
  const std::string bounded = "1e-3\nmax_work = 100";
  for (const char* method : {"gsl_rkf45", "backward_euler", "cvode_bdf"}) {
    const std::string why = ending(scene({"der", method, bounded, ""}));
    EXPECT_TRUE(says(why, "try more than max_work = 100")) << why;
  }
}

// Every counter that total_work() adds up, over strands.
TEST(WorldWork, IsThatOfAllCounters) {
  World world(scene({"der", "backward_euler", "1e-3", ""}));
  ASSERT_EQ(world.advance(0.01), Status::ok);
  const Stats done = world.stats();
  EXPECT_GT(done.residuals, 0);
  EXPECT_GT(done.linearizations, 0);
  EXPECT_GT(done.solves, 0);
  const auto n = static_cast<int>(world.snapshot().strands.front().q.size());
  EXPECT_EQ(world.work(), total_work(done, n));
}

TEST(Guard, IsSwitchedOffByTheScene) {
  Said watched = gaining;
  watched.top = "guard = false\n";
  EXPECT_EQ(ending(scene(watched)), "");
}

TEST(Guard, EndsAStrandThatIsStretchedApart) {
  // A tether that pulls 0.1 N at hair as soft as 1 kPa (EA = 5e-6 N): an honest
  // equilibrium of equations that hold for small strains only.
  const Said torn{"der",
                  "backward_euler",
                  "0.001",
                  "elements = 5\n[strand.material]\nname = \"hair.asian\"\n"
                  "youngs_modulus_pa = 1e3\n",
                  "motion = \"fixed\"\n",
                  "[effects.gravity]\n[effects.tether]\npull_n = 0.1\n"
                  "target_m = [1, 0, 0]\n"};
  const std::string why = ending(scene(torn));
  EXPECT_TRUE(says(why, "a segment is off its length by")) << why;
  EXPECT_TRUE(says(why, "strand 0, element 4")) << why;  // the one that is pulled
}

class GuardTest : public testing::Test {
 protected:
  void make(const Said& said) {
    Scene read = scene(said);
    system_ = read.model->on_strand(read.strands.front(), read.model_options,
                                    make_effects(read));
    guard_.emplace(*system_,
                   std::vector{guarded_strand(read.strands.front(), make_effects(read))});
    state_ = initial_state(*system_);
    guard_->start(0, state_.q, state_.v);
  }
  std::unique_ptr<System> system_;
  std::optional<Guard> guard_;
  State state_;
};

TEST_F(GuardTest, FindsWhatIsNoNumber) {
  make(gaining);
  EXPECT_TRUE(guard_->judge(0.001, state_.q, state_.v));
  state_.v[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(guard_->judge(0.002, state_.q, state_.v));
  EXPECT_EQ(guard_->breach()->kind, Breach::Kind::not_finite);
}

/// The tip of 40 elements has an 80th of the mass: at 15 m/s 1.4 m g L, which a hair
/// released upright may have, but not all of it in so small a part of itself.
TEST_F(GuardTest, FindsAPointThatIsTooFast) {
  make({"mass_spring", "xpbd", "0.001", "elements = 40\nroot_tangent = [0, 0, 1]\n"});
  const double energy = 9.81 * 0.1;  // J/kg, m g L
  // 0.99 of the energy that may come to be, while the tip of a whip has a third of that.
  state_.v.back() = std::sqrt(0.99 * energy * 2 * 80);
  EXPECT_FALSE(guard_->judge(0.001, state_.q, state_.v));
  EXPECT_EQ(guard_->breach()->kind, Breach::Kind::speed);
  EXPECT_EQ(guard_->breach()->where, "strand 0, point 40");
}

/// Two strands as one system. One of them has 1.5 times the energy that it could gain by
/// hanging down, which is less than both could.
TEST(Guards, KnowTheEnergyOfEachStrandOfASystem) {
  const Scene read =
      scene({"super_helix\"\njacobian = \"elastic", "linearly_implicit_euler", "0.001",
             "elements = 4\n", "motion = \"fixed\"\n", "[effects.gravity]\n"});
  const std::vector<StrandToMake> two(2, StrandToMake{read.strands.front()});
  std::optional<SteppedSystem> made = StrandMaker(read).together(two, 3);
  ASSERT_TRUE(made && made->guard);
  const GuardedStrand one = guarded_strand(read.strands.front(), make_effects(read));
  Guard whole(*made->system, {one, one});
  auto [q, v] = initial_state(*made->system);
  whole.start(0, q, v);
  made->guard->start(0, q, v);
  const std::size_t n = q.size() / 2;
  std::fill(v.begin() + static_cast<std::ptrdiff_t>(n), v.end(), 1.0);
  const double kinetic = made->system->energetics()->energy(0, q, v).kinetic;
  for (double& rate : v) rate *= std::sqrt(1.5 * one.slack() / kinetic);
  EXPECT_TRUE(whole.judge(0.001, q, v));
  EXPECT_FALSE(made->guard->judge(0.001, q, v));
  EXPECT_EQ(made->guard->breach()->kind, Breach::Kind::energy);
  EXPECT_TRUE(says(made->guard->breach()->where, "strand 4"));
}

TEST(Guards, RememberWhatEachHasGathered) {
  const Scene read = scene({"super_helix\"\njacobian = \"elastic",
                            "linearly_implicit_euler", "0.001", "elements = 4\n"});
  const std::vector<StrandToMake> two(2, StrandToMake{read.strands.front()});
  std::optional<SteppedSystem> made = StrandMaker(read).together(two, 0);
  ASSERT_TRUE(made && made->guard);
  Guards& guards = *made->guard;
  const auto [q, v] = initial_state(*made->system);
  guards.start(0, q, v);
  EXPECT_TRUE(guards.judge(0.001, q, v));
  const Guards::Memory memory = guards.memory();
  EXPECT_EQ(memory.size(), guards.remembered());
  guards.start(0.5, q, v);
  EXPECT_NE(guards.memory(), memory);
  guards.recall(memory, 0.001, q);
  EXPECT_EQ(guards.memory(), memory);
}

// Six links that begin at rest without weight, in wind on a root that moves: all of their
// energy is work of effects, at steps of 1.7 ms as at those of a hundredth.
TEST(Guard, AllowsWhatWorkGivesHoweverShortTheSteps) {
  for (const char* step : {"0.0017", "0.00017"}) {
    const Said windy{"articulated_chain",
                     "linearly_implicit_euler",
                     step,
                     "elements = 6\nlength_m = 0.077\n[strand.material]\n"
                     "name = \"custom\"\nradius_m = 7.4e-5\nyoungs_modulus_pa = 8.9e6\n"
                     "poisson_ratio = 0\ndensity_kg_m3 = 100\n",
                     "motion = \"translate\"\n",
                     "[effects.linear_drag]\ndrag_kg_m_s = 1.4e-6\n[effects.wind]\n"
                     "velocity_m_s = [22.6, 0, 1]\nprofile = \"sine\"\n"
                     "law = \"quadratic\"\n"};
    EXPECT_EQ(ending(scene(windy)), "");
  }
}

TEST(EnergyAccount, AllowsATenthMoreThanItsWork) {
  EnergyAccount account;
  account.start(0, {}, 2);
  account.gather(1, {.power = 3});  // W: the larger of both ends
  account.gather(2, {.power = -5});
  EXPECT_DOUBLE_EQ(account.allowed(), 2 + 1.1 * 6);
  account.gather(3, {.kinetic = 8, .driven = 0.5});
  EXPECT_DOUBLE_EQ(account.allowed(), 2 + 1.1 * 6 + 0.5);
  EXPECT_DOUBLE_EQ(account.gain({.kinetic = 8, .potential = 1}), 9);
  EnergyAccount other;
  other.recall(account.memory());
  EXPECT_EQ(other.memory(), account.memory());
}

TEST_F(GuardTest, RemembersWhatItGathered) {
  make(gaining);
  EXPECT_TRUE(guard_->judge(0.001, state_.q, state_.v));
  const auto memory = guard_->memory();
  guard_->start(0.5, state_.q, state_.v);
  guard_->recall(memory, 0.001, state_.q);
  EXPECT_EQ(guard_->memory(), memory);
}

// ---- honest scenes ----------------------------------------------------------------

const std::string shaken = "motion = \"shake\"\namplitude_m = 0.05\nfrequency_hz = 3\n";
const std::string turned =
    "motion = \"shake_rotate\"\namplitude_m = 0.02\nfrequency_hz = 4\nangle_rad = 1\n"
    "centre_m = [-0.1, 0, 0]\n";
const std::string curled = "elements = 10\nshape = \"helix\"\n";
const std::string windy =
    "[effects.gravity]\n[effects.wind]\nvelocity_m_s = [3, 1, 0]\nlaw = \"quadratic\"\n";

TEST(Guard, LeavesHonestScenesAlone) {
  const Said honest[] = {
      {"super_helix", "linearly_implicit_euler", "0.001", curled},
      {"super_helix", "backward_euler", "0.02", curled, turned},
      {"super_helix", "implicit_midpoint", "0.001",
       curled + "initial = \"straight\"\n"},  // prestressed
      {"super_helix", "linearly_implicit_euler", "0.001", curled, turned, windy},
      {"super_helix", "implicit_midpoint", "0.001", curled, "motion = \"fixed\"\n", ""},
      {"super_helix", "generalized_alpha", "0.002", curled,
       "motion = \"free\"\nspin_rad_s = [5, 10, 0]\n", ""},
      {"der", "linearly_implicit_euler", "0.001", curled, shaken},
      {"der", "backward_euler", "0.001", "elements = 10\n", turned, windy},
      {"corde", "backward_euler", "0.001", "elements = 10\n", turned},
      {"mass_spring", "backward_euler", "0.005", "elements = 20\n", shaken},
      {"articulated_chain", "bdf2", "0.001", curled,
       "motion = \"drop_pull\"\namplitude_m = 0.05\nfrequency_hz = 5\n"},
      {"kirchhoff_nodal", "linearly_implicit_euler", "0.0002", "elements = 10\n",
       "motion = \"stop\"\nspeed_m_s = 2\ntime_s = 0.01\n"},
      {"super_helix", "linearly_implicit_euler", "0.0005", "elements = 10\n", shaken,
       "[effects.gravity]\n[effects.body]\nshape = \"sphere\"\n"
       "centre_m = [0.05, 0, -0.06]\nradius_m = 0.05\n"},
      {"super_helix", "backward_euler", "0.002", "elements = 10\n", turned,
       "[effects.gravity]\n[effects.tether]\nstiffness_n_m = 0.01\n"
       "target_m = [0, 0.1, 0]\namplitude_m = [0.1, 0, 0]\nfrequency_hz = 2\n"},
  };
  for (const Said& said : honest) {
    EXPECT_EQ(ending(scene(said)), "") << said.model << " by " << said.integrator;
  }
}

}  // namespace tress::test_guard
