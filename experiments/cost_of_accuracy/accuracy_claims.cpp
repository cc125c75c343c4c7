#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "experiments/cost_of_accuracy/cost_of_accuracy.h"
#include "experiments/cost_of_accuracy/finalists.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

/// Comparisons with NaN must not pass.
double shown(double value) { return std::isfinite(value) ? value : never; }

struct Worst {
  double refined = 0;      // error against the finer reference over target
  double margin = 0;       // of the neighbours
  double cheaper = never;  // wall time of a run that meets a winner's target, over the
                           // winner's
};

bool meets(const Row& row, const Row& winner) {
  const double judged = std::max(
      row.number("error_rel"), row.number("error_neighbours_rel") / neighbour_allowance);
  return row.ok() && row.text("scene") == winner.text("scene") &&
         judged + row.number("reference_gap") <= winner.number("target_error_rel");
}

/// Checks every model and target, over the scenes where both sides have a run and the
/// search came to its end. An incomplete search may have tried an option on one side
/// only.
void check_control(const std::vector<Row>& rows, Verdicts& verdicts) {
  struct Factors {
    double logarithms = 0, largest = 0;
    int scenes = 0;
  };
  std::map<std::pair<std::string, double>, Factors> all;
  for (const Row& row : rows) {
    if (row.text("kind") != "by_tolerance" || !row.ok() || !row.has("cost_factor"))
      continue;
    if (row.text("search").find("cut") != row.text("search").npos) continue;
    const double factor = row.number("cost_factor");
    Factors& of = all[{std::string(row.text("model")), row.number("target_error_rel")}];
    of.logarithms += std::log(factor);
    of.largest = std::max(of.largest, factor);
    ++of.scenes;
  }
  for (const auto& [key, of] : all) {
    const std::string what = fmt::format(
        "{}, error {}, {} scenes: time of the best run with error control "
        "over the best without",
        key.first, key.second, of.scenes);
    verdicts.figure(what + ", geometric mean", std::exp(of.logarithms / of.scenes));
    verdicts.figure(what + ", largest", of.largest);
  }
}

}  // namespace

void check_accuracy_claims(const std::vector<Row>& rows, Verdicts& verdicts) {
  std::map<std::string, Worst> scenes;
  for (const Row& winner : rows) {
    if (winner.text("kind") != "winner" || !winner.ok()) continue;
    Worst& worst = scenes[std::string(winner.text("scene"))];
    if (winner.has("refined_gap")) {
      worst.refined = std::max(worst.refined, shown(winner.number("error_refined_rel") /
                                                    winner.number("target_error_rel")));
    }
    worst.margin = std::max(worst.margin, shown(winner.number("margin")));
    for (const Row& row : rows) {
      if (row.text("kind") == "as_given" || !meets(row, winner)) continue;
      const double tied = tie(row.has("time_scatter") ? row.number("time_scatter") : 0);
      worst.cheaper = std::min(worst.cheaper, tied * row.number("wall_s_per_sim_s") /
                                                  winner.number("wall_s_per_sim_s"));
    }
  }
  check_control(rows, verdicts);
  for (const auto& [scene, worst] : scenes) {
    // Advice runs without a refined reference to answer sooner.
    if (worst.refined > 0) {
      verdicts.check(scene +
                         ": winners keep their error with the reference refined once "
                         "more (largest error over target)",
                     worst.refined <= 1, worst.refined);
    }
    verdicts.check(scene +
                       ": neighbours of winners are within 1.5 times the target (largest "
                       "margin)",
                   worst.margin <= neighbour_allowance, worst.margin);
    // Two times on a loaded machine may differ by more than both scatters: no verdict.
    verdicts.figure(
        scene +
            ": time of the cheapest other run within the target over the "
            "winner's, times the tie that is allowed (below 1: the machine was busy)",
        worst.cheaper);
  }
}

}  // namespace tress::experiments::cost_of_accuracy
