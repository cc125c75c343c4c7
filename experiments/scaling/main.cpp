// What does a step cost against the number of elements: by solver, by Jacobian, by modes,
// and on trees? Beside the published table of frames per second.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/numerics/stability.h"
#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/run/advised.h"
#include "experiments/run/experiment.h"
#include "experiments/run/machine.h"
#include "experiments/scaling/scaling.h"
#include "simulation/files/parse.h"
#include "simulation/run/timing.h"

namespace tress::experiments::scaling {
namespace {

constexpr Column columns[] = {
    {"structure", "straight strand, kind of tree, or scene file"},
    {"model", "catalogue id"},
    {"solver", "linear solver of the model for S x = b; head: SIMD lanes of a batch"},
    {"jacobian", "terms of S (Jacobian approximation)"},
    {"modes", "unknowns per element"},
    {"grows",
     "quantity that the series increases, for a scene file: elements or strands"},
    {"elements", "number of elements; for a scene file, of each strand"},
    {"strands", "number of strands, for a scene file"},
    {"unknowns", "number of coordinates"},
    {"device",
     "device that took the steps, for a scene file as a batch: a GPU or cpu; why "
     "not a GPU"},
    {"cost_per_step_s",
     "wall time of a linearly implicit step of the released strand, or of the scene",
     true},
    {"cost_per_element_step_s", "wall time of a step over the number of elements", true},
    {"exponent", "p of cost ~ N^p of the series: N elements from 20 on, or strands",
     true},
    {"dt_max_s", "largest stable step up to a frame, 1/30 s; solvers share it"},
    {"fps", "frames of 1/30 s computed per second with that step", true},
    {"published_fps", "published frames per second, on hardware of 2008: compare ratios"},
};

constexpr double frame = 1.0 / 30;  // s
constexpr double t_end = 1;         // s, of a judged run

/// A strand some steps into its motion, computed with the cheapest solver.
struct Moving {
  double t;  // s
  State state;
};

Options step_of(double h, System& system) {
  Options options;
  options.step = h;
  options.formulation =
      usable_formulations(find_integrator("linearly_implicit_euler"), system).front();
  return options;
}

Moving moving(const ScalingCase& c, const Parameters& parameters) {
  Parameters cheapest = parameters;
  set_known(cheapest, {{"solver", first_word(*c.model, "solver")}});
  if (has_word(*c.model, "jacobian", "elastic")) cheapest.set("jacobian", "elastic");
  const auto system = c.model->make(cheapest);
  constexpr double t = 0.05;
  Simulation run = simulate("linearly_implicit_euler", *system,
                            step_of(timed_step, *system), initial_state(*system), t);
  return {t, std::move(run.state)};
}

/// Wall time (s) of a step: batches of about 2 ms, repeated for `time_s` or `repeat`
/// times, whichever is longer.
double step_cost(System& system, const Moving& from, double time_s, int repeat) {
  constexpr double batch_s = 2e-3;
  const auto method =
      make_integrator("linearly_implicit_euler", system, step_of(timed_step, system));
  const auto run = [&](long steps) {
    Status s = method->start(from.t, from.state.q, from.state.v);
    if (s == Status::ok) {
      s = method->advance(from.t + static_cast<double>(steps) * timed_step);
    }
    if (s != Status::ok) throw std::runtime_error(method->failure());
  };
  const double one = time_it(1, [&] { run(1); }).median_s;
  const long steps = std::clamp(std::lround(batch_s / one), 1L, 2000L);
  const double batch = one * static_cast<double>(steps);
  const int batches = std::clamp(static_cast<int>(time_s / batch), repeat, 1000);
  return time_it(batches, [&] { run(steps); }).median_s / static_cast<double>(steps);
}

/// The largest stable step of the release, searched with the recursion: all solvers
/// solve the same equations (stability_limit shows it).
StepLimit largest_step(const ScalingCase& c, const Parameters& parameters) {
  Parameters cheapest = parameters;
  set_known(cheapest, {{"solver", first_word(*c.model, "solver")}});
  const auto system = c.model->make(cheapest);
  const State start = perturbed_start(*system);
  const StabilityBounds bounds =
      c.structure == straight
          ? stability_bounds(find_strand_scene("release"), cheapest, *system)
          : release_bounds(*system, start, t_end);
  constexpr double most_work = 1e9;
  StabilityRuns tried("linearly_implicit_euler", *system, step_of(frame, *system), start,
                      t_end, bounds, most_work);
  return find_step_limit({.coarsest = frame}, [&](double dt) -> std::optional<Broken> {
    const auto run = tried.judge(dt);
    return run ? std::optional(run->broken) : std::nullopt;
  });
}

struct Work {
  ScalingCase which;
  Parameters parameters;
  double time_s;
  int repeat;
};

void measure(const Work& work, Row& row) {
  const ScalingCase& c = work.which;
  const auto system = c.model->make(work.parameters);
  row.set("unknowns", system->layout().coordinates);
  const double cost =
      step_cost(*system, moving(c, work.parameters), work.time_s, work.repeat);
  row.set("cost_per_step_s", cost).set("cost_per_element_step_s", cost / c.elements);
  if (const auto seed = c.published_fps()) row.set("published_fps", *seed);
  if (!c.in_seed_table()) return;

  const StepLimit limit = largest_step(c, work.parameters);
  if (!limit.resolved) {
    row.failed("gave_up", "no largest stable step was found in the work of a row");
    return;
  }
  const double steps = std::ceil(frame / limit.stable - 1e-9);
  row.set("dt_max_s", limit.stable).set("fps", 1 / (steps * cost));
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, scaling_settings());
  const std::string_view files = settings.experiment().word("scenes");
  const DeviceChoice device = device_choice(settings.experiment().word("device"));
  if (!files.empty()) {
    const std::vector<std::string> list = listed_files(files, "scenes");
    return device == DeviceChoice::cpu ? scene_costs(line, list)
                                       : head_costs(line, list, device);
  }
  if (device != DeviceChoice::cpu) {
    throw InputError("a device steps batches only, and these are single strands",
                     line.place("device"), "give --scene groom.toml, or --device cpu");
  }
  const double chosen = settings.experiment().number("row_s");
  const double time_s = chosen > 0 ? chosen : line.quick ? 0.02 : 1;
  std::vector<Case> all;
  for (const ScalingCase& c : scaling_cases(line, settings)) {
    const Work work{c, c.parameters(settings), time_s, line.repeat};
    all.push_back(
        {c.identity(), [work](Row& row, const Deadline&) { measure(work, row); }});
  }
  return all;
}

constexpr OwnOption command_options[] = {
    {"scene", "scenes",
     "your own scene (several: a.toml,b.toml) instead of the built-in ones", true},
    {"device", "device",
     "gpu or auto: your scene as a batch, by a GPU (default cpu: strand by "
     "strand)"},
};

/// The cost of a step at the largest size of each series of a scene, and how it grows.
void answer(const CommandLine& line, const std::vector<Row>& rows) {
  const auto size = [](const Row& row) {
    return row.number("elements") * row.number("strands");
  };
  std::map<std::string, const Row*> largest;
  for (const Row& row : rows) {
    if (!row.ok()) continue;
    const std::string series = fmt::format("{}, {}, more {}", row.text("structure"),
                                           row.text("model"), row.text("grows"));
    const Row*& so_far = largest[series];
    if (so_far == nullptr || size(row) > size(*so_far)) so_far = &row;
  }
  std::vector<std::string> lines;
  for (const auto& [series, row] : largest) {
    lines.push_back(fmt::format(
        "{}: a step of {} strand{} of {} elements takes {:.3g} us{}", series,
        row->text("strands"), row->number("strands") == 1 ? "" : "s",
        row->text("elements"), 1e6 * row->number("cost_per_step_s"),
        row->has("exponent")
            ? fmt::format(", and grows with the power {:.2f}", row->number("exponent"))
            : ""));
  }
  if (const auto doubt = timing_doubt()) lines.push_back(*doubt);
  print_answer(line, lines);
}

/// A model that cannot represent the scene of a file.
bool finding(const Row& row) { return row.status() == "refused"; }

constexpr Unused unused[] = {
    {"integrators", "steps are those of linearly_implicit_euler"}, not_random};

}  // namespace
}  // namespace tress::experiments::scaling

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::scaling;
  const Experiment experiment{
      .name = "scaling",
      .question = "what does a step cost against the number of elements?",
      .example = "--elements 20,100 --set solver=recursive",
      .sizes = {"415 rows of short runs, 50 s", "425 rows, the largest too"},
      .columns = columns,
      .settings = scaling_settings(),
      .options = command_options,
      .unused = unused,
      .cases = cases,
      .derive = add_exponents,
      .checks = tell_scaling_figures,
      .finding = finding,
      .conclude = answer};
  return run_experiment(experiment, argc, argv);
}
