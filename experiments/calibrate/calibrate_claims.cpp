#include <algorithm>
#include <string>

#include "experiments/calibrate/calibrate.h"
#include "experiments/calibrate/shipped_records.h"

namespace tress::experiments::calibrate {
namespace {

using calibrate::damping, calibrate::fitting;

/// Known or inside its interval.
bool holds(const Row& row, const std::string& name, const std::string& unit) {
  const double truth = row.number(name + "_true" + unit);
  return !row.has(name + "_low" + unit) || (row.number(name + "_low" + unit) <= truth &&
                                            truth <= row.number(name + "_high" + unit));
}

/// No claims about a scene or a record of the user's own.
bool is_shipped(const Row& row) {
  const auto all = shipped_records();
  return std::ranges::find(all, row.text("data"), &ShippedRecords::name) != all.end();
}

}  // namespace

void check_calibrate_claims(const std::vector<Row>& rows, Verdicts& verdicts) {
  const std::size_t before = verdicts.all().size();
  for (const Row& row : rows) {
    if (!is_shipped(row)) continue;
    if (!row.has("internal_friction_true_kg_m3_s") || row.text("model") != "super_helix")
      continue;
    const std::string what =
        std::string(row.text("data")) + ", fit of " + std::string(row.text("fit")) + ": ";
    if (row.text("integrator") != fitting) {
      if (row.text("integrator") != damping || row.text("data") != "two_lengths")
        continue;
      verdicts.check(what + "half the step detects the damping of " +
                         std::string(row.text("integrator")),
                     row.status() == "time_error", row.number("step_shift"));
    } else if (row.text("data") == "one_length" && row.text("fit") == "both") {
      verdicts.check(what +
                         "one length does not separate gamma from nu, and the row "
                         "reports it",
                     row.status() == "not_identified", row.number("correlation"));
    } else {
      verdicts.check(what + "the truth is inside the interval",
                     row.ok() && holds(row, "internal_friction", "_kg_m3_s") &&
                         holds(row, "drag", "_kg_m_s") &&
                         holds(row, "youngs_modulus", "_pa"),
                     row.number("internal_friction_kg_m3_s") /
                         row.number("internal_friction_true_kg_m3_s"));
    }
  }
  if (verdicts.all().size() == before && std::ranges::any_of(rows, is_shipped)) {
    verdicts.not_judged("fits of simulated records by super_helix find the truth");
  }
}

}  // namespace tress::experiments::calibrate
