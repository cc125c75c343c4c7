#include <span>

#include "experiments/block_descent/block_descent.h"

namespace tress::experiments::block_descent {
namespace {

using Words = std::vector<std::pair<std::string, std::string>>;

bool chosen(const CommandLine& line, const Trial& trial) {
  return wanted(line.models, trial.model) && wanted(line.integrators, trial.integrator);
}

Words with(Words words, std::string key, const std::string& value) {
  words.emplace_back(std::move(key), value);
  return words;
}

/// A way to solve the step.
struct Way {
  std::string integrator;
  Words options;
  bool quick;
};

const Way of_springs[] = {{"xpbd", {}, true},
                          {"xpbd", {{"anderson", "5"}}, true},
                          {"vbd", {}, true},
                          {"vbd", {{"chebyshev", "0.8"}}, true},
                          {"vbd", {{"anderson", "5"}}, true},
                          {"vbd", {{"block", "2"}}, false},
                          {"vbd", {{"block", "4"}}, true},
                          {"vbd", {{"block", "8"}}, false},
                          {"vbd", {{"block", "16"}}, true},
                          {"vbd", {{"block", "0"}}, true},
                          {"vbd_augmented", {}, true},
                          {"vbd_augmented", {{"block", "4"}}, true}};
// Their nodes are twice as many: positions and quaternions.
const Way of_rods[] = {{"xpbd", {}, false},
                       {"vbd", {}, false},
                       {"vbd", {{"block", "8"}}, false},
                       {"vbd", {{"block", "32"}}, false},
                       {"vbd", {{"block", "0"}}, false},
                       {"vbd_augmented", {}, false},
                       {"stable_cosserat_rods", {}, false}};

/// The first `quick` of all, or all.
template <class T>
std::vector<T> levels(const CommandLine& line, std::vector<T> all, std::size_t quick) {
  if (line.quick) all.resize(quick);
  return all;
}

}  // namespace

std::vector<Trial> descent_trials(const CommandLine& line) {
  std::vector<Trial> all;
  const auto add = [&](const Trial& trial) {
    if (chosen(line, trial)) all.push_back(trial);
  };
  const auto add_ways = [&](const char* model, std::span<const Way> ways) {
    for (const Way& way : ways) {
      if (line.quick && !way.quick) continue;
      for (const char* sweeps : levels<const char*>(
               line, {"1", "5", "20", "100", "2", "10", "50", "300"}, 4)) {
        add({.part = "sweeps",
             .scene = "swing",
             .model = model,
             .integrator = way.integrator,
             .model_settings = {},
             .options = with(way.options, "sweeps", sweeps)});
      }
    }
  };
  add_ways("mass_spring", of_springs);
  add_ways("xpbd_cosserat", of_rods);
  // The order of the step where sweeps are few.
  for (const double dt : levels<double>(line, {substep, 1.0 / 1500}, 1)) {
    for (const char* sweeps : {"4", "20"}) {
      for (const char* integrator : {"xpbd", "xpbd_bdf2"}) {
        add({.part = "order",
             .scene = "swing",
             .model = "mass_spring",
             .integrator = integrator,
             .model_settings = {},
             .options = {{"sweeps", sweeps}},
             .dt = dt});
      }
    }
  }
  // Over the square of the step: the window follows it.
  for (const double dt : {substep, 1e-3, 1.0 / 60}) {
    for (const char* primal : levels<const char*>(line, {"1", "4"}, 1)) {
      for (const double scaled : {0.3, 1.0, 2.0, 3.5, 5.0, 7.0, 10.0, 20.0, 100.0, 1e3}) {
        add({.part = "penalty",
             .scene = "swing",
             .model = "mass_spring",
             .integrator = "vbd_augmented",
             .model_settings = {},
             .options = {{"penalty_per_s2", number_text(scaled / (dt * dt))},
                         {"primal_sweeps", primal},
                         {"sweeps", std::to_string(tried_sweeps)}},
             .dt = dt});
      }
    }
  }
  return all;
}

std::vector<Trial> rod_trials(const CommandLine& line) {
  // k GA = EA: the papers' one stiffness against stretch and shear.
  struct Rod {
    std::string scene;
    Words settings;
    int elements;
  };
  std::vector<Rod> rods;
  constexpr double isotropic = 2.96;  // E/G of the swinging strand, 2 (1 + 0.48)
  for (const double factor : {1.0, 1e-2, 1e-4, 1e-5}) {
    rods.push_back({"swing",
                    {{"stretch_factor", number_text(factor)},
                     {"shear_factor", number_text(isotropic * factor)}},
                    20});
  }
  rods.push_back({"cantilever", {}, 10});
  std::vector<Trial> all;
  for (const Rod& rod : rods) {
    for (const double dt :
         levels<double>(line, {1.0 / 30, 1.0 / 120, substep, 1e-3, 2.5e-4}, 4)) {
      for (const int sweeps : {4, 20, 100}) {
        if (line.quick && sweeps == 100 && dt <= substep) continue;
        const Trial trial{.part = "rods",
                          .scene = rod.scene,
                          .model = "xpbd_cosserat",
                          .integrator = "stable_cosserat_rods",
                          .model_settings = rod.settings,
                          .options = {{"sweeps", std::to_string(sweeps)}},
                          .elements = rod.elements,
                          .dt = dt};
        if (chosen(line, trial)) all.push_back(trial);
      }
    }
  }
  return all;
}

}  // namespace tress::experiments::block_descent
