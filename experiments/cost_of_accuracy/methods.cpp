#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "contract/input_error.h"
#include "experiments/cost_of_accuracy/trial_scene.h"
#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "experiments/run/command_line.h"
#include "models/driven/driven_system.h"
#include "models/reduced/pitfalls.h"
#include "simulation/run/world.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/scene_tables.h"
#include "simulation/scene/support_table.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

/// The combinations of options tried for one model.
std::vector<ModelSettings> option_sets(const ModelEntry& model,
                                       const std::vector<std::string>& varied) {
  // The non-default values.
  const auto others = [&](const Parameter& p) {
    std::vector<ModelSettings> all;
    const auto words = words_of(p.choices);
    const std::string key(p.name);
    for (std::size_t i = 1; i < words.size(); ++i) {
      const std::string word(words[i]);
      if (models::loses_digits(key, word)) continue;
      if (varied.empty() || std::ranges::count(varied, key) > 0 ||
          std::ranges::count(varied, key + '=' + word) > 0) {
        all.push_back({{key, word}});
      }
    }
    return all;
  };
  std::vector<ModelSettings> pairs{{}}, single;
  for (const Parameter& p : model_table_parameters(model)) {
    if (p.choices.empty() || p.name == "id") continue;
    const bool paired = p.name == "modes" || p.name == "jacobian";
    const std::vector<ModelSettings> before = pairs;
    for (const ModelSettings& one : others(p)) {
      if (!paired) single.push_back(one);
      for (const ModelSettings& first : before) {
        if (!paired) continue;
        pairs.push_back(first);
        pairs.back().push_back(one.front());
      }
    }
  }
  pairs.insert(pairs.end(), single.begin(), single.end());
  return pairs;
}

/// The model on the scene's first strand, or on those first strands that supports or
/// joints hold. Null if the model cannot represent them: one without curls, say. `why`
/// has the reason then.
std::unique_ptr<System> on_scene(const ModelEntry& model, const ModelSettings& options,
                                 const Scene& given, std::string& why) {
  try {
    const Scene scene =
        with_method(given, {&model, options, given.integrator, Formulation::parametric});
    const simulation::SceneSupports supports(scene);
    const simulation::SceneJoints joints(scene);
    const models::Effects effects = make_effects(scene);
    simulation::SceneJoints::Group group;
    if (!joints.groups().empty()) {
      group = joints.groups().front();
    } else {
      const std::size_t all = scene.strands.size();
      while (group.first < all && !supports.hold(group.first)) ++group.first;
      if (group.first == all) group.first = 0;
    }
    std::vector<std::unique_ptr<System>> systems;
    std::vector<const Strand*> strands;
    for (std::size_t k = group.first; k < group.first + group.count; ++k) {
      strands.push_back(&scene.strands[k]);
      systems.push_back(
          supports.on(model.on_strand(*strands.back(), scene.model_options, effects),
                      *strands.back(), k));
    }
    auto system = joints.groups().empty()
                      ? std::move(systems.front())
                      : joints.join(group, std::move(systems), strands, effects);
    return models::with_driven_bodies(std::move(system), effects);
  } catch (const InputError& error) {
    why = error.what();
    return nullptr;
  }
}

/// The formulation of a run with fixed steps or with a tolerance: that of a scene file,
/// where supports or joints are constraints, else the method's preferred one. Empty: the
/// method cannot drive the system.
std::optional<Formulation> formulation_of(const IntegratorEntry& entry, System& system,
                                          const Scene& given, bool by_tolerance) {
  if (held(given) && system.layout().constraints > 0) {
    const Formulation usual = simulation::formulation_of_supports(entry, by_tolerance);
    if (refusal(entry, system, usual).empty()) return usual;
  }
  const auto usable = usable_formulations(entry, system);
  const auto preferred = preferred_formulation(entry, system, by_tolerance ? 1 : 0);
  if (usable.empty() || preferred != usable.front()) return {};
  return preferred;
}

/// What the Jacobian `elastic_local` leaves out makes Newton's iteration diverge beyond a
/// length of step that the elements set. A tolerance then decides nothing: a curl took up
/// to 22 500 steps in half a second at tolerances for which other Jacobians take 31.
bool may_control(const Method& method) {
  return method.word("jacobian") != "elastic_local";
}

