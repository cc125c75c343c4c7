#include "experiments/hard_cases/claims.h"

#include <algorithm>
#include <string>

namespace tress {

void check_hard_cases(const std::vector<Row>& rows, Verdicts& verdicts) {
  const auto missing = std::ranges::count_if(
      rows, [](const Row& row) { return row.text("outcome").empty(); });
  verdicts.check("every cell has an outcome", missing == 0, static_cast<double>(missing));
  for (const Row& row : rows) {
    if (row.text("model") != "super_helix" || row.text("variant") != "tangent=exact" ||
        row.text("integrator") != "backward_euler") {
      continue;
    }
    if (row.text("dt_s") != Row().set("dt_s", 1.0 / 30).text("dt_s")) continue;
    if (row.text("outcome") == "refused") continue;  // its kinematics does not admit it
    std::string claim = std::string(row.text("case")) +
                        ": super_helix, exact tangent, backward_euler passes at 1/30 s";
    const bool held = row.text("passed") == "true";
    if (!held) claim += "; " + std::string(row.text("why"));
    verdicts.check(std::move(claim), held, row.number("measure"));
  }
}

}  // namespace tress
