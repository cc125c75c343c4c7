// What a scene costs beside the same strand built by hand, with nothing around it that
// could know of effects the scene does not name. The requirement: at most 1 %.
#include <fmt/format.h>

#include <array>
#include <memory>

#include "experiments/benchmarks/fixture.h"
#include "models/effects/gravity.h"
#include "simulation/run/timing.h"
#include "simulation/run/world.h"

namespace tress::experiments::benchmarks {
namespace {

constexpr std::array<std::string_view, 3> models = {"super_helix", "der", "corde"};
constexpr int steps_per_batch = 20;

/// A shaken hair under gravity and nothing else.
Scene shaken(std::string_view model) {
  return parse_scene(fmt::format(R"(title = "shaken hair"
source = "benchmark"
duration_s = 1
[model]
id = "{}"
[integrator]
id = "linearly_implicit_midpoint"
dt_s = 1e-3
[strand]
length_m = 0.1
elements = 20
[root]
motion = "shake"
[effects.gravity]
)",
                                 model),
                     "shaken.toml");
}

class ByHand {
 public:
  explicit ByHand(const Scene& scene)
      : step_(scene.options.step),
        system_(scene.model->on_strand(scene.strands.front(), scene.model_options,
                                       {std::make_shared<Gravity>(Vec{0, 0, -9.81})})),
        integrator_(find_integrator(scene.integrator).make(*system_, scene.options)) {
    const State start = initial_state(*system_);
    ok_ = integrator_->start(0, start.q, start.v) == Status::ok;
  }
  bool advance(int steps) {
    taken_ += steps;
    return ok_ && integrator_->advance(taken_ * step_) == Status::ok;
  }

 private:
  double step_;
  std::unique_ptr<System> system_;
  std::unique_ptr<Integrator> integrator_;
  double taken_ = 0;
  bool ok_;
};

class AsScene {
 public:
  explicit AsScene(const Scene& scene) : step_(scene.options.step), world_(scene) {}
  bool advance(int steps) {
    taken_ += steps;
    return world_.advance(taken_ * step_) == Status::ok;
  }

 private:
  double step_;
  World world_;
  double taken_ = 0;
};

template <class Runner>
void run(benchmark::State& state, std::string_view model) {
  Runner runner(shaken(model));
  while (state.KeepRunningBatch(steps_per_batch)) {
    if (!runner.advance(steps_per_batch)) {
      state.SkipWithError("a step failed");
      return;
    }
  }
}

void register_all() {
  for (const std::string_view model : models) {
    const auto add = [model](std::string_view name, auto call) {
      benchmark::RegisterBenchmark(fmt::format("{}/{}", name, model).c_str(),
                                   [=](benchmark::State& state) { call(state, model); });
    };
    add("scene", run<AsScene>);
    add("by_hand", run<ByHand>);
  }
}

/// Median of the ratios of neighbouring batches, taken in turn: what else the machine
/// does falls on both.
double cost_ratio(std::string_view model) {
  constexpr int batches = 2001;
  const Scene scene = shaken(model);
  AsScene as_scene(scene);
  ByHand by_hand(scene);
  std::vector<double> ratios;
  for (int i = 0; i < batches; ++i) {
    bool ok = true;
    const auto time = [&](auto& runner) {
      return seconds_of([&] { ok = runner.advance(steps_per_batch) && ok; });
    };
    // Each comes first every other time.
    const double first = i % 2 == 0 ? time(as_scene) : time(by_hand);
    const double second = i % 2 == 0 ? time(by_hand) : time(as_scene);
    if (!ok) return 0;
    ratios.push_back(i % 2 == 0 ? first / second : second / first);
  }
  return median(ratios);
}

/// Prints the requirement with what was measured; false when it is not met.
bool requirement_met() {
  constexpr double most = 1.01;
  bool met = true;
  for (const std::string_view model : models) {
    const double ratio = cost_ratio(model);
    const bool kept = ratio > 0 && ratio <= most;
    fmt::print(
        "requirement on scenes: {}: {} takes {:.4f} times as long as by hand (at "
        "most {})\n",
        kept ? "met" : "NOT met", model, ratio, most);
    met = met && kept;
  }
  return met;
}

}  // namespace
}  // namespace tress::experiments::benchmarks

int main(int argc, char** argv) {
  using namespace tress::experiments::benchmarks;
  register_all();
  return run_and_judge(argc, argv, [](const Measured&) { return requirement_met(); });
}