/// The method with its formulation for the system, if it has one, in all ways to choose
/// the accuracy of a run.
void add(Method method, System& system, const Scene& given, const MethodChoice& choice,
         std::vector<Method>& all) {
  const IntegratorEntry& entry = find_integrator(method.integrator);
  const auto fixed = formulation_of(entry, system, given, false);
  const auto controlled = formulation_of(entry, system, given, true);
  const bool controls = entry.error_controlled && may_control(method) && controlled;
  if (!fixed) return;
  method.formulation = *fixed;
  if (entry.stages == 0) {
    all.push_back(method);
  } else if (!controls || choice.fixed_steps) {
    for (const Refresh refresh : choice.refreshes) {
      method.refresh = refresh;
      all.push_back(method);
    }
  }
  if (!controls) return;
  method.formulation = *controlled;
  method.refresh = {};
  method.by_tolerance = true;
  all.push_back(method);
  if (!choice.extrapolated || !may_extrapolate(given)) return;
  method.extrapolated = true;
  all.push_back(method);
}

}  // namespace

std::vector<Method> methods(const Scene& given, const MethodChoice& choice) {
  std::vector<Method> all;
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand == nullptr || !wanted(choice.models, model.id)) continue;
    for (const ModelSettings& options : option_sets(model, choice.options)) {
      std::string why;
      const auto system = on_scene(model, options, given, why);
      if (system == nullptr) continue;
      for (const IntegratorEntry& entry : integrator_catalogue()) {
        const bool plain =
            options.empty() && !choice.plain.empty() && wanted(choice.plain, entry.id);
        if (entry.adaptive || !(plain || wanted(choice.integrators, entry.id))) continue;
        add({{&model, options, std::string(entry.id)}}, *system, given, choice, all);
      }
    }
  }
  if (!choice.cuts_at_rest || !may_cut_at_rest(given)) return all;
  for (std::size_t i = 0, count = all.size(); i < count; ++i) {
    all.push_back(all[i]);
    all.back().cut_at_rest = true;
  }
  return all;
}

std::vector<LeftOut> left_out(const Scene& given, const MethodChoice& choice,
                              const std::vector<Method>& taken) {
  std::vector<LeftOut> all;
  std::unique_ptr<System> some;
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand == nullptr || !wanted(choice.models, model.id)) continue;
    std::string why = "no method of the search can integrate it";
    auto system = on_scene(model, {}, given, why);
    if (std::ranges::count(taken, &model, &Method::model) == 0) {
      all.push_back({std::string(model.id), why});
    }
    if (some == nullptr) some = std::move(system);
  }
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    if (some == nullptr || entry.adaptive || !wanted(choice.integrators, entry.id) ||
        std::ranges::count(taken, entry.id, &Method::integrator) > 0) {
      continue;
    }
    const Formulation usual = some->layout().constraints > 0
                                  ? simulation::formulation_of_supports(entry, false)
                                  : Formulation::parametric;
    all.push_back({std::string(entry.id), refusal(entry, *some, usual)});
  }
  return all;
}

std::vector<Method> with_other_words(const Scene& given, const Method& method,
                                     std::string_view choice) {
  std::vector<Method> all;
  for (const Parameter& p : method.model->parameters) {
    if (p.name != choice) continue;
    for (const std::string_view word : words_of(p.choices)) {
      if (word == method.word(choice) || models::loses_digits(choice, word)) continue;
      ModelSettings options = method.options;
      std::erase_if(options, [choice](const auto& one) { return one.first == choice; });
      if (word != words_of(p.choices).front()) options.emplace_back(choice, word);
      std::string why;
      const auto system = on_scene(*method.model, options, given, why);
      if (system == nullptr) continue;
      const auto formulation = formulation_of(find_integrator(method.integrator), *system,
                                              given, method.by_tolerance);
      if (!formulation) continue;
      Method other = method;
      other.options = options;
      if (other.by_tolerance && !may_control(other)) continue;
      all.push_back(other);
      all.back().formulation = *formulation;
    }
  }
  return all;
}

std::vector<std::string_view> choices_of(const ModelEntry& model) {
  std::vector<std::string_view> all;
  for (const Parameter& p : model_table_parameters(model)) {
    if (!p.choices.empty() && p.name != "id") all.push_back(p.name);
  }
  return all;
}

bool same(const Method& a, const Method& b) {
  return a.model == b.model && a.integrator == b.integrator && a.refresh == b.refresh &&
         a.by_tolerance == b.by_tolerance && a.extrapolated == b.extrapolated &&
         a.cut_at_rest == b.cut_at_rest &&
         std::ranges::all_of(choices_of(*a.model), [&](std::string_view choice) {
           return a.word(choice) == b.word(choice);
         });
}

}  // namespace tress::experiments::cost_of_accuracy
