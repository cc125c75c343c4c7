#include "experiments/block_descent/block_descent.h"
#include "simulation/files/parse.h"

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

/// A way to solve the step, and the models on which it is tried.
struct Way {
  std::string integrator;
  Words options;
  bool rods;  // on xpbd_cosserat too, whose nodes are twice as many
};

const std::vector<Way>& ways() {
  static const std::vector<Way> all{{"xpbd", {}, true},
                                    {"vbd", {}, true},
                                    {"vbd", {{"chebyshev", "0.8"}}, false},
                                    {"vbd", {{"block", "2"}}, true},
                                    {"vbd", {{"block", "4"}}, true},
                                    {"vbd", {{"block", "8"}}, true},
                                    {"vbd", {{"block", "16"}}, true},
                                    {"vbd", {{"block", "0"}}, true},
                                    {"vbd_augmented", {}, true},
                                    {"vbd_augmented", {{"block", "4"}}, false},
                                    {"stable_cosserat_rods", {}, true}};
  return all;
}

std::vector<std::string> levels(const CommandLine& line, std::vector<std::string> all,
                                std::size_t quick) {
  if (line.quick) all.resize(quick);
  return all;
}

}  // namespace

std::vector<Trial> descent_trials(const CommandLine& line) {
  std::vector<Trial> all;
  const auto add = [&](const Trial& trial) {
    if (chosen(line, trial)) all.push_back(trial);
  };
  for (const char* model : {"mass_spring", "xpbd_cosserat"}) {
    const bool rod = std::string_view(model) == "xpbd_cosserat";
    if (rod && line.quick) continue;
    for (const Way& way : ways()) {
      if ((rod && !way.rods) || (!rod && way.integrator == "stable_cosserat_rods")) {
        continue;
      }
      for (const std::string& sweeps :
           levels(line, {"20", "5", "1", "2", "10", "50", "100", "300", "1000"}, 2)) {
        add({.part = "sweeps",
             .scene = "swing",
             .model = model,
             .integrator = way.integrator,
             .model_settings = {},
             .options = with(way.options, "sweeps", sweeps)});
      }
    }
  }
  for (const double dt : {substep, 1e-3, 1.0 / 60}) {
    if (line.quick && dt != substep) continue;
    for (const std::string& primal : levels(line, {"1", "4"}, 1)) {
      for (const std::string& penalty : levels(line,
                                               {"6e5", "1e4", "1e8", "3e4", "1e5", "2e5",
                                                "3e5", "9e5", "1.5e6", "3e6", "1e7"},
                                               3)) {
        add({.part = "penalty",
             .scene = "swing",
             .model = "mass_spring",
             .integrator = "vbd_augmented",
             .model_settings = {},
             .options = {{"penalty_1_s2", penalty},
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
  for (const double factor : {1.0, 1e-2, 1e-4, 1e-6}) {
    rods.push_back({"swing",
                    {{"stretch_factor", number_text(factor)},
                     {"shear_factor", number_text(isotropic * factor)}},
                    20});
  }
  rods.push_back({"cantilever", {}, 10});
  std::vector<Trial> all;
  for (const Rod& rod : rods) {
    if (line.quick && rod.scene != "cantilever") continue;
    for (const double dt : {1.0 / 120, 1.0 / 30, substep, 1e-3, 2.5e-4}) {
      for (const std::string& sweeps : levels(line, {"4", "20", "100"}, 2)) {
        if (line.quick && dt < 1.0 / 120) continue;
        const Trial trial{.part = "rods",
                          .scene = rod.scene,
                          .model = "xpbd_cosserat",
                          .integrator = "stable_cosserat_rods",
                          .model_settings = rod.settings,
                          .options = {{"sweeps", sweeps}},
                          .elements = rod.elements,
                          .dt = dt};
        if (chosen(line, trial)) all.push_back(trial);
      }
    }
  }
  return all;
}

}  // namespace tress::experiments::block_descent
