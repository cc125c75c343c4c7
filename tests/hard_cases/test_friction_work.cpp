// No accepted step of a hard case has friction that does work on a slide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "contract/forms/contact_form.h"
#include "contract/input_error.h"
#include "experiments/hard_cases/course.h"
#include "experiments/problems/formulations.h"
#include "integrators/catalogue.h"
#include "models/catalogue.h"

namespace tress::test_friction_work {

using namespace experiments;
using namespace experiments::hard_cases;

struct Tried {
  std::string name;
  std::vector<std::string_view> integrators;
};
void PrintTo(const Tried& of, std::ostream* out) { *out << of.name; }

class FrictionWork : public testing::TestWithParam<Tried> {
 protected:
  static const HardCase& hard() {
    return *std::ranges::find(hard_case_catalogue(), GetParam().name, &HardCase::name);
  }
};

/// Accepted steps, those in which friction did work on a slide, and the largest T.u/(mu
/// N), m/s.
struct Count {
  long steps = 0, driven = 0;
  double fastest = 0;
};

/// `bound`: that of a law which holds within its tolerance.
Count count(const HardCase& hard, const ModelEntry& model, std::string_view integrator,
            const Pace& pace, double bound) {
  constexpr WorkLimit limit{3e5};
  const Subject subject{&model, {}, ""};
  const Parameters defaults(setup_parameters(model), "test");
  Situation s = situation(hard, subject, defaults);
  const auto formulation =
      preferred_formulation(find_integrator(integrator), *s.system, pace.tolerance);
  if (!formulation) return {};
  Course c = course({&hard, subject, defaults, integrator, pace, {}, 1});
  c.options.formulation = *formulation;
  // A run that has come apart beyond all bounds has no friction to speak of.
  const double farthest = 2 * s.length;
  MaterialPoints& points = *s.system->material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  Count found;
  (void)watch(integrator, hard, subject, s, c, limit, [&](double t, In q, In) {
    points.positions(t, q, x);
    const auto [least, most] = std::ranges::minmax(x);
    if (!(most - least <= farthest)) return false;
    const double drive =
        s.rubbing ? s.rubbing->friction().drive() : s.system->contact_form()->drive();
    ++found.steps;
    found.driven += drive > bound ? 1 : 0;
    found.fastest = std::max(found.fastest, drive);
    return true;
  });
  return found;
}

TEST_P(FrictionWork, IsNotDoneOnASlide) {
  constexpr double frame = 1 / 30.0, fine = 1 / 300.0;
  // ExactContact::State::violation(), and StrandFriction::drive() of its default.
  const double bound = hard().impulses ? 5e-6 : Options().contact_tolerance;
  Count all;
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand == nullptr) continue;
    for (const std::string_view integrator : GetParam().integrators) {
      for (const double step : {frame, fine}) {
        const Pace pace{step, integrator == "tr_bdf2" ? 1e-3 : 0};
        Count one;
        try {
          one = count(hard(), model, integrator, pace, bound);
        } catch (const InputError&) {  // the model cannot be in this situation
        }
        EXPECT_EQ(one.driven, 0) << model.id << ' ' << integrator << ' ' << step;
        all.steps += one.steps;
        all.driven += one.driven;
        all.fastest = std::max(all.fastest, one.fastest);
      }
    }
  }
  std::printf("%s: friction does work on a slide in %ld of %ld steps, at most %.2g m/s\n",
              GetParam().name.c_str(), all.driven, all.steps, all.fastest);
  EXPECT_GT(all.steps, 100);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, FrictionWork,
    testing::Values(Tried{"grazing_exact", {"backward_euler", "bdf2", "tr_bdf2"}},
                    Tried{"cone_exact", {"backward_euler", "bdf2", "tr_bdf2"}},
                    Tried{"grazing_impulse",
                          {"backward_euler", "linearly_implicit_euler"}},
                    Tried{"cone_impulse", {"backward_euler", "linearly_implicit_euler"}},
                    Tried{"coil_impulse", {"backward_euler", "linearly_implicit_euler"}}),
    testing::PrintToStringParamName());

}  // namespace tress::test_friction_work
