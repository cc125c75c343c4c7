#include "simulation/run/memory.h"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include "contract/input_error.h"
#include "simulation/run/world.h"

namespace tress::simulation {
namespace {

constexpr std::size_t measured = 8;   // strands
constexpr std::size_t small = 1'000;  // strands; smaller scenes are not measured

double elements(const Scene& scene) {
  double sum = 0;
  for (const Strand& strand : scene.strands) {
    sum += static_cast<double>(strand.segments.size());
  }
  return sum;
}

}  // namespace

std::size_t heap_in_use() {
  const struct mallinfo2 info = ::mallinfo2();
  return info.uordblks + info.hblkhd;
}

double free_memory() {
  double bytes = std::numeric_limits<double>::infinity();
  std::ifstream file("/proc/meminfo");
  for (std::string key; file >> key;) {
    double kilobytes = 0;
    if (key == "MemAvailable:" && file >> kilobytes) bytes = 1024 * kilobytes;
    file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  rlimit limit{};
  double pages = 0;
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      std::ifstream("/proc/self/statm") >> pages) {
    const double page = static_cast<double>(::sysconf(_SC_PAGESIZE));
    bytes = std::min(bytes, static_cast<double>(limit.rlim_cur) - page * pages);
  }
  return bytes;
}

void refuse_too_large(const Scene& scene) {
  if (scene.strands.size() < small) return;
  Scene few = scene;
  few.strands.resize(measured);
  const auto before = static_cast<double>(heap_in_use());
  const World world(few);
  const double needed =
      (static_cast<double>(heap_in_use()) - before) * elements(scene) / elements(few);
  const double free = free_memory();
  if (needed <= free) return;
  throw InputError(
      fmt::format("{} strands of {} elements altogether need about {:.2g} GB "
                  "of memory, {:.2g} GB are free",
                  scene.strands.size(), elements(scene), needed / 1e9, free / 1e9),
      scene.name, "give fewer strands or elements");
}

}  // namespace tress::simulation
