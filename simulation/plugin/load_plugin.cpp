#include "simulation/plugin/load_plugin.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <exception>
#include <filesystem>

#include "contract/input_error.h"
#include "contract/read_file.h"
#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "simulation/files/checksum.h"
#include "simulation/plugin/plugin.h"

namespace tress::simulation {
namespace {

constexpr BuildStamp stamp_of_this;
constexpr const char* page = "docs/plugins.md says how one is built";

std::vector<LoadedPlugin>& all_loaded() {
  static std::vector<LoadedPlugin> all;
  return all;
}

/// The next field, "name=value", of a stamp, and what follows it.
std::string_view take_field(std::string_view& stamp) {
  const std::size_t end = stamp.find('|');
  const std::string_view field = stamp.substr(0, end);
  stamp.remove_prefix(end == stamp.npos ? stamp.size() : end + 1);
  return field;
}

/// Throws InputError on the first field in which the library's stamp differs.
void check_stamp(std::string_view bytes, const std::string& file) {
  std::string_view ours = stamp_of_this.text();
  const std::size_t at = bytes.find(ours.substr(0, ours.find('=') + 1));
  refuse_if(at == bytes.npos, "this is no plug-in of tress", file, page);
  std::string_view theirs = bytes.substr(at, ours.size());
  while (!ours.empty()) {
    const std::string_view here = take_field(ours), there = take_field(theirs);
    if (here == there) continue;
    const std::size_t equals = here.find('=') + 1;
    const std::string_view name = here.substr(0, equals - 1);
    const bool same_name = there.starts_with(here.substr(0, equals));
    const std::string_view value = same_name ? there.substr(equals) : "unknown";
    throw InputError(
        name == "version"
            ? fmt::format("the plug-in was built for tress {}, this is {}", value,
                          here.substr(equals))
            : fmt::format(
                  "the plug-in was built with other {} ({}, this program with {})", name,
                  value, here.substr(equals)),
        file, "build it against the tress that loads it");
  }
}

template <class Function>
Function symbol(void* library, const char* name) {
  return reinterpret_cast<Function>(::dlsym(library, name));
}

/// What the library brings, by its own account.
Plugin brought_by(const std::string& file) {
  // A name without a folder would be looked for among the system's libraries.
  const std::string path = std::filesystem::absolute(file).string();
  void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    throw InputError(fmt::format("the plug-in cannot be loaded: {}", ::dlerror()), file,
                     page);
  }
  const auto bring = symbol<void (*)(Plugin&)>(library, "tress_plugin");
  refuse_if(bring == nullptr, "the plug-in has no function tress_plugin", file, page);
  Plugin plugin;
  try {
    bring(plugin);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("the plug-in did not start: {}", error.what()), file,
                     "ask its author");
  }
  refuse_if(plugin.models.empty() && plugin.integrators.empty() && plugin.effects.empty(),
            "the plug-in brings nothing", file, page);
  return plugin;
}

}  // namespace

void load_plugin(const std::string& file) {
  const std::string bytes = read_file(file);
  check_stamp(bytes, file);
  const Plugin plugin = brought_by(file);
  LoadedPlugin loaded{file, checksum(bytes), {}, {}, {}};
  for (const models::ModelEntry& model : plugin.models) {
    models::add_model(model, file);
    loaded.models.emplace_back(model.id);
  }
  for (const integrators::IntegratorEntry& method : plugin.integrators) {
    integrators::add_integrator(method, file);
    loaded.integrators.emplace_back(method.id);
  }
  for (const models::EffectEntry& effect : plugin.effects) {
    models::add_effect(effect, file);
    loaded.effects.emplace_back(effect.id);
  }
  all_loaded().push_back(std::move(loaded));
}

std::span<const LoadedPlugin> loaded_plugins() { return all_loaded(); }

}  // namespace tress::simulation
