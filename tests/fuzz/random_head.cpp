#include "tests/fuzz/random_head.h"

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <string_view>

namespace tress::testing_support {
namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}

  bool chance(double p) { return uniform(0, 1) < p; }
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) * std::ldexp(1.0, -64);
  }
  double of_size(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  template <class T, std::size_t n>
  T one_of(const T (&all)[n]) {
    return all[random_() % n];
  }

 private:
  std::mt19937_64 random_;
};

std::string body(Draw& draw, double reach) {
  return fmt::format(
      "[[effects.body]]\nshape = \"sphere\"\nradius_m = {:.4g}\nmoves = \"{}\"\n"
      "stiffness_n_m2 = {:.4g}\nfriction = {}\n",
      draw.uniform(0.09, 0.1 + 0.3 * reach), draw.chance(0.5) ? "fixed" : "head",
      draw.of_size(0.1, 300), draw.one_of({0.0, 0.3, 2.0}));
}

std::string wind(Draw& draw) {
  return fmt::format(
      "[effects.wind]\nvelocity_m_s = [{:.3g}, 0, 1]\nprofile = \"{}\"\nlaw = \"{}\"\n",
      draw.of_size(0.3, 30), draw.one_of({"steady", "sine"}),
      draw.one_of({"force", "quadratic"}));
}

}  // namespace

std::string random_head(std::uint64_t seed) {
  Draw draw(seed);
  const std::string_view model =
      draw.one_of({"super_helix", "articulated_chain", "mass_spring"});
  const std::string_view method =
      draw.one_of({"semi_implicit_euler", "semi_implicit_euler", "backward_euler",
                   "linearly_implicit_midpoint", "tr_bdf2"});
  const bool springs = model == "mass_spring", single = method == "semi_implicit_euler";
  const double length = draw.of_size(0.02, 0.8), radius = draw.of_size(1e-5, 4e-4),
               modulus = draw.of_size(1e5, 1e10);
  const double density = draw.one_of({100.0, 1300.0, 8000.0});
  const int elements = draw.one_of({1, 2, 4, 6, 8, 16, 23});
  const double step = draw.of_size(1e-4, 2e-2);
  const int steps = draw.one_of({10, 20, 40, 80});
  std::string text = fmt::format(
      "title = \"pair\"\nduration_s = {:.6g}\nframes_1_s = {:.6g}\n[model]\nid = "
      "\"{}\"\n",
      steps * step, 10 / (steps * step), model);
  if (!springs) {
    text += fmt::format("tangent = \"{}\"\nmodes = \"{}\"\n", single ? "stiff" : "exact",
                        draw.one_of({"bend_twist", "bend_twist", "bend"}));
  }
  text += fmt::format(
      "[integrator]\nid = \"{}\"\ndt_s = {:.6g}\n[material]\nname = \"custom\"\n"
      "radius_m = {:.4g}\nyoungs_modulus_pa = {:.4g}\npoisson_ratio = {}\n"
      "density_kg_m3 = {}\nellipticity = {}\ninternal_friction_kg_m3_s = {:.4g}\n",
      method, step, radius, modulus, draw.one_of({0.0, 0.48}), density,
      springs ? 1.0 : draw.one_of({1.0, 1.0, 2.0, 0.3}),
      draw.chance(0.5) ? 0.0 : draw.of_size(1e-12, 1e-8));
  text += fmt::format(
      "[groom]\ncount = {}\nlength_variation = {}\nlength_m = {:.4g}\nelements = {}\n",
      draw.one_of({1, 3, 9, 17}), draw.one_of({0.3, 0.9}), length, elements);
  if (draw.chance(0.5)) {
    const double curl = length * draw.of_size(0.08, 12);
    text +=
        fmt::format("shape = \"helix\"\ncurl_radius_m = {:.4g}\ncurl_pitch_m = {:.4g}\n",
                    curl, curl * draw.one_of({1.0, -1.0, 0.2}));
  }
  text += fmt::format("initial = \"{}\"\n", draw.one_of({"natural", "straight"}));
  if (draw.chance(0.6)) {
    text += fmt::format("[root]\nmotion = \"{}\"\n",
                        draw.one_of({"shake", "rotate", "stop", "translate", "head"}));
  }
  if (draw.chance(0.8)) text += "[effects.gravity]\n";
  if (draw.chance(0.5)) {
    text += fmt::format("[effects.linear_drag]\ndrag_kg_m_s = {:.3g}\n",
                        draw.of_size(1e-6, 1e-2));
  }
  if (draw.chance(0.4)) text += body(draw, length);
  if (single && !springs && draw.chance(0.3)) text += wind(draw);
  if (single && !springs && draw.chance(0.2)) {
    text += "[effects.strand_interaction]\ncoupling = \"lagged\"\n";
  }
  return text;
}

}  // namespace tress::testing_support
