#include "models/strand/strand_parameters.h"

#include <cmath>
#include <iterator>
#include <vector>

#include "contract/input_error.h"
#include "models/effects/gravity.h"
#include "models/effects/linear_drag.h"
#include "models/motion/signals.h"

namespace tress::models {
namespace {

constexpr Parameter geometry_table[] = {
    {.name = "elements",
     .help = "number of elements n",
     .number = 20,
     .min = 1,
     .max = 10'000,
     .whole = true},
    {.name = "length_m",
     .help = "length of the strand (m)",
     .number = 0.1,
     .min = 1e-9,
     .max = 1e6},
    {.name = "grading",
     .help = "last element length over the first, geometric in between",
     .number = 1,
     .min = 1e-6,
     .max = 1e6},
    {.name = "radius_m",
     .help = "radius of the section; of an ellipse the geometric mean (m)",
     .number = 40e-6,
     .min = 1e-9,
     .max = 1e3},
    {.name = "ellipticity",
     .help = "half-axis along e1 over half-axis along e2",
     .number = 1,
     .min = 1e-3,
     .max = 1e3},
    {.name = "natural_curvature_per_m",
     .help = "curvature about e1 at rest (1/m)",
     .number = 0,
     .min = -1e6,
     .max = 1e6},
    {.name = "natural_curvature2_per_m",
     .help = "curvature about e2 at rest (1/m)",
     .number = 0,
     .min = -1e6,
     .max = 1e6},
    {.name = "natural_twist_per_m",
     .help = "twist about the tangent at rest (1/m)",
     .number = 0,
     .min = -1e6,
     .max = 1e6},
    {.name = "initial",
     .help = "shape at t = 0; bent: natural with initial_curvature_per_m more",
     .choices = "natural|straight|bent"},
    {.name = "initial_curvature_per_m",
     .help = "initial = bent: curvature about e1 added to the natural one (1/m)",
     .number = 0,
     .min = -1e6,
     .max = 1e6},
};

constexpr double default_poisson_ratio = 0.48;

constexpr Parameter material_table[] = {
    {.name = "youngs_modulus_pa",
     .help = "Young's modulus E (Pa)",
     .number = 3e9,
     .min = 1e-3,
     .max = 1e15},
    {.name = "shear_modulus_pa",
     .help = "shear modulus G (Pa) in place of poisson_ratio, for a material that is not "
             "isotropic; 0: G from poisson_ratio",
     .number = 0,
     .min = 0,
     .max = 1e15},
    {.name = "poisson_ratio",
     .help = "Poisson's ratio nu of an isotropic material, above -1: G = E/(2 (1 + nu))",
     .number = default_poisson_ratio,
     .min = -1,
     .max = 0.5},
    {.name = "density_kg_m3",
     .help = "density (kg/m^3)",
     .number = 1300,
     .min = 1e-6,
     .max = 1e9},
    {.name = "internal_friction_kg_m3_s",
     .help = "friction of bending and twisting gamma (kg m^3/s)",
     .number = 0,
     .min = 0,
     .max = 1e6},
    gravity_parameter,
    {.name = "drag_kg_m_s",
     .help = "air drag per length nu (kg/(m s))",
     .number = 0,
     .min = 0,
     .max = 1e6},
    {.name = "mass_damping_per_s",
     .help = "damping c m v; on a uniform strand drag nu = c rho A (1/s)",
     .number = 0,
     .min = 0,
     .max = 1e6},
    {.name = "root_tangent",
     .help = "tangent at the clamp: x, -z (down) or z (up)",
     .choices = "x|down|up"},
    {.name = "motion",
     .help = "motion of the root",
     .choices = "fixed|shake|rotate|shake_rotate|swing|stop|drop_pull|free"},
    {.name = "amplitude_m",
     .help = "shake, swing, drop_pull: amplitude (m)",
     .number = 0.05,
     .min = -1e6,
     .max = 1e6},
    {.name = "frequency_hz",
     .help = "shake, rotate, swing, drop_pull: frequency (Hz)",
     .number = 3,
     .min = 1e-6,
     .max = 1e6},
    {.name = "angle_rad",
     .help = "rotate: amplitude of the rotation about the vertical (rad)",
     .number = 0.5,
     .min = -1e3,
     .max = 1e3},
    {.name = "head_radius_m",
     .help = "rotate: distance of the root from the axis (m)",
     .number = 0.1,
     .min = 0,
     .max = 1e6},
    {.name = "speed_m_s",
     .help = "stop: speed of the root until t = 0 (m/s)",
     .number = 5,
     .min = -1e6,
     .max = 1e6},
    {.name = "time_s",
     .help = "stop: time to come to rest (s)",
     .number = 0.01,
     .min = 1e-9,
     .max = 1e6},
    {.name = "spin_rad_s",
     .help = "free: initial spin about (1, 1, 1) (rad/s)",
     .number = 10,
     .min = -1e6,
     .max = 1e6},
};

constexpr Vec x_axis{1, 0, 0}, y_axis{0, 1, 0}, z_axis{0, 0, 1}, down{0, 0, -1};

Frame root_frame(std::string_view tangent) {
  const Vec e0 = tangent == "x" ? x_axis : tangent == "down" ? down : z_axis;
  return {e0, y_axis, cross(e0, y_axis)};
}

CrossSection section(const Parameters& p) {
  const double radius = p.number("radius_m");
  const double stretch = std::sqrt(p.number("ellipticity"));
  return {radius * stretch, radius / stretch};
}

Vec natural_darboux(const Parameters& p) {
  return {p.number("natural_twist_per_m"), p.number("natural_curvature_per_m"),
          p.number("natural_curvature2_per_m")};
}

Vec initial_darboux(const Parameters& p) {
  const std::string_view initial = p.word("initial");
  if (initial == "straight") return {};
  const Vec natural = natural_darboux(p);
  if (initial == "natural") return natural;
  return natural + p.number("initial_curvature_per_m") * y_axis;
}

}  // namespace

std::span<const Parameter> strand_parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> list(std::begin(geometry_table), std::end(geometry_table));
    list.insert(list.end(), std::begin(material_table), std::end(material_table));
    return list;
  }();
  return all;
}

