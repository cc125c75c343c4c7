// No accepted step of a contact scene of validation has friction that does work on a
// slide.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "contract/integrator.h"
#include "experiments/validation/test.h"

namespace tress::test_friction_work {

using namespace experiments;
using namespace experiments::validation;

struct Scene {
  std::string_view name;
  long steps;             // of a run at most: beyond them the scene's bisection repeats
  bool touching = false;  // strands rub on each other, by impulses at the ends of steps
};
constexpr Scene scenes[] = {{"tilted_plane", 330},      {"flat_impact", 20},
                            {"stick_slip_exact", 1100}, {"capstan", 220},
                            {"heavy_strand", 500},      {"ladder", 700},
                            {"crossing", 500, true},    {"pile", 500, true}};

struct Way {
  std::string_view integrator;
  bool rigid, upright;  // surfaces; whether z is up, else y
};

struct Rubbing {
  Scene scene;
  ModelVariant variant;
  std::vector<Way> runs;
  long steps;  // of each at most
};
void PrintTo(const Rubbing& of, std::ostream* out) {
  std::string name =
      fmt::format("{}_{}_{}", of.scene.name, of.variant.model->id, of.variant.words);
  std::ranges::replace_if(
      name, [](unsigned char c) { return !std::isalnum(c); }, '_');
  *out << name;
}

class FrictionWork : public testing::TestWithParam<Rubbing> {};

/// Accepted steps, those with T.u > 0 beyond the bound, and the largest T.u/(mu N), m/s.
struct Count {
  long steps = 0, driven = 0;
  double fastest = 0;
};

Count count(const Rubbing& of, const Way& run, double bound) {
  struct Enough {};
  const ValidationTest& test = find_validation_test(of.scene.name);
  ContactRun contact{.integrator = run.integrator, .rigid = run.rigid};
  if (!run.upright) contact.turned = rotation({1, 0, 0}, std::numbers::pi / 2);
  Count found;
  contact.each_drive = [&](double drive) {
    ++found.steps;
    found.driven += drive > bound ? 1 : 0;
    found.fastest = std::max(found.fastest, drive);
    if (found.steps >= of.steps) throw Enough();
  };
  const Deadline deadline(600);
  try {
    (void)test.measure({of.variant, test.quick.elements.front(),
                        test.quick.parameters.front(), deadline, contact});
  } catch (const Enough&) {
  } catch (const InputError&) {  // the model or the method cannot be in this scene
    found.steps = -1;
  } catch (const std::runtime_error&) {  // a run that failed, or has no threshold
  }
  return found;
}

// The bound is the tolerance of contact: a step that violates the law by so little has
// T.u/(mu N) of at most that (ExactContact::State::violation()), and rounding errors of a
// few velocities are less than a millionth of it.
TEST_P(FrictionWork, IsNotDoneOnASlide) {
  const double bound = Options().contact_tolerance;
  Count all;
  for (const Way& run : GetParam().runs) {
    const Count one = count(GetParam(), run, bound);
    if (one.steps < 0) continue;
    EXPECT_GT(one.steps, 0) << run.integrator;
    EXPECT_EQ(one.driven, 0) << run.integrator << (run.rigid ? " rigid" : " compliant")
                             << (run.upright ? ": " : " turned: ") << one.fastest;
    all.steps += one.steps;
    all.driven += one.driven;
    all.fastest = std::max(all.fastest, one.fastest);
  }
  std::printf("friction does work on a slide in %ld of %ld steps, at most %.2g m/s\n",
              all.driven, all.steps, all.fastest);
}

/// Every scene with every model by a quarter of one of its runs in turn, or by a
/// sixteenth of each other, which are `more`.
std::vector<Rubbing> rubbing(bool more) {
  std::vector<Rubbing> all;
  std::size_t turn = 0;
  for (const Scene& scene : scenes) {
    const std::vector<std::string_view> integrators =
        scene.touching
            ? std::vector<std::string_view>{"backward_euler", "linearly_implicit_euler"}
            : std::vector<std::string_view>{"backward_euler", "bdf2", "tr_bdf2"};
    std::vector<Way> runs;
    for (const bool upright : {true, false}) {
      if (scene.touching && !upright) continue;
      for (const bool rigid : {true, false}) {
        for (const std::string_view integrator : integrators) {
          runs.push_back({integrator, rigid, upright});
        }
      }
    }
    for (const ModelVariant& variant : length_variants()) {
      const std::size_t own = turn++ % runs.size();
      std::vector<Way> some;
      for (std::size_t i = 0; i < runs.size(); ++i) {
        if ((i == own) != more) some.push_back(runs[i]);
      }
      // Its contacts take up to seconds a step.
      const long part = variant.model->id == "dynamic_spline" ? 8 : 1;
      all.push_back({scene, variant, some, scene.steps / part / (more ? 16 : 4)});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Scenes, FrictionWork, testing::ValuesIn(rubbing(false)),
                         testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(More, FrictionWork, testing::ValuesIn(rubbing(true)),
                         testing::PrintToStringParamName());

}  // namespace tress::test_friction_work
