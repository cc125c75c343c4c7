#include <algorithm>
#include <cmath>

#include "experiments/validation/rods/master_curve.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/rods/statics.h"
#include "experiments/validation/test.h"

namespace tress::experiments::validation {
namespace {

constexpr double small_load = 0.1;  // Gamma or alpha: linear bending
constexpr Vec down{0, 0, -1};

double height_over_width(double gamma) {
  const Cantilever exact = cantilever(gamma, 0);
  return exact.height / exact.width;
}

double bent_by_weight(const ModelTrial& trial, double grading) {
  const double gamma = trial.parameter;
  const TestRod rod{.grading = grading};
  Statics statics(trial.variant, rod.strand(trial.elements, horizontal_clamp()),
                  rod.gravity(gamma) * down);
  statics.follow(std::min(1.0, small_load / gamma), 1);
  const Vec tip = statics.tip();
  return -tip.z / tip.x;
}

/// Under a large weight the strand turns down within sqrt(1/(2 Gamma)) L of the clamp, so
/// elements have to be short there.
double bent_graded(const ModelTrial& trial) {
  return bent_by_weight(trial, std::max(1.0, std::sqrt(trial.parameter) / 4));
}

double bent_uniform(const ModelTrial& trial) { return bent_by_weight(trial, 1); }

double deflection(double alpha) { return cantilever(0, alpha).height; }

double bent_by_force(const ModelTrial& trial) {
  const double alpha = trial.parameter;
  const TestRod rod;
  Statics statics(trial.variant, rod.strand(trial.elements, horizontal_clamp()), {},
                  {.force = (alpha * rod.force()) * down});
  statics.follow(std::min(1.0, small_load / alpha), 1);
  return -statics.tip().z / rod.length;
}

}  // namespace

/// A clamped strand bent by its weight or by a tip force.
std::vector<ValidationTest> cantilever_tests() {
  return {
      {
          .name = "cantilever",
          .what = "clamped horizontally, bent by its weight; elements short at the clamp",
          .source = "Romero et al. 2021; the planar elastica by shooting",
          .parameter = "Gamma = rho g S L^3/EI",
          .quantity = "height over width of the tip",
          .range = {1e-3, 1e5},
          .quick = {{0.1, 10, 1000}, {10, 40}},
          .usual = {{0.1, 1, 10, 100, 1000}, {5, 10, 20, 40}},
          .full = {{0.1, 0.3, 1, 3, 10, 30, 100, 300, 1000}, {5, 10, 20, 40, 80}},
          .tolerance = 0.01,
          .why = "1 % at 40 elements is wanted",
          .judged_from = 40,
          .claimed = {"super_helix", "super_clothoid", "der", "corde", "dynamic_spline"},
          .reference = height_over_width,
          .measure = bent_graded,
      },
      {
          .name = "cantilever_uniform",
          .what = "the same with elements of one length",
          .source = "Romero et al. 2021; the planar elastica by shooting",
          .parameter = "Gamma = rho g S L^3/EI",
          .quantity = "height over width of the tip",
          .range = {1e-3, 1e5},
          .quick = {{1000}, {40}},
          .usual = {{100, 1000}, {5, 10, 20, 40}},
          .full = {{100, 300, 1000}, {5, 10, 20, 40, 80}},
          .tolerance = 0.01,
          .why = "told, not claimed: at Gamma = 1000 the bend at the clamp is one of 40 "
                 "elements long",
          .judged_from = 40,
          .claimed = {},
          .reference = height_over_width,
          .measure = bent_uniform,
      },
      {
          .name = "tip_load",
          .what = "clamped horizontally, weightless, a dead force down on its tip",
          .source = "Bisshopp & Drucker 1945; the planar elastica by shooting",
          .parameter = "alpha = P L^2/EI",
          .quantity = "deflection of the tip over the length",
          .range = {1e-3, 1e3},
          .quick = {{1, 10}, {10, 20}},
          .usual = {{0.1, 1, 2, 5, 10, 50}, {5, 10, 20, 40}},
          .full = {{0.1, 0.5, 1, 2, 3, 5, 7, 10, 20, 50, 100}, {5, 10, 20, 40, 80}},
          .tolerance = 0.01,
          .why = "as the cantilever under its weight",
          .judged_from = 20,
          .claimed = {"super_helix", "super_clothoid", "der", "corde", "dynamic_spline"},
          .reference = deflection,
          .measure = bent_by_force,
      },
  };
}

}  // namespace tress::experiments::validation
