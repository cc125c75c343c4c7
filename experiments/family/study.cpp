#include "experiments/family/study.h"

#include <array>

namespace tress::family {

std::span<const Study> studies() {
  static const std::array all{stable_steps, twist, bdf_order, equal_accuracy};
  return all;
}

Row answer(Row row, const Claim& claim, double value, bool holds) {
  return row.set("claim", claim.id).set("value", value).set("holds", holds);
}

Row no_answer(Row row, const Claim& claim, std::string_view status,
              std::string_view reason) {
  return row.set("claim", claim.id).failed(status, reason);
}

}  // namespace tress::family
