#include <algorithm>
#include <string>

#include "experiments/adaptive_mesh/adaptive_mesh.h"

namespace tress::experiments::adaptive_mesh {

void judge(const std::vector<simulation::Row>& rows, Verdicts& verdicts) {
  constexpr double worthwhile = 1.5;
  for (const std::string_view part : {"limit", "elements"}) {
    int all = 0, anew = 0, following = 0;
    for (const simulation::Row& row : rows) {
      if (row.text("part") != part || !row.ok() || !row.has("gain")) continue;
      ++all;
      anew += row.number("gain") >= worthwhile ? 1 : 0;
      following += row.number("gain_following") >= worthwhile ? 1 : 0;
    }
    const std::string what =
        part == "limit" ? "scenes, limit of many elements" : "pairs of scene and target";
    const std::string key(part);
    verdicts.figure({what, key}, all);
    verdicts.figure({what + ": remeshing gains a factor of 1.5", key + "_remeshed"},
                    anew);
    verdicts.figure(
        {what + ": numbers of elements that follow the motion gain a factor of 1.5",
         key + "_following"},
        following);
  }
  int hairs = 0, within = 0, by_half = 0, by_pilot = 0, at_worst = 0;
  for (const simulation::Row& row : rows) {
    if (!row.ok() || !row.has("tip_error_rel") || !row.has("tolerance_rel")) continue;
    const int holds = row.number("tip_error_rel") <= judged_tolerance ? 1 : 0;
    if (row.text("part") == "pilot") {
      by_pilot += holds;
      at_worst += row.number("largest_error_rel") <= judged_tolerance ? 1 : 0;
    } else if (row.number("tolerance_rel") == judged_tolerance) {
      ++hairs;
      within += holds;
    } else {
      by_half += holds;
    }
  }
  if (hairs == 0) return;
  verdicts.figure({"released hairs", "hairs"}, hairs);
  verdicts.figure(
      {"released hairs within the tolerance of their mesh at rest", "hairs_at_rest"},
      within);
  verdicts.figure({"released hairs within the tolerance, meshed at rest for half of it",
                   "hairs_half"},
                  by_half);
  verdicts.figure(
      {"released hairs within the tolerance, meshed by a pilot run", "hairs_pilot"},
      by_pilot);
  constexpr double bar = 0.95;
  verdicts.check(
      {"a pilot run keeps the tolerance at all joints and frames on 95 % of hairs",
       "hairs_pilot_always"},
      at_worst >= bar * hairs, at_worst);
}

}  // namespace tress::experiments::adaptive_mesh
