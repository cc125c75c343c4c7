// Steps of strands that are held at the tip by a ball joint (3 constraints) and by a
// clamp (6, or 3 and an elastic joint of half an edge), as multiples of the strand
// without the support. The support leads the tip away. Backward Euler with a matrix in
// every iteration.
#include <fmt/format.h>

#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

#include "experiments/benchmarks/fixture.h"
#include "integrators/catalogue.h"
#include "simulation/rest/supported_start.h"
#include "simulation/scene/scene.h"
#include "simulation/scene/support_table.h"

namespace tress::experiments::benchmarks {
namespace {

using simulation::Scene;

constexpr std::string_view strand_models[] = {"super_helix", "super_clothoid",
                                              "articulated_chain"};
constexpr int element_counts[] = {10, 20, 40};
constexpr int steps = 40;

/// Most of an iteration, over that of the strand without a support.
constexpr double most_of_ball = 1.35, most_of_clamp = 1.35;

enum class Held { nothing, place, section };

Scene scene_of(std::string_view model, int elements, Held held) {
  std::string support;
  if (held != Held::nothing) {
    support = fmt::format(
        "[[supports]]\nkind = \"{}\"\n"
        "keyframes = [[0, 0.08, 0, 0], [0.2, 0.06, 0, 0.03]]\n",
        held == Held::place ? "ball" : "clamp");
  }
  return simulation::parse_scene(fmt::format(R"(title = "strand that is led by its tip"
duration_s = 1
[model]
id = "{}"
jacobian = "exact"
[integrator]
id = "backward_euler"
dt_s = 2.5e-3
refresh = "every_iteration"
[material]
internal_friction_kg_m3_s = 1e-8
[strand]
length_m = 0.1
elements = {}
root_tangent = [1, 0, 0]
shape = "helix"
curl_radius_m = 0.005
curl_pitch_m = 0.05
{}[effects.gravity]
[effects.linear_drag]
drag_kg_m_s = 5e-5
)",
                                             model, elements, support),
                                 "led.toml");
}

/// A strand at its start, and runs of `steps` steps from there.
struct Led {
  std::shared_ptr<System> system;
  std::shared_ptr<Integrator> integrator;
  State start;
  double step = 0;

  void go() const {
    Status s = integrator->start(0, start.q, start.v);
    if (s == Status::ok) s = integrator->advance(steps * step);
    if (s != Status::ok) throw std::runtime_error("a strand has no next step");
  }
  double iterations() const {
    go();
    return static_cast<double>(integrator->stats().newton_iterations);
  }
};

Led led(std::string_view model, int elements, Held held) {
  const Scene scene = scene_of(model, elements, held);
  Led made;
  const simulation::SceneSupports supports(scene);
  made.system =
      supports.on(scene.model->on_strand(scene.strands.front(), scene.model_options,
                                         simulation::make_effects(scene)),
                  scene.strands.front(), 0);
  Options options = scene.options;
  if (supports.any()) {
    static_cast<void>(simulation::begin_on_supports(*made.system, "benchmark"));
  } else {
    options.formulation = Formulation::parametric;
  }
  made.integrator = integrators::make_integrator(scene.integrator, *made.system, options);
  made.start = initial_state(*made.system);
  made.step = options.step;
  return made;
}

std::string title(std::string_view model, int elements, Held held) {
  constexpr std::string_view kinds[] = {"free", "ball", "clamp"};
  return fmt::format("{}/{}/{}", model, kinds[static_cast<int>(held)], elements);
}

void register_all() {
  for (const std::string_view model : strand_models) {
    for (const Held held : {Held::nothing, Held::place, Held::section}) {
      for (const int elements : element_counts) {
        benchmark::RegisterBenchmark(title(model, elements, held).c_str(),
                                     [=](benchmark::State& state) {
                                       const Led one = led(model, elements, held);
                                       for ([[maybe_unused]] auto _ : state) one.go();
                                       count_per_element(state, steps * elements);
                                     });
      }
    }
  }
}

bool costs_met() {
  bool met = true;
  for (const std::string_view model : strand_models) {
    for (const int elements : element_counts) {
      const Led free = led(model, elements, Held::nothing);
      for (const Held held : {Held::place, Held::section}) {
        const Led one = led(model, elements, held);
        const double more = one.iterations() / free.iterations();
        const double ratio = time_ratio([&] { one.go(); }, [&] { free.go(); });
        fmt::print(
            "{}: a step takes {:.2f} of a free one, with {:.2f} of its iterations\n",
            title(model, elements, held), ratio, more);
        met = kept("supports", title(model, elements, held) + ": an iteration",
                   ratio / more, held == Held::place ? most_of_ball : most_of_clamp) &&
              met;
      }
    }
  }
  return met;
}

}  // namespace
}  // namespace tress::experiments::benchmarks

int main(int argc, char** argv) {
  using namespace tress::experiments::benchmarks;
  register_all();
  return run_and_judge(argc, argv, [](const Measured&) { return costs_met(); });
}
