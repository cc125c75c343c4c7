#include <algorithm>
#include <string>

#include "experiments/regrading/regrading.h"

namespace tress::experiments::regrading {

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
        part == "limit" ? "scenes, for many elements" : "pairs of scene and target";
    verdicts.figure(what, all);
    verdicts.figure(what + ": gain 1.5 times by cuts anew", anew);
    verdicts.figure(what + ": gain 1.5 times by numbers that follow", following);
  }
}

}  // namespace tress::experiments::regrading
