#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "experiments/problems/strand_scenes.h"
#include "models/catalogue.h"
#include "models/strand/strand_parameters.h"

namespace tress::test_strand_scenes {

using namespace experiments;

Parameters scene_parameters(const StrandScene& scene, std::string_view model,
                            int elements) {
  Parameters p(setup_parameters(find_model(model)), "test");
  for (const auto& [key, value] : scene.settings) p.set(key, value);
  p.set("elements", std::to_string(elements));
  return p;
}

// 1e-3 of the typical rates. Of a strand released straight the typical energy is what
// the scene can turn into motion; energy is quadratic in rates, one power of ten is for
// how the rates combine.
TEST(StrandScenes, StartNextToTheirInitialState) {
  for (const std::string_view model : {"super_helix", "articulated_chain"}) {
    const Parameters p = scene_parameters(find_strand_scene("release"), model, 20);
    const auto system = find_model(model).make(p);
    const State plain = initial_state(*system), start = perturbed_start(*system);
    EXPECT_EQ(start.q, plain.q);
    Energetics& energetics = *system->energetics();
    const double added = energetics.energy(0, start.q, start.v).total() -
                         energetics.energy(0, plain.q, plain.v).total();
    const double bound =
        stability_bounds(find_strand_scene("release"), p, *system).energy;
    EXPECT_GT(added, 0);
    EXPECT_LT(added, 1e-5 * (bound / 0.01)) << model;
  }
}

// In an exact plane the twist stays 0 for ever; rates of twist are there from the start.
TEST(StrandScenes, StartOutOfThePlane) {
  const Parameters p = scene_parameters(find_strand_scene("release"), "super_helix", 5);
  const auto system = find_model("super_helix").make(p);
  const State start = perturbed_start(*system);
  for (std::size_t i = 0; i < start.v.size(); ++i) EXPECT_NE(start.v[i], 0) << i;
}

// The longest step of a scene meets what drives it: in its run the root is accelerated.
TEST(StrandScenes, LongestStepsMeetTheDrive) {
  for (const StrandScene& scene : strand_scenes()) {
    if (!scene.driven) continue;
    const Parameters p = scene_parameters(scene, "super_helix", 2);
    const RootMotion root = root_motion(p);
    const double step = std::min(scene.coarsest, 0.1);
    double met = 0, most = 0;
    for (int i = 1; i * step < scene.t_end; ++i) {
      const Vec a = root.at(i * step).a;
      met = std::max(met, norm(a));
    }
    for (double t = 0; t < scene.t_end; t += 1e-4) {
      const Vec a = root.at(t).a;
      most = std::max(most, norm(a));
    }
    EXPECT_GE(met, 0.5 * most) << scene.name;
  }
}

}  // namespace tress::test_strand_scenes
