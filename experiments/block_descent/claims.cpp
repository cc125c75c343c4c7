#include <algorithm>
#include <cmath>

#include "experiments/block_descent/block_descent.h"

namespace tress::experiments::block_descent {
namespace {

bool without(const Row& row, std::string_view acceleration) {
  return !row.has(acceleration) || row.text(acceleration) == "0";
}

/// The row of the swinging springs by this method at 20 sweeps with default penalties, a
/// node or all at a time.
const Row* usual(const std::vector<Row>& rows, std::string_view integrator,
                 std::string_view block, std::string_view sweeps) {
  const auto found = std::ranges::find_if(rows, [&](const Row& row) {
    return row.ok() && row.text("part") == "sweeps" &&
           row.text("model") == "mass_spring" && row.text("integrator") == integrator &&
           row.text("block") == block && row.text("sweeps") == sweeps &&
           without(row, "chebyshev") && without(row, "anderson");
  });
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace

void judge(const std::vector<Row>& rows, Verdicts& verdicts) {
  const auto check = [&](const Claim& claim, const Row* row, auto holds) {
    if (row == nullptr || !row->has("direct_distance_rel")) {
      verdicts.not_judged(claim);
      return;
    }
    const double distance = row->number("direct_distance_rel");
    verdicts.check(claim, holds(distance), distance);
  };
  check({"node by node, 20 sweeps end 10 % of the length or more from the direct step",
         "nodes_lock"},
        usual(rows, "vbd", "1", "20"), [](double x) { return x >= 0.1; });
  check({"node by node with multipliers, 20 sweeps end within 1 % of the length",
         "multipliers_free"},
        usual(rows, "vbd_augmented", "1", "20"), [](double x) { return x <= 0.01; });
  check({"the whole strand as one block, 5 sweeps end within 1e-5 of the length",
         "whole_strand_converges"},
        usual(rows, "vbd", "0", "5"), [](double x) { return x <= 1e-5; });
  int points = 0, reached = 0;
  for (const Row& row : rows) {
    if (row.text("part") != "rods") continue;
    ++points;
    if (row.ok() && row.text("within_1_percent") == "true") ++reached;
  }
  verdicts.figure("points of the map of stable_cosserat_rods", points);
  verdicts.figure("points of this map within 1 % of the rod", reached);
}

}  // namespace tress::experiments::block_descent
