#include "simulation/plugin/load_plugin.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <link.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <system_error>

#include "contract/input_error.h"
#include "contract/read_file.h"
#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "simulation/files/checksum.h"
#include "simulation/plugin/plugin.h"

namespace tress::simulation {
namespace {

constexpr BuildStamp stamp_of_this;
// Commas are between numbers alone: "compiler=GNU 12|", "sizes=8,384,...|".
static_assert(stamp_of_this.text().find("=,") == std::string_view::npos &&
              stamp_of_this.text().find(" ,") == std::string_view::npos);
constexpr const char* page = "docs/plugins.md describes how to build one";
constexpr const char* author = "ask its author";

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

/// The library's function of that name; null if it has none, or something else so named.
template <class Function>
Function symbol(void* library, const char* name) {
  void* found = ::dlsym(library, name);
  Dl_info place{};
  const ElfW(Sym)* entry = nullptr;
  if (found == nullptr ||
      ::dladdr1(found, &place, reinterpret_cast<void**>(const_cast<ElfW(Sym)**>(&entry)),
                RTLD_DL_SYMENT) == 0 ||
      entry == nullptr || ELF64_ST_TYPE(entry->st_info) != STT_FUNC) {
    return nullptr;
  }
  return reinterpret_cast<Function>(found);
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
                     author);
  } catch (...) {
    throw InputError("the plug-in did not start: it threw what is no std::exception",
                     file, author);
  }
  refuse_if(plugin.models.empty() && plugin.integrators.empty() && plugin.effects.empty(),
            "the plug-in brings nothing", file, page);
  return plugin;
}

/// Adds what the library brings to the catalogues.
LoadedPlugin added(const std::string& file, std::string sum) {
  const Plugin plugin = brought_by(file);
  LoadedPlugin loaded{file, std::move(sum), {}, {}, {}};
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
  return loaded;
}

/// Loads the library in a process of its own first: what its code does on loading may end
/// a process in ways that nothing here can catch. Throws InputError where it does; what
/// it refuses, loading it here refuses again, with the reason.
void rehearse(const std::string& file) {
  constexpr int came_back = 17;  // an exit code by which no library ends a process
  constexpr unsigned longest_s = 60;
  const pid_t process = ::fork();
  if (process < 0) {
    throw std::system_error(errno, std::generic_category(), "fork");
  }
  if (process == 0) {
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
    const rlimit no_core{};
    ::setrlimit(RLIMIT_CORE, &no_core);
    ::signal(SIGALRM, SIG_DFL);
    ::alarm(longest_s);
    try {
      added(file, {});
    } catch (const std::exception&) {
    }
    ::_exit(came_back);
  }
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == came_back) return;
  const std::string how =
      WIFEXITED(status) ? fmt::format("exit code {}", WEXITSTATUS(status))
      : WTERMSIG(status) == SIGALRM
          ? fmt::format("no answer in {} s", longest_s)
          : fmt::format("signal {}: {}", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  throw InputError(fmt::format("the plug-in ends the program that loads it ({})", how),
                   file, author);
}

}  // namespace

void load_plugin(const std::string& file) {
  const std::string bytes = read_file(file);
  check_stamp(bytes, file);
  rehearse(file);
  all_loaded().push_back(added(file, checksum(bytes)));
}

std::span<const LoadedPlugin> loaded_plugins() { return all_loaded(); }

}  // namespace tress::simulation
