#include <algorithm>
#include <cmath>
#include <map>
#include <string>

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
      // As Finalists::tied: poorly repeatable times widen the tie.
      const double tie = std::max(
          toss_up, 1 + (row.has("time_scatter") ? row.number("time_scatter") : 0));
      worst.cheaper = std::min(worst.cheaper, tie * row.number("wall_s_per_sim_s") /
                                                  winner.number("wall_s_per_sim_s"));
    }
  }
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
            ": least time of what meets a winner's target, with its tie, over "
            "the winner's (below 1: the machine was busy meanwhile)",
        worst.cheaper);
  }
}

}  // namespace tress::experiments::cost_of_accuracy
