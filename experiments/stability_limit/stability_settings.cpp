#include <fmt/format.h>

#include <algorithm>

#include "contract/input_error.h"
#include "experiments/stability_limit/stability_limit.h"

namespace tress::experiments::stability_limit {
namespace {

constexpr Parameter settings_of_rows[] = {
    {.name = "study", .help = "rows of one study", .choices = "all|grid|tolerance|nodal"},
    {.name = "scene",
     .help = "rows of one scene",
     .choices = "all|release|compress|shake|shake_rotate|curl_drop|whip|swing"},
    {.name = "damping",
     .help = "rows of one level of internal friction: 0, 1e-12 or 1e-10 kg m^3/s",
     .choices = "all|none|light|published"},
    {.name = "solver",
     .help = "rows of one solver of the model",
     .choices = "all|recursive|composite|sparse|recursive_plain"},
    {.name = "jacobian",
     .help = "rows of one Jacobian of the model",
     .choices = "all|elastic|exact|elastic_local"},
    {.name = "modes",
     .help = "modes of the strands",
     .choices = "bend_twist|bend|bend_planar"},
    {.name = "cap_s", .help = "largest step tried (s)", .number = 0.1, .min = 1e-9},
    {.name = "floor_s",
     .help = "smallest step tried (s), 0: 1e-6, of study nodal 1e-7",
     .number = 0,
     .min = 0},
    {.name = "depth",
     .help = "test below a stable step until this factor is stable, 0: 30, with --quick "
             "10, of study nodal 1",
     .number = 0,
     .min = 0},
    {.name = "resolution",
     .help = "bisect until unstable over stable step is this",
     .number = 1.05,
     .min = 1.0001},
    {.name = "scenes", .help = "scene files instead of our scenes", .text = true},
    {.name = "horizon_s",
     .help =
         "simulated time (s) of study nodal; of a scene file the least time, at most "
         "the scene's. A step of a scene file is judged over five times the duration, as "
         "far as 2000 steps reach. 0: 0.5, of study nodal 1, with --quick 0.25, "
         "explicit methods 0.02",
     .number = 0,
     .min = 0,
     .max = 1e3},
    {.name = "strands",
     .help = "number of typical strands of a scene file whose strands do not touch",
     .number = 8,
     .min = 1,
     .max = 1e4,
     .whole = true},
    {.name = "row_work",
     .help = "work of the search for one row (max_work), of a scene file also of each of "
             "its checks. 0: 2e7, with --quick 3e6, with "
             "--full 1e8. Of study tolerance: 1e8, with --quick 3e7, with --full 3e8. Of "
             "study nodal: 1e9, with --quick 1.5e8",
     .number = 0,
     .min = 0},
};

}  // namespace

std::span<const Parameter> stability_settings() { return settings_of_rows; }

double set_or(const Parameters& rows, std::string_view key, double usual) {
  return rows.number(key) > 0 ? rows.number(key) : usual;
}

StepSearch step_search(const Parameters& rows, double finest, double depth) {
  const StepSearch search{.coarsest = rows.number("cap_s"),
                          .finest = set_or(rows, "floor_s", finest),
                          .resolution = rows.number("resolution"),
                          .depth = std::max(set_or(rows, "depth", depth), 1.0)};
  if (search.finest <= search.coarsest) return search;
  throw InputError(
      fmt::format("the smallest step tried, {:g} s, is longer than the largest, {:g} s",
                  search.finest, search.coarsest),
      "--set floor_s, cap_s", "give floor_s <= cap_s");
}

StepSearch up_to(double coarsest, StepSearch search) {
  search.coarsest = std::min(search.coarsest, coarsest);
  search.finest = std::min(search.finest, search.coarsest);
  return search;
}

}  // namespace tress::experiments::stability_limit
