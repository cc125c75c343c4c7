#include "simulation/scene_changes/strand_options.h"

#include <algorithm>
#include <string>

#include "models/reduced/winding.h"

namespace tress::simulation {
namespace {

models::Unknown unknown_of(const Scene& scene) {
  if (scene.model->id == "super_clothoid") return models::Unknown::linear_curvature;
  return scene.model->id == "articulated_chain" ? models::Unknown::joint_angle
                                                : models::Unknown::curvature;
}

bool chooses_points(const Scene& scene) {
  return scene.model->on_strand != nullptr && scene.model_options.knows("quadrature") &&
         scene.model_options.whole("quadrature") == 0;
}

}  // namespace

double largest_winding(const Scene& scene, const Strand& strand) {
  return models::largest_winding(strand,
                                 unknown_of(scene) == models::Unknown::linear_curvature);
}

int chosen_points(const Scene& scene, double winding) {
  if (!chooses_points(scene)) return 0;
  return models::points_of_segment(unknown_of(scene), winding);
}

StrandOptions::StrandOptions(const Scene& scene) : given_(scene.model_options) {
  if (scene.strands.size() < 2 || !chooses_points(scene)) return;
  std::map<std::size_t, double> windings;
  for (const Strand& strand : scene.strands) {
    double& most = windings[strand.segments.size()];
    most = std::max(most, largest_winding(scene, strand));
  }
  for (const auto& [elements, winding] : windings) {
    Parameters& options = chosen_.emplace(elements, given_).first->second;
    options.set("quadrature", std::to_string(chosen_points(scene, winding)));
  }
}

const Parameters& StrandOptions::of(const Strand& strand) const {
  const auto chosen = chosen_.find(strand.segments.size());
  return chosen == chosen_.end() ? given_ : chosen->second;
}

}  // namespace tress::simulation
