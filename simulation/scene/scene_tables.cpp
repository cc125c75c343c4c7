#include "simulation/scene/scene_tables.h"

#include <fmt/format.h>

#include <map>

#include "integrators/catalogue.h"
#include "integrators/integrator_options.h"
#include "models/effects/catalogue.h"
#include "simulation/scene/gradient_table.h"
#include "simulation/scene/groom.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/material_table.h"
#include "simulation/scene/root_table.h"
#include "simulation/scene/shapes.h"
#include "simulation/scene/strand_table.h"
#include "simulation/scene/support_table.h"

namespace tress::simulation {
namespace {

constexpr Parameter top[] = {
    {.name = "title",
     .help = "title in one line; required: the empty default is refused",
     .text = true},
    {.name = "source", .help = "source of the scene", .text = true},
    {.name = "duration_s",
     .help = "simulated time (s)",
     .number = 1,
     .min = 1e-9,
     .max = 1e6},
    {.name = "frames_per_s",
     .help = "frames of the series and the geometry per simulated time, and one at its "
             "end (1/s)",
     .number = 50,
     .min = 1e-6,
     .max = 1e6},
    {.name = "checkpoint_s",
     .help = "simulated time between saved states (s), 0: once a minute "
             "of the clock",
     .number = 0,
     .min = 0,
     .max = 1e6},
    {.name = "guard",
     .help =
         "end the run at a state that physics rules out. These are a segment stretched "
         "or compressed by more than half, a point faster than the energy allows, or "
         "too much energy. The energy may exceed its initial value by m g L and a tenth "
         "of the initial kinetic and elastic energy. To this, 1.1 times the work of "
         "loads and root is added. Coarse steps need that margin. A run warns "
         "of a method that creates or dissipates a tenth of the energy of the motion. "
         "See failed_strands",
     .choices = "true|false"},
    {.name = "failed_strands",
     .help =
         "outcome of a strand that fails, or that the guard stops: it ends the run, or "
         "stays in place. The run then exits with code 3. In a batch a strand always "
         "stays",
     .choices = "end_run|stay"},
    {.name = "rest",
     .help =
         "natural strains: those of the tables, or inverse. With inverse all strands are "
         "at rest in their shape at t = 0, under the loads at t = 0 (the mean of wind)",
     .choices = "natural|inverse"},
    {.name = "unstable",
     .help = "rest = inverse: treatment of strands too soft to stay: made "
             "twice as stiff as needed, left to fall, or left out",
     .choices = "stiffen|keep|drop"},
    {.name = "seed",
     .help = "seed of every random choice",
     .number = 1,
     .min = 0,
     .max = 9007199254740991,  // no other whole number is rounded to these
     .whole = true},
};

/// The ids of a catalogue as choices, `first` before the others.
template <class Entries>
std::string choices_of(const Entries& entries, std::string_view first) {
  std::string all(first);
  for (const auto& entry : entries) {
    if (entry.id != first) all += fmt::format("|{}", entry.id);
  }
  return all;
}

/// The integrators' options whose keys say their unit.
struct KeyOfOption {
  std::string_view key, option;
};
constexpr KeyOfOption in_seconds[] = {
    {"dt_s", "step"}, {"max_step_s", "max_step"}, {"min_step_s", "min_step"}};

std::vector<Parameter> options_of(const ModelEntry& model, std::string_view ids) {
  std::vector<Parameter> list{{.name = "id", .help = "id of the model", .choices = ids}};
  list.insert(list.end(), model.parameters.begin(), model.parameters.end());
  return list;
}

}  // namespace

std::span<const Parameter> top_parameters() { return top; }

std::span<const Parameter> model_table_parameters(const ModelEntry& model) {
  static const std::string ids = choices_of(model_catalogue(), "super_helix");
  static const auto all = [] {
    std::map<std::string_view, std::vector<Parameter>> lists;
    for (const ModelEntry& one : model_catalogue())
      lists.emplace(one.id, options_of(one, ids));
    return lists;
  }();
  return all.at(model.id);
}

std::span<const Parameter> integrator_table_parameters() {
  static const std::string ids =
      choices_of(integrator_catalogue(), "linearly_implicit_euler");
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> list{
        {.name = "id", .help = "id of the method", .choices = ids}};
    for (Parameter p : integrator_options()) {
      for (const auto& [key, option] : in_seconds) {
        if (p.name == option) p.name = key;
      }
      list.push_back(p);
    }
    return list;
  }();
  return all;
}

