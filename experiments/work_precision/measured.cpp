#include "experiments/problems/reference.h"
#include "experiments/work_precision/work_precision.h"

namespace tress::experiments::work_precision {

void set_counts(const Stats& stats, Row& row) {
  row.set("steps", stats.steps).set("rejected", stats.rejected);
  row.set("residuals", stats.residuals).set("linearizations", stats.linearizations);
  row.set("solves", stats.solves);
}

void set_error(double relative, double gap, Row& row) {
  row.set("error_rel", relative).set("reference_gap", gap);
  row.set("below_reference", relative < ReferenceGap::margin * gap);
}

void set_time(double wall, double simulated, Row& row) {
  row.set("wall_s", wall).set("wall_s_per_sim_s", wall / simulated);
}

}  // namespace tress::experiments::work_precision
