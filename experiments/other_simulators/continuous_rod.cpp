#include "experiments/other_simulators/continuous_rod.h"

#include <fmt/format.h>

#include <string>

#include "experiments/numerics/tip_track.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"

namespace tress::experiments::other_simulators {
namespace {

constexpr double metre = 1e-3;  // of a length in mm

std::unique_ptr<System> strand(std::string_view model, int elements) {
  const ModelEntry& entry = find_model(model);
  Parameters p(setup_parameters(entry), fmt::format("model {}", model));
  set_known(p, find_strand_scene("swing").settings);
  set_known(p, {{"modes", "bend"}, {"jacobian", "elastic"}});
  p.set("elements", std::to_string(elements));
  return entry.make(p);
}

}  // namespace

ContinuousRod::ContinuousRod()
    : tip_(converged_rod(strand, {samples * sample, samples, metre * Swing::length})) {}

double ContinuousRod::distance(const Track& track) const {
  std::vector<double> tips;  // m
  for (std::size_t i = 0; i < track.size(); ++i) {
    const double t = sample * static_cast<double>(i + 1);
    const Vec tip = metre * (track[i] + Vec{0, Swing::clamp(t), 0});
    tips.insert(tips.end(), {tip.x, tip.y, tip.z});
  }
  return tip_error(tips, tip_.tip, metre * Swing::length);
}

}  // namespace tress::experiments::other_simulators
