#include <algorithm>
#include <iterator>

#include "experiments/calibrate/calibrate.h"
#include "integrators/catalogue.h"

namespace tress::experiments::calibrate {
namespace {

/// In the order of Fitted.
constexpr std::string_view fit_words[] = {
    "gamma", "nu", "both", "stiffness", "stiffness_gamma", "stiffness_nu", "all"};

void set(Row& row, const Estimate& estimate, const std::string& name,
         const std::string& unit) {
  row.set(name + unit, estimate.value);
  row.set(name + "_low" + unit, estimate.low).set(name + "_high" + unit, estimate.high);
}

/// The record that the strand would leave, simulated with half the step and twice the
/// elements, so that it is more accurate than the fit. Empty: its run fails.
Records record_of(const FitRow& work) {
  constexpr int points = 150, finer = 2;
  Records records;
  Record& record = records.all.emplace_back();
  for (int k = 1; k <= points; ++k) record.t.push_back(work.simulate->t_end * k / points);
  Watch watch = work.how;
  watch.options.step /= finer;
  std::vector<BuiltStrand> strands;
  strands.push_back(work.strands.front().build(*work.truth, finer));
  if (!fill_in(records, strands, watch, work.simulate->noise)) return {};
  return records;
}

}  // namespace

std::string_view name(Fitted fitted) {
  return fit_words[static_cast<std::size_t>(fitted) - 1];
}

Fitted fitted_of(std::string_view word) {
  const auto found = std::ranges::find(fit_words, word);
  return static_cast<Fitted>(found - std::begin(fit_words) + 1);
}

Row FitRow::identity() const {
  constexpr std::string_view axes[] = {"x", "y", "z"};
  Row row;
  row.set("data", data).set("data_hash", records->hash);
  row.set("signal", how.observed == Observed::envelope ? "envelope" : "displacement");
  row.set("axis", axes[how.axis]).set("fit", name(how.fitted)).set("model", model->id);
  row.set("integrator", how.integrator).set("elements", elements);
  row.set("confidence", how.confidence);
  return row;
}

void FitRow::measure(Row& row) const {
  const Specimen& first = strands.front();
  const BuiltStrand built = first.build(first.properties, 1);
  const std::string objection =
      refusal(find_integrator(how.integrator), *built.system, how.options.formulation);
  if (!objection.empty()) {
    row.failed("refused", objection);
    return;
  }
  if (truth) {
    row.set("internal_friction_true_kg_m3_s", truth->gamma);
    row.set("drag_true_kg_m_s", truth->nu);
    row.set("youngs_modulus_true_pa", truth->youngs_modulus);
  }
  const Records fitted = simulate ? record_of(*this) : *records;
  if (fitted.all.empty()) {
    row.failed("solver_error", "the scene's own run fails, or its tip does not swing");
    return;
  }
  const OscillationFit fit = fit_oscillation(fitted, strands, how);
  row.set("records", fitted.all.size()).set("points", fitted.points());
  set(row, fit.gamma, "internal_friction", "_kg_m3_s");
  set(row, fit.nu, "drag", "_kg_m_s");
  set(row, fit.youngs_modulus, "youngs_modulus", "_pa");
  row.set("correlation", fit.correlation).set("condition", fit.condition);
  row.set("residual_rms_m", fit.rms).set("reduced_chi2", fit.reduced_chi2);
  row.set("autocorrelation", fit.autocorrelation).set("step_shift", fit.step_shift);
  row.set("elements_shift", fit.elements_shift);
  row.set("degrees", fit.degrees).set("evaluations", fit.evaluations);
  if (fit.status != "ok") row.failed(fit.status, fit.reason);
}

}  // namespace tress::experiments::calibrate
