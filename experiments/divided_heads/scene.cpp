#include "experiments/divided_heads/scene.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "experiments/divided_heads/cost_model.h"

namespace tress::experiments::divided_heads {
namespace {

constexpr double radius = 0.1;  // of the head, m
// s. Hairs that touch take some fifty times as long.
constexpr double duration(bool touch) { return touch ? 0.2 : 2; }

}  // namespace

double cap_angle(int strands) {
  const double area = strands / hair_density;  // 2 pi r^2 (1 - cos angle)
  return std::acos(1 - area / (2 * std::numbers::pi * radius * radius));
}

std::string scene(bool touch, int strands) {
  return fmt::format(
      "title = \"a head that processes divide\"\nduration_s = {}\nframes_per_s = 5\n"
      "[model]\nid = \"super_helix\"\njacobian = \"elastic\"\n[integrator]\n"
      "id = \"linearly_implicit_euler\"\ndt_s = 0.0025\n[material]\nname = "
      "\"hair.caucasian\"\n"
      "[groom]\ncount = {}\nelements = {}\nlength_m = 0.03\n"
      "half_axes_m = [{}, {}, {}]\ncap_axis = [0, 0, 1]\ncap_angle_rad = {}\n"
      "[root]\nmotion = \"shake\"\ndirection = [0, 1, 0]\namplitude_m = 0.02\n"
      "frequency_hz = 2\n[effects.gravity]\n[effects.linear_drag]\n"
      "drag_kg_m_s = 1e-4\n{}",
      duration(touch), strands, elements, radius, radius, radius, cap_angle(strands),
      touch ? "[effects.strand_interaction]\nstiffness_n_m2 = 2e-4\n"
              "viscosity_n_s_m2 = 2e-4\ninner_radius_m = 5e-4\n"
              "outer_radius_m = 1e-3\n"
            : "");
}

}  // namespace tress::experiments::divided_heads
