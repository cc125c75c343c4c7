#include <algorithm>

#include "contract/input_error.h"
#include "experiments/cost_of_accuracy/trial_scene.h"
#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "experiments/run/command_line.h"
#include "models/reduced/pitfalls.h"
#include "simulation/run/world.h"
#include "simulation/scene/scene_tables.h"

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

/// The model on the scene's first strand; null if the model cannot represent it: one
/// without curls, say.
std::unique_ptr<System> on_scene(const ModelEntry& model, const ModelSettings& options,
                                 const Scene& scene) {
  Parameters parameters(model_table_parameters(model), std::string(model.id));
  set_known(parameters, options);
  try {
    return model.on_strand(scene.strands.front(), parameters, make_effects(scene));
  } catch (const InputError&) {
    return nullptr;
  }
}

/// What the Jacobian `elastic_local` leaves out makes Newton's iteration diverge beyond a
/// length of step that the elements set. A tolerance then decides nothing: a curl took up
/// to 22 500 steps in half a second at tolerances for which other Jacobians take 31.
bool may_control(const Method& method) {
  return method.word("jacobian") != "elastic_local";
}

/// The method with its preferred formulation for the system, if it has one, in all ways
/// to choose the accuracy of a run.
void add(Method method, System& system, const Scene& given, const MethodChoice& choice,
         std::vector<Method>& all) {
  const IntegratorEntry& entry = find_integrator(method.integrator);
  const auto usable = usable_formulations(entry, system);
  if (usable.empty()) return;
  method.formulation = usable.front();
  const bool controls = entry.error_controlled && may_control(method) &&
                        preferred_formulation(entry, system, 1) == usable.front();
  if (entry.stages == 0) {
    all.push_back(method);
  } else if (!controls || choice.fixed_steps) {
    for (const Refresh refresh : choice.refreshes) {
      method.refresh = refresh;
      all.push_back(method);
    }
  }
  if (!controls) return;
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
      const auto system = on_scene(model, options, given);
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
      const auto system = on_scene(*method.model, options, given);
      if (system == nullptr) continue;
      const auto usable =
          usable_formulations(find_integrator(method.integrator), *system);
      if (usable.empty()) continue;
      Method other = method;
      other.options = options;
      if (other.by_tolerance && !may_control(other)) continue;
      all.push_back(other);
      all.back().formulation = usable.front();
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
