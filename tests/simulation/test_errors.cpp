#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "integrators/idle_option.h"
#include "simulation/scene/scene.h"
#include "tests/harness/toy_process.h"

namespace tress::test_errors {

using namespace simulation;

using testing::HasSubstr;

std::string refusal_of(const std::string& text) {
  try {
    parse_scene(text, "s.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

struct Wrong {
  std::string name, scene, place, says;
};
void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }

class WrongSceneTest : public testing::TestWithParam<Wrong> {};

TEST_P(WrongSceneTest, IsRefusedWithPlaceAndRemedy) {
  const std::string message = refusal_of("title = \"t\"\n" + GetParam().scene);
  EXPECT_THAT(message, HasSubstr("(s.toml:" + GetParam().place + "): "));
  EXPECT_THAT(message, HasSubstr(GetParam().says));
}

const std::string strand = "[strand]\n";

std::string times(int n, const std::string& text) {
  std::string all;
  for (int i = 0; i < n; ++i) all += text;
  return all;
}

const Wrong wrong_scenes[] = {
    {"DeepKey", times(31'000, "a.") + "a = 1\n", "2:202", "nest less deeply"},
    {"DeepHeader", "[" + times(31'000, "a.") + "a]\n", "2:203", "nest less deeply"},
    {"DeepList", "a = " + times(31'000, "["), "2:105", "nest less deeply"},
    {"DeepTable", "a = " + times(31'000, "{a="), "2:305", "nest less deeply"},
    {"DeepTogether", "a = " + times(40, "{a.a.a=["), "2:205", "nest less deeply"},
    {"DeepAfterString", "a = [\"\"\"b\"\"\"\"\", {" + times(31'000, "a.") + "a = 1}]\n",
     "2:215", "nest less deeply"},
    {"DistancesOfADevice",
     strand + "[[effects.body]]\nshape = \"sdf\"\nsdf_file = \"/dev/zero\"\n", "3:1",
     "readable file"},
    {"MalformedToml", "[strand\n", "2:8", "correct the TOML"},
    {"KeyTwice", "[strand]\nelements = 1\nelements = 2\n", "4:12", "correct the TOML"},
    {"UnknownTable", "[strnd]\n", "2:2", "did you mean 'strand'?"},
    {"UnknownKey", "[strand]\nlenth_m = 1\n", "3:1", "did you mean 'length_m'?"},
    {"RenamedTangent", "[strand]\ntangent = [1, 0, 0]\n", "3:1",
     "it is called 'root_tangent' now"},
    {"RenamedDrag", strand + "[effects.linear_drag]\nnu_kg_m_s = 1e-5\n", "4:1",
     "it is called 'drag_kg_m_s' now"},
    {"RenamedWindDrag", strand + "[effects.wind]\nnu_kg_m_s = 1e-5\n", "4:1",
     "it is called 'drag_kg_m_s' now"},
    {"RenamedFrequency", strand + "[[effects.tether]]\nfrequency_1_s = 1\n", "4:1",
     "it is called 'frequency_hz' now"},
    {"RenamedGravity", strand + "[effects.gravity]\nacceleration_m_s2 = [0, 0, -1]\n",
     "4:1", "it is called 'gravity_m_s2' now"},
    {"RenamedMotion", "[model]\nid = \"super_helix_tree\"\nroot = \"shake\"\n", "4:1",
     "it is called 'motion' now"},
    {"RenamedOption", "[model]\nid = \"double_pendulum\"\ngravity = 1\n", "4:1",
     "it is called 'gravity_m_s2' now"},
    {"FarKey", "[strand]\nxyzzyplugh = 1\n", "3:1", "use one of: material, position_m"},
    {"UnknownEffect", strand + "[effects.grvity]\n", "3:10", "did you mean 'gravity'?"},
    {"UnknownInteraction", strand + "[effects.strand_interacton]\n", "3:10",
     "did you mean 'strand_interaction'?"},
    {"UnknownModel", strand + "[model]\nid = \"super_helx\"\n", "4:6",
     "did you mean 'super_helix'?"},
    {"UnknownIntegrator", strand + "[integrator]\nid = \"rk5\"\n", "4:6",
     "did you mean 'rk4'?"},
    {"StepAndTolerance",
     strand + "[integrator]\nid = \"tr_bdf2\"\nposition_tol_rel = 1e-3\ndt_s = 1e-3\n",
     "6:8", "dt_s is not for a run with position_tol_rel, which decides it"},
    {"NewtonAndTolerance",
     strand + "[integrator]\nid = \"tr_bdf2\"\nposition_tol_rel = 1e-3\n"
              "newton_tolerance = 1e-3\n",
     "6:20", "newton_tolerance is not for"},
    {"RtolAndTolerance",
     strand + "[integrator]\nid = \"ida\"\nposition_tol_rel = 1e-3\nrtol = 1e-3\n", "6:8",
     "rtol is not for"},
    {"ToleranceOfAFixedStep",
     strand + "[integrator]\nid = \"newmark\"\nposition_tol_rel = 1e-3\n", "5:20",
     "newmark, which has a fixed step"},
    {"LeastStepWithoutTolerance",
     strand + "[integrator]\nid = \"tr_bdf2\"\nmin_step_s = 1e-6\n", "5:14",
     "has no effect without tolerance"},
    {"ToleranceOfStrandsThatTouch",
     strand + "[integrator]\nid = \"ida\"\nposition_tol_rel = 1e-3\n"
              "[effects.strand_interaction]\n",
     "5:20", "ida cannot repeat an interval between exchanges"},
    {"LeastStepAboveTheLargest",
     strand +
         "[integrator]\nid = \"tr_bdf2\"\nposition_tol_rel = 1e-3\nmin_step_s = 1e-2\n"
         "max_step_s = 1e-3\n",
     "6:14", "give a smaller min_step_s, or a larger max_step_s"},
    {"ToleranceBelowRounding",
     strand + "[integrator]\nid = \"tr_bdf2\"\nposition_tol_rel = 1e-300\n", "5:20",
     "give at least 1e-15, or 0 for fixed steps"},
    {"ToleranceOfIndex3",
     "[model]\nid = \"inextensible_strand\"\n" + strand +
         "[integrator]\nid = \"tr_bdf2\"\nformulation = \"index3\"\n"
         "position_tol_rel = 1e-3\n",
     "8:20", ": use projection, or a fixed step"},
    {"OrderOutOfRange", strand + "[integrator]\nid = \"cvode_bdf\"\nmax_order = 6\n",
     "5:13", ": choose 1 to 5"},
    {"UnknownButcherTable",
     strand + "[integrator]\nid = \"arkode_dirk\"\ntable = \"NONE\"\n", "5:9",
     "ARKODE_CASH_5_3_4"},
    {"GainWithoutBaumgarte",
     "[model]\nid = \"inextensible_strand\"\n" + strand +
         "[integrator]\nid = \"tr_bdf2\"\nformulation = \"projection\"\nalpha = 1\n",
     "8:9", "or use formulation = \"baumgarte\""},
    {"OrderOfAMethodWithOne",
     strand + "[integrator]\nid = \"gsl_rkf45\"\nmax_order = 3\n", "5:13",
     "or use a method of several orders"},
    {"RtolOfAFixedStep", strand + "[integrator]\nid = \"radau5\"\nrtol = 1e-4\n", "5:8",
     "or use a method that takes rtol"},
    {"StepOfAnAdaptiveMethod", strand + "[integrator]\nid = \"ida\"\ndt_s = 1e-3\n",
     "5:8", "or use a method that takes dt_s"},
    {"LargestStepOfAFixedStep",
     strand + "[integrator]\nid = \"tr_bdf2\"\nmax_step_s = 1e-3\n", "5:14",
     "or use position_tol_rel"},
    {"SolverOfConstraintsWithoutThem",
     strand + "[integrator]\nid = \"tr_bdf2\"\nlinear = \"klu\"\n", "5:10",
     "or use ida, or a model with constraints"},
    {"ParametricWithSupports",
     strand + "[integrator]\nid = \"tr_bdf2\"\nformulation = \"parametric\"\n"
              "[[supports]]\nat = \"tip\"\n",
     "5:15", "leave it out, or give \"index3\""},
    {"NaturalShapeWithoutRows", strand + "[[effects.natural_shape]]\n", "3:1",
     "give rows of scale_over_time"},
    {"KeyOfAnotherTable", strand + "[model]\nlength_m = 1\n", "4:1", "unknown key"},
    {"OutOfRange", "[strand]\nlength_m = -1\n", "3:12",
     "give a number between 1e-09 and 1e+06: length of the strand (m)"},
    {"NotFinite", "[strand]\nlength_m = nan\n", "3:12", "not a finite number"},
    {"NotWhole", "[strand]\nelements = 1.5\n", "3:12", "not a whole number"},
    {"TextForNumber", "[strand]\nlength_m = \"1\"\n", "3:12",
     "expected a number, got a string"},
    {"NumberForWord", "[strand]\nshape = 1\n", "3:9", "expected a string, got a number"},
    {"DateForNumber", "[strand]\nlength_m = 1979-05-27\n", "3:12", "a date or a time"},
    {"TableForNumber", "[strand]\nlength_m = {}\n", "3:12", "got a table"},
    {"TwoOfThree", "[strand]\nroot_tangent = [1, 0]\n", "3:16", "2 numbers instead of 3"},
    {"NumberForTable", "strand = 3\n", "2:10", "write [strand]"},
    {"TwoOfOne", strand + "[[effects.gravity]]\n", "3:1", "give one [effects.gravity]"},
    {"FrictionOfAnotherMethod",
     strand + "[integrator]\nid = \"rk4\"\n[effects.strand_friction]\n", "4:6",
     "use linearly_implicit_euler or backward_euler"},
    {"FrictionOfOneSystem",
     strand + "[integrator]\nid = \"backward_euler\"\n[effects.strand_interaction]\n"
              "coupling = \"monolithic\"\n[effects.strand_friction]\n",
     "4:6", "leave out [effects.strand_friction]"},
    {"TwoInteractions", strand + "[[effects.strand_interaction]]\n", "3:1",
     "give one [effects.strand_interaction]"},
    {"RadiiOfInteraction",
     strand + "[effects.strand_interaction]\nouter_radius_m = 1e-3\n", "3:1",
     "give a larger outer radius"},
    {"NoDirection", "[strand]\nroot_tangent = [0, 0, 0]\n", "3:16", "no direction"},
    {"NormalAlongTangent", "[strand]\nnormal = [2, 0, 0]\n", "3:10", "along the tangent"},
    {"KeyWithoutUse", strand + "[root]\nmotion = \"shake\"\nspeed_m_s = 1\n", "5:13",
     "leave it out, or choose motion = stop"},
    {"LengthBesidePoints",
     "[strand]\nlength_m = 1\npoints = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]\n", "3:12",
     "leave one of them out"},
    {"TwoPoints", "[strand]\npoints = [[0, 0, 0], [1, 0, 0]]\n", "3:10", "3 to 10000"},
    {"SamePoints", "[strand]\npoints = [[0, 0, 0], [1, 0, 0], [1, 0, 0]]\n", "3:10",
     "points 2 and 3"},
    {"WindingPoints",
     "[strand]\nelements = 1\npoints = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], "
     "[0, 0, 0.1]]\n",
     "4:10", "half a turn"},
    {"CustomLacksRadius", strand + "[material]\nname = \"custom\"\n", "4:8",
     "give radius_m in [material]"},
    {"NoShearModulus", strand + "[material]\npoisson_ratio = -1\n", "4:17",
     "no shear modulus"},
    {"TwoKeysForTheShearModulus",
     strand + "[material]\nshear_modulus_pa = 9e8\npoisson_ratio = 0.3\n", "5:17",
     "leave one of them out"},
    {"TwoKeysForTheShearModulusOfAStrand",
     strand + "[strand.material]\npoisson_ratio = 0.3\nshear_modulus_pa = 9e8\n", "4:17",
     "leave one of them out"},
    {"TwoKeysForTheShearModulusOfATree",
     "[model]\nid = \"super_helix_tree\"\npoisson_ratio = 0.48\nshear_modulus_pa = "
     "9e8\n",
     "4:17", "leave one of them out"},
    {"CustomLacksShear",
     strand + "[material]\nname = \"custom\"\nradius_m = 4e-5\nyoungs_modulus_pa = "
              "4e9\ndensity_kg_m3 = 1320\n",
     "4:8", "give shear_modulus_pa or poisson_ratio in [material]"},
    {"KeyframesBackwards",
     strand + "[root]\nmotion = \"keyframes\"\n"
              "keyframes = [[1, 0, 0, 0, 0], [0, 0, 0, 0, 0]]\n",
     "5:13", "each later than the one before"},
    {"NoStrand", "", "1:1", "give a [strand], or a [groom]"},
    {"StrandOfATree", "[model]\nid = \"super_helix_tree\"\n" + strand, "4:1",
     "brings its own geometry"},
    {"MassiveGroom", "[groom]\ncount = 10000\nelements = 10000\n", "3:9", "1 to 20"},
    {"MassiveStrand", "[strand]\nelements = 99999999\n", "3:12", "out of range"},
    {"WindingElements", "[strand]\nlength_m = 1e6\nshape = \"helix\"\n", "2:1",
     "give more elements"},
    {"TooManyFrames", "duration_s = 1e6\nframes_per_s = 1e6\n" + strand, "3:16",
     "frames_per_s times duration_s"},
    {"ModelRefuses",
     "[model]\nid = \"super_helix\"\nmodes = \"bend_planar\"\n[strand]\nshape = "
     "\"helix\"\n",
     "5:1", "leaves the plane"},
    {"IntegratorCannotDrive",
     strand + "[model]\nid = \"super_helix\"\n[integrator]\nid = \"rattle\"\n", "6:6",
     "use one of: explicit_euler"},
    {"NeedsAFormulation", "[model]\nid = \"tinkertoys\"\n[integrator]\nid = \"rk4\"\n",
     "5:6", "choose a formulation"},
    {"EffectRefuses",
     strand + "[effects.wind]\nlaw = \"force\"\nvelocity_m_s = [0, 0, 0]\n", "3:1",
     ": give"},
};

INSTANTIATE_TEST_SUITE_P(Scenes, WrongSceneTest, testing::ValuesIn(wrong_scenes),
                         [](const auto& tested) { return tested.param.name; });

TEST(SceneErrors, TitleMustBeGiven) {
  EXPECT_THAT(refusal_of("[strand]\n"), HasSubstr("(s.toml:1:1): begin it with title"));
}

/// A method without several orders ignores max_order, others refuse 13.
TEST(SceneErrors, MaxOrderIsIdleWhereNoMethodReadsIt) {
  const Scene scene =
      parse_scene("title = \"t\"\n[model]\nid = \"mass_spring\"\n[strand]\n", "s.toml");
  const auto system =
      scene.model->on_strand(scene.strands.front(), scene.model_options, {});
  Options options;
  options.max_order = 13;
  for (const IntegratorEntry& entry : integrators::integrator_catalogue()) {
    if (!integrators::refusal(entry, *system, options.formulation).empty()) continue;
    bool reads = false;
    try {
      entry.make(*system, options);
    } catch (const InputError&) {
      reads = true;
    }
    EXPECT_EQ(idle_option(entry, options, "max_order").empty(), reads) << entry.id;
  }
}

std::string refusal_of_file(const std::string& file) {
  try {
    read_scene(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// Nobody writes into the pipe: whoever waited for it would wait for ever.
TEST(SceneErrors, OnlyRegularFilesOfLimitedSizeAreRead) {
  const Toy folder;
  folder.write("large.toml", std::string((4 << 20) + 1, '#'));
  const std::string pipe = folder.path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(refusal_of_file(folder.path("work/large.toml")), HasSubstr("4194304"));
  for (const std::string& special :
       {pipe, std::string("/dev/zero"), std::string("/dev/urandom")}) {
    EXPECT_THAT(refusal_of_file(special), HasSubstr("is not a regular file"));
  }
  EXPECT_THAT(refusal_of_file(folder.path("work")), HasSubstr("is a directory"));
  EXPECT_THAT(refusal_of_file(folder.path("none")), HasSubstr("No such file"));
}

}  // namespace tress::test_errors
