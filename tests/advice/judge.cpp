// judge SCENE ADVISED STRANDS: how far is a run of ADVISED, as it is written, from the
// rod of SCENE? By two models that cost_of_accuracy does not take for its references, by
// tr_bdf2: super_clothoid, and corde extrapolated from two numbers of elements. Prints
// "ERROR DOUBT": rms of the tips over the length, at all frames after t = 0 and at the
// end, of the run and of one reference from the other. Where supports or joints hold
// points, rms of the largest distance along the strands.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/cost_of_accuracy/reference_side.h"
#include "experiments/cost_of_accuracy/scene_reference.h"

namespace tress {
namespace {

using namespace experiments;
using namespace experiments::cost_of_accuracy;
using experiments::cost_of_accuracy::Method;

constexpr double tolerance = 4e-6;

std::vector<double> tips(const Scene& given, const Comparison& compare, const char* model,
                         int elements, double to) {
  std::vector<Method> all = methods(given, side_choice({model}, {"tr_bdf2"}));
  std::erase_if(all, [](const Method& one) { return !one.by_tolerance; });
  if (all.empty())
    throw std::runtime_error(std::string(model) + " does not run the scene");
  const Method& method = all.front();
  Scene scene = compared(
      trial_scene(given, method, elements, {.tolerance = to}, compare.rate), compare);
  scene.options.max_step = 0.5 / compare.rate;
  return compared_paths(scene, compare).x;
}

/// Where something touches, the instant of contact depends on the elements: the finer run
/// is taken as it is.
std::vector<double> limit_of_corde(const Scene& given, const Comparison& compare) {
  constexpr int elements = 32;
  const bool touches = std::ranges::any_of(
      given.effects, [](const EffectChoice& one) { return one.entry->id == "body"; });
  std::vector<double> x = tips(given, compare, "corde", 2 * elements, tolerance);
  if (touches) return x;
  const std::vector<double> coarse = tips(given, compare, "corde", elements, tolerance);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += (x[i] - coarse[i]) / 3;
  return x;
}

int judge(const std::string& given_file, const std::string& advised_file, int strands) {
  const Scene given = read_open_scene(given_file), advised = read_scene(advised_file);
  const Comparison compare =
      comparison(given, advised.frame_rate, 0, static_cast<std::size_t>(strands));
  const std::vector<double> reference =
      tips(given, compare, "super_clothoid", 48, tolerance);
  const std::vector<double> other = limit_of_corde(given, compare);
  const TipPaths run = compared_paths(compared(advised, compare), compare);
  std::printf("%.6g %.6g\n", compared_error(run.x, reference, compare),
              compared_error(other, reference, compare));
  return 0;
}

}  // namespace
}  // namespace tress

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: judge SCENE ADVISED STRANDS\n", stderr);
    return 2;
  }
  try {
    return tress::judge(argv[1], argv[2], std::atoi(argv[3]));
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "judge: %s\n", failure.what());
    return 1;
  }
}
