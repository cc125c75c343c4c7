#include <algorithm>
#include <string>

#include "experiments/hard_cases/hard_case.h"
#include "experiments/hard_cases/hard_cases.h"

namespace tress::experiments::hard_cases {
namespace {

/// Time of failure, or the measure, in the named column.
struct Known {
  std::string_view column;
  KnownLimit known;
};

constexpr Known limits[] = {
    {"t_s",
     {"long_curl", 0.033, 0.034,
      "one curvature near the root swings two metres of curls farther than they fall in "
      "a step: the first is solved short and made longer, of the second no solution is "
      "found"}},
    {"t_s",
     {"cone", 0, 0,
      "what sticks below 1 mm/s turns round within one of Newton's steps at 0.3 m/s: no "
      "solution of the first step"}},
    {"measure",
     {"million_steps", 0.2, 0.22,
      "backward_euler keeps no momentum: in its first steps of 1/30 s it gains a fifth, "
      "the same after 5000 steps as after a million"}},
};

const Known* limit_of(std::string_view hard) {
  const auto found = std::ranges::find(
      limits, hard, [](const Known& limit) { return limit.known.claim; });
  return found == std::end(limits) ? nullptr : &*found;
}

const Row* claimed(const std::vector<Row>& rows, std::string_view hard) {
  const std::string step(Row().set("dt_s", 1.0 / 30).text("dt_s"));
  const auto found = std::ranges::find_if(rows, [&](const Row& row) {
    return row.text("case") == hard && row.text("model") == "super_helix" &&
           row.text("variant") == "tangent=exact" &&
           row.text("integrator") == "backward_euler" && row.text("dt_s") == step;
  });
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace

void check_hard_cases(const std::vector<Row>& rows, Verdicts& verdicts) {
  const auto missing = std::ranges::count_if(
      rows, [](const Row& row) { return row.text("outcome").empty(); });
  verdicts.check("every cell has an outcome", missing == 0, static_cast<double>(missing));
  for (const HardCase& hard : hard_case_catalogue()) {
    std::string claim = std::string(hard.name) +
                        ": super_helix, exact tangent, backward_euler passes at 1/30 s";
    const Row* row = claimed(rows, hard.name);
    if (row == nullptr) {
      verdicts.not_judged(std::move(claim));
      continue;
    }
    if (row->text("outcome") == "refused") continue;  // its kinematics does not admit it
    const bool held = row->text("passed") == "true";
    if (!held) claim += "; " + std::string(row->text("why"));
    if (const Known* limit = limit_of(hard.name)) {
      verdicts.check_known(std::move(claim), held, row->number(limit->column),
                           limit->known);
    } else {
      verdicts.check(std::move(claim), held, row->number("measure"));
    }
  }
}

}  // namespace tress::experiments::hard_cases
