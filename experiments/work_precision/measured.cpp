#include "experiments/problems/reference.h"
#include "experiments/work_precision/work_precision.h"

namespace tress::experiments::work_precision {

void set_counts(const Stats& stats, Row& row) {
  row.set("steps", stats.steps).set("rejected", stats.rejected);
  row.set("residuals", stats.residuals).set("linearizations", stats.linearizations);
  row.set("solves", stats.solves);
  if (stats.smallest_step == 0) return;
  row.set("rejected_by_error", stats.rejected_by_error);
  row.set("rejected_by_newton", stats.rejected_by_newton);
  row.set("smallest_step_s", stats.smallest_step);
}

std::span<const double> tolerances(const CommandLine& line) {
  static constexpr double all[] = {1e-2, 3e-3, 1e-3, 3e-4, 1e-4};
  static constexpr double few[] = {1e-2, 1e-3, 1e-4};
  return line.quick ? std::span<const double>(few) : all;
}

void set_drive(const Options& options, bool adaptive, Row& row) {
  if (options.tolerance > 0) {
    row.set("position_tol_rel", options.tolerance);
  } else if (adaptive) {
    row.set("rtol", options.rtol);
  } else {
    row.set("dt_s", options.step);
  }
}

void set_achieved(double largest, const Options& options, Row& row) {
  if (options.tolerance > 0) row.set("error_over_tolerance", largest / options.tolerance);
}

void set_error(double relative, double gap, Row& row) {
  row.set("error_rel", relative).set("reference_gap", gap);
  row.set("below_reference", relative < ReferenceGap::margin * gap);
}

void set_time(double wall, double simulated, Row& row) {
  row.set("wall_s", wall).set("wall_s_per_sim_s", wall / simulated);
}

}  // namespace tress::experiments::work_precision