std::string_view option_of(std::string_view key) {
  const auto found = std::ranges::find(in_seconds, key, &KeyOfOption::key);
  return found == std::end(in_seconds) ? key : found->option;
}

std::span<const Use> integrator_uses() {
  static const auto keys_of = [] {  // storage: a Use only refers to them
    std::map<std::string_view, std::string> all;
    for (const IntegratorEntry& entry : integrator_catalogue()) {
      for (const Parameter& p : entry.parameters) {
        std::string& keys = all[entry.id];
        keys += (keys.empty() ? "" : "|") + std::string(p.name);
      }
    }
    return all;
  }();
  static const auto uses = [] {
    std::vector<Use> list;
    list.reserve(keys_of.size());
    for (const auto& [id, keys] : keys_of) list.push_back({id, keys});
    return list;
  }();
  return uses;
}

std::vector<TableEntry> table_entries() {
  std::vector<TableEntry> all{
      {.name = "integrator",
       .summary = "time integration",
       .parameters = integrator_table_parameters(),
       .choice = "id",
       .uses = integrator_uses(),
       .needed = true},
      {.name = "material",
       .summary =
           "material of all strands; [strand.material] and [groom.material] below a "
           "strand or a groom change it for that one",
       .parameters = material_table_parameters(),
       .needed = true},
      {.name = "strand",
       .summary = "one strand",
       .parameters = strand_table_parameters(),
       .choice = "shape",
       .uses = shape_uses(),
       .needed = true,
       .many = true},
      {.name = "groom",
       .summary = "many strands on a head, from a few numbers",
       .parameters = groom_table_parameters(),
       .choice = "shape",
       .uses = shape_uses(),
       .many = true},
      {.name = "root",
       .summary = "common motion of all roots",
       .parameters = root_table_parameters(),
       .choice = "motion",
       .uses = root_uses(),
       .needed = true}};
  for (const EffectEntry& effect : effects()) {
    TableEntry entry;
    entry.name = fmt::format("effects.{}", effect.id);
    entry.summary = fmt::format("{} ({})", effect.summary, effect.source);
    entry.parameters = effect.parameters;
    entry.many = effect.many;
    all.push_back(std::move(entry));
  }
  for (const DrivenKind& kind : driven_kinds()) {
    TableEntry entry;
    entry.name = fmt::format("effects.{}", kind.id);
    entry.summary = fmt::format("{} ({})", kind.summary, kind.source);
    entry.parameters = kind.parameters;
    entry.many = true;
    all.push_back(std::move(entry));
  }
  all.push_back({.name = "supports",
                 .summary = "a point of a strand that is held, in addition to a clamped "
                            "root. The strand begins at rest in an equilibrium if its "
                            "points begin elsewhere. [integrator] formulation has a "
                            "default that suits the method",
                 .parameters = support_table_parameters(),
                 .many = true});
  all.push_back({.name = "joints",
                 .summary =
                     "a joint between two strands, or two points of one. Its points "
                     "coincide at the start, except those of a spring. Joined "
                     "strands are one system. [integrator] formulation has the "
                     "same default as with supports",
                 .parameters = joint_table_parameters(),
                 .many = true});
  all.push_back({.name = "gradient",
                 .summary = "derivatives of the motion by numbers of the scene. "
                            "`simulate --gradient` writes them; without that option the "
                            "table has no effect",
                 .parameters = gradient_table_parameters()});
  return all;
}

}  // namespace tress::simulation
