#include "tests/fuzz/random_effects.h"

#include <fmt/format.h>

namespace tress::testing_support {
namespace {

/// Dead and following forces on one place of every strand.
std::string point_force(Draw& draw) {
  if (!draw.chance(0.15)) return "";
  return fmt::format(
      "[[effects.point_force]]\nat = {:.3g}\nforce_n = [0, {:.3g}, 0]\nfollower_n = "
      "{:.3g}\nfactor_over_time = [[0, 0], [0.01, 1]]\n",
      draw.one_of({0.3, 1.0, 1.0}), draw.of_size(1e-8, 1e-6),
      draw.chance(0.5) ? 0.0 : -draw.of_size(1e-8, 1e-6));
}

/// Loads on a part of every strand.
std::string distributed_load(Draw& draw) {
  if (!draw.chance(0.15)) return "";
  return fmt::format(
      "[[effects.distributed_load]]\nfrom = {}\nto = {}\nforce_n_per_m = [0, {:.3g}, "
      "0]\nalong_n_per_m = {:.3g}\nturned_n_per_m = [0, 0, {:.3g}]\n",
      draw.one_of({0.0, 0.2}), draw.one_of({0.7, 1.0}), draw.of_size(1e-7, 1e-4),
      draw.chance(0.5) ? 0.0 : -draw.of_size(1e-7, 1e-5),
      draw.chance(0.5) ? 0.0 : draw.of_size(1e-7, 1e-5));
}

}  // namespace

std::string body(Draw& draw) {
  // Contact assumes a start outside: long steps from inside have several solutions.
  const double size = draw.uniform(0.09, 0.1);
  const std::string shape = draw.one_of({"sphere", "sphere", "capsule", "ellipsoid"});
  return fmt::format(
      "[[effects.body]]\nshape = \"{}\"\n{}moves = \"{}\"\nstiffness_n_m2 = {:.4g}\n"
      "friction = {}\n",
      shape,
      shape == "ellipsoid"
          ? fmt::format("half_axes_m = [{0:.4g}, {1:.4g}, {0:.4g}]\n", size, 0.9 * size)
          : fmt::format("radius_m = {:.4g}\n", size),
      draw.one_of({"fixed", "head"}), draw.of_size(0.1, 300),
      draw.one_of({0.0, 0.3, 2.0}));
}

std::string moving_body(Draw& draw, double length) {
  if (!draw.chance(0.1)) return "";
  return fmt::format(
      "[[effects.body]]\nshape = \"sphere\"\nradius_m = {:.4g}\ncentre_m = [{:.4g}, 0, "
      "{:.4g}]\nmoves = \"keyframes\"\nkeyframes = [[0, 0, 0, 0, 0], [0.01, 0, 0, "
      "{:.4g}, "
      "1]]\n",
      0.2 * length, 0.2 + 0.5 * length, -0.5 * length, 0.4 * length);
}

std::string wind(Draw& draw) {
  return fmt::format(
      "[effects.wind]\nvelocity_m_s = [{:.3g}, 0, 1]\nprofile = \"{}\"\nlaw = \"{}\"\n",
      draw.of_size(0.3, 30), draw.one_of({"steady", "sine"}),
      draw.one_of({"force", "quadratic"}));
}

std::string further(Draw& draw, double length) {
  std::string text;
  if (draw.chance(0.15)) text += "[effects.quadratic_drag]\n";
  if (draw.chance(0.15)) text += "[effects.constant_force]\nforce_n_m = [0, 1e-5, 0]\n";
  if (draw.chance(0.15)) {
    text += fmt::format(
        "[[effects.tether]]\nat = {}\nstiffness_n_m = 0.001\ndamping_n_s_m = {}\n"
        "target_m = [{:.3g}, 0, 0]\n",
        draw.one_of({0.5, 1.0}), draw.one_of({0.0, 1e-6}), length);
  }
  if (draw.chance(0.1)) {
    text += fmt::format(
        "[[effects.ring]]\nkeyframes = [[0, 0.1, 0, 0], [0.01, {:.3g}, 0, 0]]\n"
        "stiffness_n_per_m = {:.3g}\n",
        length, draw.of_size(1e-5, 1e-2));
  }
  return text + point_force(draw) + distributed_load(draw);
}

std::string driven(Draw& draw) {
  std::string text;
  if (draw.chance(0.08)) {
    text += fmt::format("[[effects.point_moment]]\nfollower_n_m = [{:.3g}, 1e-9, 0]\n",
                        draw.of_size(1e-10, 1e-8));
  }
  if (draw.chance(0.08)) {
    text += fmt::format(
        "[[effects.natural_shape]]\ncurvature_per_m = [[0, 0], [0.02, {:.3g}]]\n",
        draw.of_size(1, 100));
  }
  if (draw.chance(0.08)) {
    text += fmt::format("[[supports]]\nkind = \"{}\"\n{}",
                        draw.one_of({"ball", "ball", "direction", "clamp"}),
                        draw.chance(0.5) ? "stiffness_n_per_m = 1e-3\n" : "");
  }
  return text;
}

}  // namespace tress::testing_support
