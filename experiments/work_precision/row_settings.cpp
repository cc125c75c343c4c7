#include "experiments/work_precision/work_precision.h"

namespace tress::experiments::work_precision {
namespace {

constexpr Parameter settings_of_rows[] = {
    {.name = "scene",
     .help = "rows of one problem or strand",
     .choices = "all|pendulum|pendulum_constrained|double_pendulum|chain_10|"
                "andrews_squeezer|slider_crank|car_axis|beam|wheelset|filament|swing|"
                "strand_release"},
    {.name = "error", .help = "rows of one kind of error", .choices = "all|time|total"},
    {.name = "modes",
     .help = "rows of strands with these modes",
     .choices = "all|bend|bend_twist"},
    {.name = "solver",
     .help = "rows of one solver of the model",
     .choices = "all|recursive|composite|sparse"},
    {.name = "jacobian",
     .help = "rows of one Jacobian of the model",
     .choices = "all|elastic|exact"},
    {.name = "scenes", .help = "scene files instead of our problems", .text = true},
    {.name = "horizon_s",
     .help = "simulated time of a scene file, at most the scene's (s)",
     .number = 0.5,
     .min = 1e-3,
     .max = 1e3},
    {.name = "strands",
     .help = "number of typical strands of a scene file whose strands do not touch",
     .number = 1,
     .min = 1,
     .max = 1e4,
     .whole = true},
    {.name = "row_work",
     .help = "work of one run of a scene file (max_work), 0: 1e7, with --quick 1e6, with "
             "--full 1e8",
     .number = 0,
     .min = 0},
};

}  // namespace

std::span<const Parameter> row_settings() { return settings_of_rows; }

bool keeps(const Settings& settings, std::string_view key, std::string_view word) {
  const std::string_view chosen = settings.experiment().word(key);
  return chosen == "all" || chosen == word;
}

}  // namespace tress::experiments::work_precision
