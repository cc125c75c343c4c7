// python_reference frequencies MODEL ELEMENTS: the lowest twelve frequencies (rad/s) of a
// curl without weight. python_reference steps SCENE COUNT: seconds of a step of this
// scene, the least of five runs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "contract/input_error.h"
#include "experiments/run/exit_code.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/rods/statics.h"
#include "simulation/run/timing.h"
#include "simulation/run/world.h"

namespace tress::experiments::validation {
namespace {

void print_frequencies(std::string_view model, int elements) {
  TestRod rod;
  rod.natural = uniform_shape({30, 100, 0});
  const ModelVariant variant{&find_model(model), {}, {}};
  Statics statics(variant, rod.strand(elements, horizontal_clamp()), {});
  const std::vector<SmallMotion> motions = statics.motions();
  for (std::size_t k = 0; k < 12; ++k) {
    fmt::print("{:.17g}\n", std::sqrt(motions[k].square));
  }
}

void print_step(const std::string& file, int count) {
  const Scene scene = read_scene(file);
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < 5; ++run) {
    simulation::World world(scene, 1);
    least = std::min(least, simulation::seconds_of([&] {
                       for (int k = 1; k <= count; ++k) {
                         if (world.advance(k * scene.options.step) != Status::ok) {
                           throw std::runtime_error(world.failure());
                         }
                       }
                     }));
  }
  fmt::print("{:.17g}\n", least / count);
}

int answer(const std::vector<std::string>& words) {
  if (words.size() == 3 && words[0] == "frequencies") {
    print_frequencies(words[1], std::stoi(words[2]));
    return done;
  }
  if (words.size() == 3 && words[0] == "steps") {
    print_step(words[1], std::stoi(words[2]));
    return done;
  }
  throw InputError("not what this program does", "command line",
                   "frequencies MODEL ELEMENTS, or steps SCENE COUNT");
}

}  // namespace
}  // namespace tress::experiments::validation

int main(int argc, char** argv) {
  return tress::experiments::exit_code("python_reference", [&] {
    return tress::experiments::validation::answer({argv + 1, argv + argc});
  });
}