std::span<const Parameter> material_parameters() { return material_table; }

namespace {

double shear_modulus(const Parameters& p) {
  const double shear = p.number("shear_modulus_pa"), ratio = p.number("poisson_ratio");
  if (shear == 0) {
    if (ratio > -1) {
      return Material::shear_modulus_of(p.number("youngs_modulus_pa"), ratio);
    }
    throw InputError("poisson_ratio = -1 has no shear modulus", "material",
                     "give a number above -1, at most 0.5");
  }
  if (ratio == default_poisson_ratio) return shear;
  throw InputError("shear_modulus_pa and poisson_ratio are both given", "material",
                   "leave one of them out");
}

}  // namespace

Material material(const Parameters& parameters) {
  Material material;
  material.density = parameters.number("density_kg_m3");
  material.youngs_modulus = parameters.number("youngs_modulus_pa");
  material.shear_modulus = shear_modulus(parameters);
  material.internal_friction = parameters.number("internal_friction_kg_m3_s");
  return material;
}

RootMotion root_motion(const Parameters& parameters) {
  const std::string_view tangent = parameters.word("root_tangent");
  const std::string_view root = parameters.word("motion");
  const Vec sideways = tangent == "x" ? y_axis : x_axis;
  const double amplitude = parameters.number("amplitude_m");
  const double frequency = parameters.number("frequency_hz");

  RootMotion motion;
  motion.frame = root_frame(tangent);
  const auto translate = [&motion](Vec direction, Signal signal) {
    motion.translations.push_back({direction, std::move(signal)});
  };
  if (root == "shake" || root == "shake_rotate") {
    translate(sideways, sine(amplitude, frequency));
  }
  if (root == "rotate" || root == "shake_rotate") {
    motion.centre = -parameters.number("head_radius_m") * x_axis;
    motion.rotations.push_back({z_axis, sine(parameters.number("angle_rad"), frequency)});
  }
  if (root == "swing") translate(y_axis, one_minus_cosine(amplitude, frequency));
  if (root == "stop") {
    translate(sideways,
              stop(parameters.number("speed_m_s"), 0, parameters.number("time_s")));
  }
  if (root == "drop_pull") {
    translate(down, there_and_back(amplitude, 1 / (2 * frequency)));
  }
  return motion;
}

std::optional<FreeRoot> free_root(const Parameters& parameters) {
  if (parameters.word("motion") != "free") return std::nullopt;
  FreeRoot root;
  root.frame = root_frame(parameters.word("root_tangent"));
  root.spin = parameters.number("spin_rad_s") / std::sqrt(3.0) * Vec{1, 1, 1};
  return root;
}

Effects strand_effects(const Parameters& parameters) {
  Effects effects;
  const double gravity = parameters.number("gravity_m_s2");
  if (gravity != 0) effects.push_back(std::make_unique<Gravity>(gravity * down));
  const double drag = parameters.number("drag_kg_m_s");
  const double mass_damping = parameters.number("mass_damping_per_s");
  if (drag != 0 || mass_damping != 0) {
    effects.push_back(std::make_unique<LinearDrag>(drag, mass_damping));
  }
  return effects;
}

Strand strand(const Parameters& parameters) {
  Discretisation cut;
  cut.elements = parameters.whole("elements");
  cut.length = parameters.number("length_m");
  cut.grading = parameters.number("grading");
  Strand strand = make_strand(material(parameters), section(parameters), cut,
                              uniform_shape(natural_darboux(parameters)),
                              uniform_shape(initial_darboux(parameters)));
  strand.root = root_motion(parameters);
  strand.free_root = free_root(parameters);
  return strand;
}

}  // namespace tress::models
