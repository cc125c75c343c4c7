// A scene built: what it tells of its energies, and strands that are one system.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <new>
#include <string>

#include "contract/input_error.h"
#include "simulation/run/simulation.h"
#include "simulation/run/world.h"

namespace tress::test_world {

using namespace simulation;

Scene pair(const std::string& model, const std::string& coupling) {
  const std::string strand = "length_m = 0.1\nelements = 10\nshape = \"helix\"\n";
  return parse_scene(
      "title = \"pair\"\nduration_s = 0.1\n[model]\nid = \"" + model +
          "\"\n[integrator]\nid = \"linearly_implicit_euler\"\n[material]\n"
          "name = \"hair.asian\"\n[[strand]]\n" +
          strand + "[[strand]]\nposition_m = [0, 0.004, 0]\n" + strand +
          "[root]\nmotion = \"fixed\"\n[effects.gravity]\n[effects.body]\n"
          "centre_m = [0, 0, -0.005]\n[effects.strand_interaction]\ncoupling = \"" +
          coupling + "\"\n",
      "pair.toml");
}

/// By systems of its own for every strand, without effects and with one alone.
Energies by_twins(const Scene& scene, World& world) {
  Energies sum;
  const Snapshot now = world.snapshot();
  const Effects effects = make_effects(scene);
  sum.effects.resize(effects.size());
  for (std::size_t k = 0; k < scene.strands.size(); ++k) {
    const Snapshot::OfStrand& state = now.strands[k];
    const auto energy = [&](const Effects& with) {
      const auto twin =
          scene.model->on_strand(scene.strands[k], scene.model_options, with);
      twin->recall(state.memory);
      return twin->energetics()->energy(now.t, state.q, state.v);
    };
    const Energy bare = energy({});
    sum.kinetic += bare.kinetic;
    sum.elastic += bare.potential;
    for (std::size_t e = 0; e < effects.size(); ++e) {
      sum.effects[e] += energy({effects[e]}).potential - bare.potential;
    }
  }
  return sum;
}

TEST(World, KnowsEnergiesByKindAsSystemsOfOneEffectDo) {
  for (const char* const model : {"super_helix", "mass_spring", "der"}) {
    const Scene scene = pair(model, "lagged");
    World world(scene);
    ASSERT_EQ(world.advance(0.05), Status::ok) << world.failure();
    const Energies now = world.energies(), expected = by_twins(scene, world);
    // Sums and differences of a few potentials, each of some hundred terms.
    double size = now.kinetic + std::abs(now.elastic);
    for (const double effect : now.effects) size += std::abs(effect);
    const double rounding = 1000 * 2.3e-16 * size;
    EXPECT_NEAR(now.kinetic, expected.kinetic, rounding) << model;
    EXPECT_NEAR(now.elastic, expected.elastic, rounding) << model;
    for (std::size_t e = 0; e < now.effects.size(); ++e) {
      EXPECT_NEAR(now.effects[e], expected.effects[e], rounding) << model << e;
    }
  }
}

/// One strand of every model whose root stops and which is tethered later.
Scene switched(const std::string& model) {
  return parse_scene(
      "title = \"switched\"\nduration_s = 0.5\n[model]\nid = \"" + model +
          "\"\n[integrator]\nid = \"tr_bdf2\"\nposition_tol_rel = 1e-3\n[material]\n"
          "name = \"hair.asian\"\n[strand]\nelements = 6\n[root]\nmotion = \"stop\"\n"
          "speed_m_s = 0.5\ntime_s = 0.125\n[effects.gravity]\n[effects.tether]\n"
          "stiffness_n_m = 1e-3\nt_on_s = 0.25\nramp_s = 0.125\n",
      "switched.toml");
}

TEST(World, SystemsOfEveryStrandModelNameTheirBreakpoints) {
  int strands = 0;
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand == nullptr) continue;
    Scene scene = switched("super_helix");
    scene.model = &model;
    const auto system =
        model.on_strand(scene.strands.front(), Parameters(model.parameters, "model"),
                        make_effects(scene));
    ++strands;
    double t = 0;
    for (const double next : {0.125, 0.25, 0.375}) {
      EXPECT_EQ(system->next_breakpoint(t), next) << model.id;
      t = next;
    }
  }
  EXPECT_GE(strands, 7);
}

TEST(World, RunsByToleranceAndGoesOnFromASnapshotBitForBit) {
  const Scene scene = switched("super_helix");
  EXPECT_EQ(scene.options.tolerance, 1e-3);
  World world(scene), other(scene);
  ASSERT_EQ(world.advance(0.2), Status::ok) << world.failure();
  const Snapshot middle = world.snapshot();
  World through(scene);
  through.restore(middle);
  other.restore(middle);
  for (World* const one : {&through, &other}) {
    ASSERT_EQ(one->advance(0.3), Status::ok) << one->failure();
    ASSERT_EQ(one->advance(0.5), Status::ok) << one->failure();
  }
  EXPECT_EQ(through.positions(), other.positions());
  const Stats done = through.stats();
  EXPECT_GT(done.smallest_step, 0);
  EXPECT_EQ(done.rejected, done.rejected_by_error + done.rejected_by_newton);
  // A step of 1 ms would take 300.
  EXPECT_LT(done.steps, 300);
}

