#include "experiments/divided_heads/predictions.h"

#include <algorithm>

#include "experiments/divided_heads/cost_model.h"

namespace tress::experiments::divided_heads {
namespace {

bool touch(const Row& row) { return row.text("effects") == "interaction"; }

std::vector<Measurement> measured(const std::vector<Row>& rows) {
  std::vector<Measurement> all;
  for (const Row& row : rows) {
    if (!row.ok() || row.text("kind") != "measured") continue;
    const double ranks = row.number("ranks"), strands = row.number("strands");
    all.push_back({.touch = touch(row),
                   .strands = strands,
                   .ranks = ranks,
                   .beside = row.number("beside"),
                   .cost = row.number("cost_per_step_s"),
                   .ghosts = row.has("ghosts_per_strand")
                                 ? row.number("ghosts_per_strand") * strands / ranks
                                 : 0});
  }
  return all;
}

}  // namespace

void add_predictions(std::vector<Row>& rows) {
  const auto models = fit_cost(measured(rows));
  if (!models) return;
  for (Row& row : rows) {
    if (!row.ok()) continue;
    const CostModel& model = touch(row) ? models->touching : models->apart;
    const double strands = row.number("strands"), ranks = row.number("ranks");
    double cost = model.cost(strands, ranks);
    if (row.text("kind") == "measured") {
      if (row.number("beside") > 1) cost *= model.busy;
      cost *= std::max(1.0, ranks / row.number("cores"));
      row.set("model_off_rel", cost / row.number("cost_per_step_s") - 1);
    }
    row.set("model_cost_per_step_s", cost);
    row.set("model_ghosts_per_strand", model.ghosts(strands, ranks) * ranks / strands);
    row.set("efficiency", model.efficiency(strands, ranks));
  }
}

}  // namespace tress::experiments::divided_heads
