#include "experiments/divided_heads/predictions.h"

#include <map>
#include <optional>

#include "experiments/divided_heads/cost_model.h"

namespace tress::experiments::divided_heads {
namespace {

bool touch(const Row& row) { return row.text("effects") == "interaction"; }

bool is_measured(const Row& row) { return row.text("kind") == "measured"; }

Measurement measurement(const Row& row) {
  const double ranks = row.number("ranks"), strands = row.number("strands");
  return {.touch = touch(row),
          .strands = strands,
          .ranks = ranks,
          .beside = row.number("beside"),
          .cores = row.number("cores"),
          .cost = row.number("cost_per_step_s"),
          .ghosts = row.has("ghosts_per_strand")
                        ? row.number("ghosts_per_strand") * strands / ranks
                        : 0};
}

double off(const CostModels& models, const Measurement& m) {
  return predicted(models, m) / m.cost - 1;
}

}  // namespace

void add_predictions(std::vector<Row>& rows) {
  std::vector<Measurement> all;
  for (const Row& row : rows) {
    if (row.ok() && is_measured(row)) all.push_back(measurement(row));
  }
  const auto models = fit_cost(all);
  if (!models) return;
  std::map<double, std::optional<CostModels>> without;  // heads of that many hairs
  for (const Measurement& m : all) {
    if (without.contains(m.strands)) continue;
    std::vector<Measurement> others = all;
    std::erase_if(others, [&](const Measurement& o) { return o.strands == m.strands; });
    without[m.strands] = fit_cost(others);
  }
  for (Row& row : rows) {
    if (!row.ok()) continue;
    const CostModel& model = touch(row) ? models->touching : models->apart;
    const double strands = row.number("strands"), ranks = row.number("ranks");
    double cost = model.cost(strands, ranks);
    if (is_measured(row)) {
      const Measurement m = measurement(row);
      cost = predicted(*models, m);
      row.set("model_off_rel", off(*models, m));
      if (const auto& others = without[strands]) {
        row.set("held_out_off_rel", off(*others, m));
      }
    }
    row.set("model_cost_per_step_s", cost);
    row.set("model_ghosts_per_strand", model.ghosts(strands, ranks) * ranks / strands);
    row.set("efficiency", model.efficiency(strands, ranks));
  }
}

}  // namespace tress::experiments::divided_heads
