#include <array>
#include <cmath>

#include "experiments/family/family.h"

namespace tress::experiments::family {

std::span<const Study> studies() {
  static const std::array all{stable_steps, twist,  bdf_order,       equal_accuracy,
                              tolerance,    sweeps, tolerances_study};
  return all;
}

double enough_work(System& system, double t_end, double dt) {
  constexpr double calls = 10 * (5 * 3 + 1);  // residual, matrix and solve; plus the step
  return calls * std::ceil(t_end / dt) * (system.layout().coordinates + 10);
}

Row answer(Row row, const Claim& claim, double value, bool holds) {
  return row.set("claim", claim.id).set("value", value).set("holds", holds);
}

Row no_answer(Row row, const Claim& claim, std::string_view status,
              std::string_view reason) {
  return row.set("claim", claim.id).failed(status, reason);
}

}  // namespace tress::experiments::family
