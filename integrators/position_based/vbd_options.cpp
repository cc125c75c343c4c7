#include "integrators/position_based/vbd_options.h"

#include <algorithm>

#include "contract/input_error.h"

namespace tress::integrators {

DescentChoice descent_choice(const Parameters& chosen) {
  const std::string_view second = chosen.word("second_derivatives");
  const int anderson = chosen.knows("anderson") ? chosen.whole("anderson") : 0;
  if (chosen.number("chebyshev") > 0 && anderson > 0) {
    throw InputError("both accelerations of the sweeps are chosen",
                     "options chebyshev and anderson", "set one of them to 0");
  }
  return {.sweeps = chosen.whole("sweeps"),
          .sweep_order = std::string(chosen.word("sweep_order")),
          .block = chosen.whole("block"),
          .curvature = second == "exact"       ? Curvature::exact
                       : second == "majorised" ? Curvature::majorised
                                               : Curvature::none,
          .chebyshev = chosen.number("chebyshev"),
          .anderson = anderson};
}

Start start_choice(const Parameters& chosen) {
  return chosen.word("start") == "adaptive" ? Start::adaptive : Start::inertial;
}

bool has_rigid_rows(const ComplianceForm& form) {
  return std::ranges::any_of(form.blocks(), [](const ComplianceForm::Block& block) {
    const auto* const end = block.alpha.begin() + block.rows;
    return std::find(block.alpha.begin(), end, 0.0) != end;
  });
}

}  // namespace tress::integrators
