#include "experiments/run/machine.h"

#include <H5public.h>
#include <fmt/format.h>
#include <gsl/gsl_version.h>
#include <klu.h>
#include <sundials/sundials_version.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <toml++/toml.h>
#include <unistd.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "math/instructions.h"

namespace tress::experiments {
namespace {

std::string first_line(const std::string& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

/// Value of the first "key : value" line of /proc/cpuinfo with that key.
std::string cpu_info(const std::string& key) {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with(key) && colon != std::string::npos)
      return line.substr(colon + 2);
  }
  return {};
}

std::string cache_sizes() {
  std::string text;
  for (int i = 0;; ++i) {
    const auto entry = [i](const char* what) {
      return first_line(
          fmt::format("/sys/devices/system/cpu/cpu0/cache/index{}/{}", i, what));
    };
    const std::string level = entry("level"), type = entry("type");
    if (level.empty()) return text;
    if (type == "Instruction") continue;
    text += fmt::format("{}L{}{} {}", text.empty() ? "" : ", ", level,
                        type == "Data" ? "d" : "", entry("size"));
  }
}

std::string widest_simd() {
  const std::string flags = ' ' + cpu_info("flags") + ' ';
  for (const char* name : {"avx512f", "avx2", "avx", "sse2"}) {
    if (flags.find(fmt::format(" {} ", name)) != std::string::npos) return name;
  }
  return {};
}

/// What all processors have worked since the system started, s; 0: it does not say.
double busy_processors_s() {
  std::ifstream stream("/proc/stat");
  std::string cpu;
  stream >> cpu;
  double busy = 0, ticks = 0;
  // user, nice, system, idle, iowait, irq, softirq, steal
  for (int i = 0; i < 8 && stream >> ticks; ++i) {
    if (i != 3 && i != 4) busy += ticks;
  }
  return busy / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

}  // namespace

Machine machine() {
  utsname system{};
  ::uname(&system);
  return {.cpu = cpu_info("model name"),
          .cpus = static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN)),
          .caches = cache_sizes(),
          .simd = widest_simd(),
          .kernels = name(widest_instructions()),
          .kernel = fmt::format("{} {}", system.sysname, system.release)};
}

std::array<double, 3> load_average() {
  std::array<double, 3> loads{};
  if (::getloadavg(loads.data(), 3) != 3) loads = {};
  return loads;
}

std::optional<std::string> timing_doubt() {
  const double load = load_average().front();
  const auto processors = static_cast<double>(std::thread::hardware_concurrency());
  if (load <= processors) return {};
  return fmt::format(
      "times are uncertain: the load of the machine is {:.2g} on {} "
      "processors",
      load, processors);
}

Spent spent_so_far() {
  Spent all;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    if (::getrusage(who, &used) != 0) continue;
    for (const timeval& time : {used.ru_utime, used.ru_stime}) {
      all.processor_s +=
          static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
    all.largest_mb =
        std::max(all.largest_mb, static_cast<double>(used.ru_maxrss) * 1024e-6);
  }
  return all;
}

OtherLoad::OtherLoad()
    : begin_(Clock::now()),
      busy_s_(busy_processors_s()),
      own_s_(spent_so_far().processor_s) {}

double OtherLoad::seconds() const {
  return std::chrono::duration<double>(Clock::now() - begin_).count();
}

double OtherLoad::processors() {
  const OtherLoad now;
  const double passed = std::chrono::duration<double>(now.begin_ - begin_).count();
  const double others = now.busy_s_ - busy_s_ - (now.own_s_ - own_s_);
  *this = now;
  return passed > 0 ? std::max(0.0, others / passed) : 0;
}

Versions library_versions() {
  char sundials[32] = {};
  if (SUNDIALSGetVersion(sundials, sizeof sundials) != 0) sundials[0] = '\0';
  const auto dotted = [](int major, int minor, int patch) {
    return fmt::format("{}.{}.{}", major, minor, patch);
  };
  return {
      {"sundials", sundials},
      {"klu", dotted(KLU_MAIN_VERSION, KLU_SUB_VERSION, KLU_SUBSUB_VERSION)},
      {"eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"gsl", gsl_version},
      {"fmt", dotted(FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
      {"cli11", CLI11_VERSION},
      {"hdf5", dotted(H5_VERS_MAJOR, H5_VERS_MINOR, H5_VERS_RELEASE)},
      {"tomlplusplus", dotted(TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)},
      {"nlohmann_json", dotted(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                               NLOHMANN_JSON_VERSION_PATCH)}};
}

}  // namespace tress::experiments