/// Its system remembers more than its strands do: a snapshot that kept only their part
/// was read beyond its end.
TEST(World, StrandsThatAreOneSystemGoOnFromASnapshot) {
  const Scene scene = pair("mass_spring", "monolithic");
  World world(scene), other(scene);
  ASSERT_EQ(world.advance(0.02), Status::ok) << world.failure();
  const Snapshot middle = world.snapshot();
  world.restore(middle);
  other.restore(middle);
  ASSERT_EQ(world.advance(0.04), Status::ok) << world.failure();
  ASSERT_EQ(other.advance(0.04), Status::ok) << other.failure();
  EXPECT_EQ(world.positions(), other.positions());
}

/// As one system they were drawn as one line.
TEST(World, StrandsAreAttachedAlikeWhateverTheirCoupling) {
  const World apart(pair("mass_spring", "lagged")),
      one(pair("mass_spring", "monolithic"));
  EXPECT_EQ(apart.points(), one.points());
  EXPECT_EQ(apart.before(), one.before());
}

/// At 50 ms the whirling of soft, long hair takes Newton's iteration more than one round,
/// and more than a few damped ones, now and then.
TEST(World, StepsWithoutASolutionAreTakenInShorterOnes) {
  const std::string strand = "length_m = 0.2\nelements = 20\n";
  const Scene scene = parse_scene(
      "title = \"soft\"\n[model]\nid = \"super_helix\"\n[integrator]\n"
      "id = \"backward_euler\"\ndt_s = 0.05\nnewton_iterations = 1\n[material]\n"
      "name = \"hair.asian\"\nyoungs_modulus_pa = 1e7\n[[strand]]\n" +
          strand + "[[strand]]\n" + strand +
          "[root]\nmotion = \"shake\"\namplitude_m = 0.05\nfrequency_hz = 3\n"
          "[effects.gravity]\n",
      "soft.toml");
  World world(scene), other(scene, 2);
  ASSERT_EQ(world.advance(0.5), Status::ok) << world.failure();
  ASSERT_EQ(other.advance(0.5), Status::ok) << other.failure();
  EXPECT_GT(world.stats().rejected, 0);
  EXPECT_EQ(world.stats().rejected, other.stats().rejected);
  EXPECT_EQ(world.positions(), other.positions());
}

/// Turned from one moment to the next, these springs by their filtered Jacobian have no
/// step that Newton's iteration solves, however short.
constexpr const char* hinges = R"(title = "hinges"
[model]
id = "mass_spring"
bending = "angular"
jacobian = "filtered"
[integrator]
id = "generalized_alpha"
dt_s = 3e-4
[material]
name = "hair.african"
radius_m = 2e-5
youngs_modulus_pa = 2e7
[[strand]]
root_tangent = [0.1, 0.1, 0.5]
length_m = 0.015
elements = 9
[root]
motion = "rotate"
frequency_hz = 17
angle_rad = 0.4
centre_m = [-0.05, 0, 0]
)";

TEST(World, AStepThatShorterOnesDoNotHelpEndsTheRun) {
  const Scene scene = parse_scene(hinges, "hinges.toml");
  World world(scene);
  ASSERT_NE(world.advance(0.01), Status::ok);
  EXPECT_THAT(world.failure(), testing::HasSubstr("nor for 64 in its place"));
  EXPECT_EQ(world.stats().rejected, 6);
}

/// Without a bound the six attempts at this step take more work than the steps before.
TEST(World, MaxWorkBoundsStepsThatAreTriedAgain) {
  Scene scene = parse_scene(hinges, "hinges.toml");
  World free(scene);
  ASSERT_NE(free.advance(0.01), Status::ok);
  scene.options.max_work = 1.05 * free.work();
  World world(scene);
  ASSERT_NE(world.advance(0.01), Status::ok);
  EXPECT_THAT(world.failure(), testing::HasSubstr("max_work used up by shorter steps"));
  EXPECT_THAT(world.failure(), testing::HasSubstr("try more than max_work"));
  EXPECT_LT(world.stats().rejected, 6);
}

#ifndef __SANITIZE_ADDRESS__  // it has an allocator and an address space of its own
/// As under `ulimit -v`: these strands need more than a gigabyte.
TEST(World, TooManyStrandsForTheMemoryAreRefusedWithTheFigure) {
  const Scene scene = parse_scene(
      "title = \"crowd\"\n[model]\nid = \"super_helix\"\n[integrator]\n"
      "id = \"linearly_implicit_euler\"\n[groom]\ncount = 5000\nelements = 20\n"
      "length_m = 0.2\n[root]\nmotion = \"fixed\"\n[effects.linear_drag]\n",
      "crowd.toml");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  double pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const auto now =
      static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
  const rlimit tight{now + (rlim_t{300} << 20), before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_AS, &tight), 0);
  std::string message;
  try {
    const World world(scene);
  } catch (const InputError& error) {
    message = error.what();
  } catch (const std::bad_alloc&) {
    message = "no memory";
  }
  setrlimit(RLIMIT_AS, &before);
  EXPECT_THAT(message, testing::HasSubstr("5000 strands of 100000 elements altogether "
                                          "need about "));
  EXPECT_THAT(message, testing::HasSubstr("give fewer strands or elements"));
}
#endif

}  // namespace tress::test_world
