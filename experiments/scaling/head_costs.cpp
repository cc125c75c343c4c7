#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include "contract/input_error.h"
#include "experiments/scaling/scaling.h"
#include "simulation/head/head_classes.h"
#include "simulation/head/head_run.h"
#include "simulation/head/scene_head.h"
#include "simulation/run/timing.h"
#include "simulation/scene/strand_tables.h"

namespace tress::experiments::scaling {
namespace {

constexpr std::size_t most_of_head = 20000;  // without --full

using Outline = std::shared_ptr<const SceneOutline>;

/// Returns `count` of the scene's strands, evenly spread.
SceneOutline some_of(const SceneOutline& whole, std::size_t count) {
  std::vector<std::size_t> strands(count);
  for (std::size_t k = 0; k < count; ++k) strands[k] = k * whole.series->size() / count;
  SceneOutline some = whole;
  some.series = std::make_shared<const StrandSeries>(*whole.series, std::move(strands));
  some.scene.strands = {some.series->strand(0)};
  return some;
}

void measure(const SceneOutline& whole, DeviceChoice choice, int steps, int repeat,
             Row& row) {
  const auto strands = static_cast<std::size_t>(row.number("strands"));
  OneRank alone;
  HeadRun head(make_head(some_of(whole, strands),
                         models::widest_pack(models::HeadNumber::float64), 1),
               1, alone);
  try {
    const ChosenDevice device = choose_device(head, choice, whole.scene.name);
    row.set("device",
            device.why_not.empty() ? device.name : device.name + "; " + device.why_not);
    double t = 0;
    // Steps on a device are taken when their results are asked for.
    const double run = time_it(repeat, [&] {
                         for (int i = 0; i < steps; ++i, t += timed_step) {
                           head.step(t, timed_step);
                         }
                         head.fetch();
                       }).median_s;
    set_cost(run / steps, row);
  } catch (const InputError& no) {
    row.failed("no_device", no.what());
  } catch (const DeviceFailure& no) {
    row.failed("no_device", no.what());
  }
}

}  // namespace

std::vector<Case> head_costs(const CommandLine& line,
                             const std::vector<std::string>& files, DeviceChoice device) {
  std::vector<Case> all;
  std::set<std::string> names;
  for (const std::string& file : files) {
    const Outline whole = std::make_shared<const SceneOutline>(read_outline(file));
    if (const auto no = no_single_head(*whole)) {
      throw InputError(no->reason, file, no->remedy);
    }
    if (const auto no = no_lanes(whole->scene)) {
      throw InputError("no SIMD lanes for " + no->reason, file, no->remedy);
    }
    const std::string name = std::filesystem::path(file).filename().string();
    if (!names.insert(name).second) {
      throw InputError("two scenes of one name", file, "rename one of them");
    }
    const std::size_t strands =
        line.full ? whole->series->size() : std::min(whole->series->size(), most_of_head);
    for (const std::size_t n : growing(64, 4, strands)) {
      Row identity;
      identity.set("structure", name).set("model", whole->scene.model->id);
      identity.set("solver", "head").set("grows", "strands");
      identity.set("elements", whole->scene.strands.front().segments.size());
      identity.set("strands", n);
      all.push_back({identity, [whole, device, steps = line.quick ? 20 : 200,
                                repeat = line.repeat](Row& row, const Deadline&) {
                       measure(*whole, device, steps, repeat, row);
                     }});
    }
  }
  return all;
}

}  // namespace tress::experiments::scaling
