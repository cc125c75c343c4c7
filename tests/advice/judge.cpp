// judge SCENE ADVISED STRANDS: how far is a run of ADVISED, as it is written, from the
// rod of SCENE? By a reference that cost_of_accuracy does not use: super_clothoid by
// tr_bdf2, once more with half the elements and four times the tolerance. Prints "ERROR
// DOUBT": rms of the tips at all frames over the length, and the same of the two
// references.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "experiments/cost_of_accuracy/scene_reference.h"
#include "experiments/numerics/tip_track.h"
#include "simulation/run/tip_paths.h"

namespace tress {
namespace {

using namespace experiments;
using namespace experiments::cost_of_accuracy;
using experiments::cost_of_accuracy::Method;

constexpr int elements = 48;
constexpr double tolerance = 4e-6;

TipPaths reference(const Scene& given, const Comparison& compare, int refined) {
  Method method{{&find_model("super_clothoid"), {}, "tr_bdf2"}};
  method.by_tolerance = true;
  Scene scene = compared(
      trial_scene(given, method, elements * refined / 2,
                  {.tolerance = 4 * tolerance / (refined * refined)}, compare.rate),
      compare);
  scene.options.max_step = 0.5 / compare.rate;
  return tip_paths(scene, 0);
}

int judge(const std::string& given_file, const std::string& advised_file, int strands) {
  const Scene given = read_open_scene(given_file), advised = read_scene(advised_file);
  const Comparison compare =
      comparison(given, advised.frame_rate, 0, static_cast<std::size_t>(strands));
  const TipPaths coarse = reference(given, compare, 1),
                 fine = reference(given, compare, 2);
  const TipPaths run = tip_paths(compared(advised, compare), 0);
  std::printf("%.6g %.6g\n", tip_error(run.x, fine.x, compare.length),
              tip_error(coarse.x, fine.x, compare.length));
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
