#include "simulation/errors/pilot.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "contract/input_error.h"
#include "simulation/errors/error_bars.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_changes/changes.h"

namespace tress::simulation {
namespace {

// What is asked of the next number of elements, over the tolerance: terms of higher order
// than the estimate's would else often cost one more try.
constexpr double aim = 0.9;

bool has_pilot(const StrandSource& source) {
  return !source.groom && has_tolerance(source);
}

/// Strands of [strand] tables come first, one of each.
const StrandSource& source_of(const Scene& scene, std::size_t strand) {
  return scene.tables->sources[strand];
}

int most_elements(const Scene& scene, std::size_t strand) {
  return source_of(scene, strand).table.values().whole("elements");
}

/// Returns the number of elements that leaves the error at `aim` of the tolerance, by the
/// model's order. It is at least one more than now, and no more than the finer run had.
int more_elements(const Pilot::OfStrand& now, bool parted, int order) {
  if (parted) return 2 * now.elements;
  const double wanted =
      now.elements * std::pow(now.error / (aim * now.tolerance), 1.0 / order);
  return std::clamp(static_cast<int>(std::ceil(std::min(wanted, 1e6))), now.elements + 1,
                    2 * now.elements);
}

[[noreturn]] void refuse(const Scene& scene, std::size_t strand, const std::string& why) {
  throw InputError(why, source_of(scene, strand).table.place("tolerance_m"),
                   "give elements instead");
}

}  // namespace

const Pilot::OfStrand& Pilot::worst() const {
  return *std::ranges::max_element(
      strands, {}, [](const OfStrand& one) { return one.error / one.tolerance; });
}

bool wants_pilot(const Scene& scene) {
  return scene.tables != nullptr && std::ranges::any_of(scene.tables->sources, has_pilot);
}

Pilot pilot(const Scene& scene, int threads) {
  const auto begin = std::chrono::steady_clock::now();
  Pilot found;
  found.scene = scene;
  std::vector<int> elements(scene.tables->sources.size(), 0);
  for (std::size_t k = 0; k < elements.size(); ++k) {
    if (!has_pilot(source_of(scene, k))) continue;
    const int at_rest = static_cast<int>(scene.strands[k].segments.size());
    found.strands.push_back({k, at_rest, at_rest,
                             source_of(scene, k).table.values().number("tolerance_m"),
                             0});
  }
  for (bool enough = false; !enough;) {
    for (const Pilot::OfStrand& one : found.strands) elements[one.strand] = one.elements;
    Scene tried = with_elements_of_strands(scene, elements);
    // The run itself leaves strands out; here they count as they are.
    if (tried.unstable == Unstable::drop) tried.unstable = Unstable::keep;
    const ErrorBar bar = space_error(tried, threads);
    ++found.tries;
    for (const Strand& strand : tried.strands) {
      found.elements += 3 * static_cast<long>(strand.segments.size());
    }
    if (bar.unfinished) {
      found.missing = bar.missing;
      found.scene = scene;
      break;
    }
    if (!bar.missing.empty()) refuse(scene, found.strands.front().strand, bar.missing);
    enough = true;
    for (Pilot::OfStrand& one : found.strands) {
      const StrandError& error = bar.strands[one.strand];
      one.error = error.error.largest * scene.strands[one.strand].length();
      if (!error.parts && one.error <= one.tolerance) continue;
      const int most = most_elements(scene, one.strand);
      if (one.elements < most) {
        one.elements = std::min(
            most, more_elements(one, error.parts.has_value(), scene.model->order));
        enough = false;
      } else if (error.parts) {
        refuse(scene, one.strand,
               fmt::format("with {} elements, the maximum, and with twice that number "
                           "the strand moves differently from {:.3g} s on: no tolerance "
                           "can be held",
                           most, *error.parts));
      }
    }
    tried.unstable = scene.unstable;
    found.scene = std::move(tried);
  }
  found.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return found;
}

}  // namespace tress::simulation
