#include "experiments/run/settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "integrators/integrator_options.h"

namespace tress::experiments {
namespace {

bool declares(std::span<const Parameter> parameters, std::string_view key) {
  return std::any_of(parameters.begin(), parameters.end(),
                     [key](const Parameter& p) { return p.name == key; });
}

/// The catalogues' lookups name the option; here the location may be an options file.
template <typename Entry>
void check_ids(const std::vector<std::string>& ids, std::span<const Entry> catalogue,
               std::string_view kind, const std::string& where) {
  std::vector<std::string_view> known;
  for (const Entry& entry : catalogue) known.push_back(entry.id);
  for (const std::string& id : ids) {
    if (std::find(known.begin(), known.end(), id) != known.end()) continue;
    throw InputError(fmt::format("unknown {} '{}'", kind, id), where,
                     suggestion(id, known, fmt::format("--list shows the {}s", kind)));
  }
}

bool selected(const CommandLine& line, const ModelEntry& model) {
  return line.models.empty() ||
         std::find(line.models.begin(), line.models.end(), model.id) != line.models.end();
}

}  // namespace

Settings::Settings(const CommandLine& line, std::span<const Parameter> experiment)
    : line_(line), declared_(experiment), experiment_(experiment, "--set") {
  check_ids(line_.models, model_catalogue(), "model", line_.place("models"));
  check_ids(line_.integrators, integrator_catalogue(), "integrator",
            line_.place("integrators"));
  for (const auto& [key, value] : line_.set) {
    const std::string where = line_.place("set:" + key);
    if (owner(key, where) != Owner::experiment) continue;
    Parameters checked(declared_, where);  // so that messages name this location
    checked.set(key, value);
    experiment_.set(key, value);
  }
  static_cast<void>(options());
  for (const ModelEntry& model : model_catalogue()) {
    if (selected(line_, model)) static_cast<void>(parameters(model));
  }
}

Options Settings::options(Options start) const {
  for (const auto& [key, value] : line_.set) {
    const std::string where = line_.place("set:" + key);
    if (owner(key, where) != Owner::integrators) continue;
    refuse_foreign(key, where);
    apply(start, key, value, where);
  }
  return start;
}

Parameters Settings::parameters(const ModelEntry& model) const {
  Parameters result(setup_parameters(model), fmt::format("model {}", model.id));
  for (const auto& [key, value] : line_.set) {
    const std::string where = line_.place("set:" + key);
    if (owner(key, where) != Owner::models || !result.knows(key)) continue;
    Parameters checked(setup_parameters(model),
                       fmt::format("{}, model {}", where, model.id));
    checked.set(key, value);
    result.set(key, value);
  }
  return result;
}

void Settings::leave_models_to_the_scene() const {
  for (const auto& [key, value] : line_.set) {
    const std::string where = line_.place("set:" + key);
    if (owner(key, where) != Owner::models) continue;
    throw InputError(fmt::format("the scene defines '{}' itself", key), where,
                     "leave it out, or change the scene");
  }
}

bool Settings::chosen(std::string_view key) const {
  return std::any_of(line_.set.begin(), line_.set.end(),
                     [key](const auto& setting) { return setting.first == key; });
}

void Settings::refuse_foreign(std::string_view key, const std::string& where) const {
  const auto readers = readers_of_option(key);
  const auto is_wanted = [&](const IntegratorEntry* reader) {
    return wanted(line_.integrators, reader->id);
  };
  if (readers.empty() || std::ranges::any_of(readers, is_wanted)) return;
  const std::string_view id = readers.front()->id;
  throw InputError(fmt::format("{} belongs to {}", key, id), where,
                   fmt::format("leave it out, or add {} to --integrators", id));
}

bool Settings::some_model_knows(std::string_view key) const {
  return std::any_of(
      model_catalogue().begin(), model_catalogue().end(), [&](const ModelEntry& model) {
        return selected(line_, model) && declares(setup_parameters(model), key);
      });
}

Settings::Owner Settings::owner(std::string_view key, const std::string& where) const {
  if (declares(declared_, key)) return Owner::experiment;
  if (declares(integrator_options(), key)) return Owner::integrators;
  if (some_model_knows(key)) return Owner::models;
  std::vector<std::string_view> known;
  for (const Parameter& p : declared_) known.push_back(p.name);
  for (const Parameter& p : integrator_options()) known.push_back(p.name);
  for (const ModelEntry& model : model_catalogue()) {
    if (!selected(line_, model)) continue;
    for (const Parameter& p : setup_parameters(model)) known.push_back(p.name);
  }
  throw InputError(fmt::format("unknown key '{}'", key), where,
                   suggestion(key, known, "--list shows the keys"));
}

void leave_strands_to_the_scene(const CommandLine& line) {
  if (!line.models.empty()) {
    throw InputError("the scene names its model itself", line.place("models"),
                     "leave it out, or change the scene's [model]");
  }
  if (!line.elements.empty()) {
    throw InputError("the scene has the elements of its strands itself",
                     line.place("elements"),
                     "leave it out, or change the scene's elements");
  }
}

}  // namespace tress::experiments
