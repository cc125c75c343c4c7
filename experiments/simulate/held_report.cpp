#include "experiments/simulate/held_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "contract/input_error.h"
#include "experiments/run/message.h"
#include "simulation/files/files.h"
#include "simulation/run/world.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::scene_runs {
namespace {

constexpr std::size_t most_named = 20;

std::string fate_of(const HeldShape& held, Unstable unstable) {
  const std::string why =
      std::isfinite(held.least_factor)
          ? fmt::format("it stays from {:.4g} times its stiffness on", held.least_factor)
          : "no stiffness holds it";
  if (unstable == Unstable::drop) return why + "; left out";
  if (held.falls()) return why + "; it falls";
  return why + fmt::format("; made {:.4g} times as stiff", held.factor);
}

std::string table_of(const Scene& scene, const std::vector<HeldShape>& all) {
  std::string text = "strand,least_factor,factor,residual_rel,sag_rel,contacts,outcome\n";
  for (std::size_t k = 0; k < all.size(); ++k) {
    const HeldShape& held = all[k];
    const char* const outcome = !held.would_fall()                    ? "stays"
                                : scene.unstable == Unstable::stiffen ? "stiffened"
                                : scene.unstable == Unstable::keep    ? "falls"
                                                                      : "dropped";
    fmt::format_to(std::back_inserter(text), "{},{:.17g},{:.17g},{:.3g},{:.3g},{},{}\n",
                   k, held.least_factor, held.factor, held.residual,
                   held.sag / scene.strands[k].length(), held.contacts, outcome);
  }
  return text;
}

}  // namespace

void report_held(const Scene& scene, const std::vector<HeldShape>& all,
                 const std::string& file) {
  double residual = 0, sag = 0;
  std::size_t unstable = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    residual = std::max(residual, all[k].residual);
    if (!all[k].falls()) sag = std::max(sag, all[k].sag / scene.strands[k].length());
    if (!all[k].would_fall()) continue;
    if (++unstable <= most_named) {
      tell("simulate: {}: strand {} would fall: {}\n", scene.name, k,
           fate_of(all[k], scene.unstable));
    }
  }
  if (unstable > most_named) {
    tell("simulate: {}: {} strands would fall, all in {}\n", scene.name, unstable, file);
  }
  tell(
      "simulate: {}: held at rest: balance within {:.2g} of the loads, sag of those that "
      "stay at most {:.2g} of the length -> {}\n",
      scene.name, residual, sag, file);
  replace_file(file, table_of(scene, all));
}

Scene without_falling(Scene scene, const std::string& file, int threads) {
  if (scene.rest == RestStrains::natural || scene.unstable != Unstable::drop) {
    return scene;
  }
  Scene probed = scene;
  probed.unstable = Unstable::keep;
  const World world(probed, threads);
  report_held(scene, world.held(), file);
  std::vector<std::size_t> stay;
  for (std::size_t k = 0; k < world.held().size(); ++k) {
    if (!world.held()[k].would_fall()) stay.push_back(k);
  }
  if (stay.empty()) {
    throw InputError("every strand would fall", "unstable = \"drop\"",
                     "use unstable = \"stiffen\" or \"keep\"");
  }
  if (stay.size() == scene.strands.size()) return scene;
  return only(std::move(scene), stay);
}

}  // namespace tress::experiments::scene_runs
