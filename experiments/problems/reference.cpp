#include "experiments/problems/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tress::experiments {

ErrorNorms error_norms(In value, In reference, In scale) {
  if (value.size() != reference.size() ||
      (scale.size() != 1 && scale.size() != value.size())) {
    throw std::logic_error("error_norms: sizes differ");
  }
  ErrorNorms norms;
  double squares = 0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double error = std::abs(value[i] - reference[i]);
    if (!std::isfinite(error)) {
      const double infinity = std::numeric_limits<double>::infinity();
      return {infinity, infinity, infinity};
    }
    squares += error * error;
    norms.max = std::max(norms.max, error);
    norms.relative = std::max(norms.relative, error / scale[scale.size() == 1 ? 0 : i]);
  }
  if (!value.empty()) norms.rms = std::sqrt(squares / static_cast<double>(value.size()));
  return norms;
}

double scd(In value, In reference) {
  constexpr double most_digits = 16;
  if (value.size() != reference.size()) throw std::logic_error("scd: sizes differ");
  double largest = 0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (reference[i] == 0) continue;
    const double error = std::abs((value[i] - reference[i]) / reference[i]);
    if (!std::isfinite(error)) return -std::numeric_limits<double>::infinity();
    largest = std::max(largest, error);
  }
  return std::min(most_digits, -std::log10(largest));
}

ReferenceGap::ReferenceGap(In reference, In independent, In scale)
    : gap_(error_norms(reference, independent, scale).relative) {}

void ReferenceGap::mark(Row& row, double relative_error) const {
  if (!row.ok() || trusts(relative_error)) return;
  row.failed("below_reference",
             fmt::format("error {:.3g} < {} x gap {:.3g} of the references",
                         relative_error, margin, gap_));
}

}  // namespace tress::experiments
