#include "simulation/scene_changes/element_unit.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "contract/decimal.h"
#include "contract/input_error.h"
#include "simulation/scene/strand_tables.h"

namespace tress::simulation {
namespace {

constexpr int largest_unit = 1000;

/// A point is at the end of an element up to this, over the length.
constexpr double coincident = 1e-9;

int unit_of(double share, const std::string& place) {
  for (int n = 1; n <= largest_unit; ++n) {
    if (std::abs(n * share - std::round(n * share)) <= n * coincident) return n;
  }
  throw InputError(
      fmt::format(
          "a point at {:.9g}, which is the end of none of up to {} equal elements", share,
          largest_unit),
      place, "give a fraction such as 0.25, or one with more digits");
}

/// The shares of the length that a table names, as "tip", "root" or a number.
int unit_of(std::string_view at, const std::string& place) {
  const auto share = decimal(at);
  return share ? unit_of(*share, place) : 1;
}

}  // namespace

int element_unit(const Scene& scene) {
  if (scene.tables == nullptr) return 1;
  const StrandTables& tables = *scene.tables;
  int unit = 1;
  const auto add = [&](std::string_view at, const std::string& place) {
    unit = std::lcm(unit, unit_of(at, place));
    refuse_if(unit > largest_unit,
              fmt::format("points of a strand at the ends of {} equal elements", unit),
              place, "give points at fractions with a smaller common denominator");
  };
  for (const Table& support : tables.supports) {
    add(support.values().word("at"), support.place("at"));
  }
  for (const Table& joint : tables.joints) {
    for (const char* key : {"a", "b"}) {
      add(names_of(joint.values().word(key)).back(), joint.place(key));
    }
  }
  for (const Table& moment : tables.driven.moments) {
    unit = std::lcm(unit, unit_of(moment.values().number("at"), moment.place("at")));
  }
  if (unit == 1) return unit;
  for (const StrandSource& source : tables.sources) {
    const Parameters& p = source.table.values();
    const bool by_file = source.groom && !p.word("file").empty();
    const bool equal =
        p.number("grading") == 1 && (source.groom ? !by_file || p.word("mesh") == "equal"
                                                  : p.word("mesh") == "grading");
    refuse_if(
        !equal, "a point inside a strand whose elements are not equal",
        source.table.place(),
        "take equal elements: leave out grading and mesh, or give mesh = \"equal\" for "
        "a file");
  }
  return unit;
}

}  // namespace tress::simulation
