#include "tests/fuzz/random_head.h"

#include <fmt/format.h>

#include <span>
#include <string_view>
#include <vector>

#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "tests/fuzz/random_effects.h"

namespace tress::testing_support {
namespace {

/// A scene of what has SIMD lanes.
std::string with_lanes(Draw& draw) {
  const std::string_view model =
      draw.one_of({"super_helix", "super_clothoid", "articulated_chain", "mass_spring",
                   "corde", "xpbd_cosserat"});
  const std::string_view method =
      draw.one_of({"linearly_implicit_euler", "linearly_implicit_euler", "backward_euler",
                   "linearly_implicit_midpoint", "tr_bdf2"});
  const bool quaternions = model == "corde" || model == "xpbd_cosserat",
             nodes = quaternions || model == "mass_spring",
             single = method == "linearly_implicit_euler";
  const double length = draw.of_size(0.02, 0.8), radius = draw.of_size(1e-5, 4e-4),
               modulus = draw.of_size(1e5, 1e10);
  const double density = draw.one_of({100.0, 1300.0, 8000.0});
  const int elements = draw.one_of({1, 2, 4, 6, 8, 16, 23});
  const double step = draw.of_size(1e-4, 2e-2);
  const int steps = draw.one_of({10, 20, 40, 80});
  std::string text = fmt::format(
      "title = \"pair\"\nduration_s = {:.6g}\nframes_per_s = {:.6g}\n[model]\nid = "
      "\"{}\"\n",
      steps * step, 10 / (steps * step), model);
  if (!nodes) {
    text += fmt::format("jacobian = \"{}\"\nmodes = \"{}\"\nrotary_inertia = \"{}\"\n",
                        single ? "elastic" : "exact",
                        draw.one_of({"bend_twist", "bend_twist", "bend"}),
                        draw.one_of({"on", "off"}));
  }
  text += fmt::format(
      "[integrator]\nid = \"{}\"\ndt_s = {:.6g}\n[material]\nname = \"custom\"\n"
      "radius_m = {:.4g}\nyoungs_modulus_pa = {:.4g}\npoisson_ratio = {}\n"
      "density_kg_m3 = {}\nellipticity = {}\ninternal_friction_kg_m3_s = {:.4g}\n",
      method, step, radius, modulus, draw.one_of({0.0, 0.48}), density,
      nodes ? 1.0 : draw.one_of({1.0, 1.0, 2.0, 0.3}),
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
  if (draw.chance(0.4)) text += body(draw);
  if (single && !nodes && draw.chance(0.3)) text += wind(draw);
  if (single && !nodes) text += further(draw, length);
  if (single && !nodes && draw.chance(0.2)) {
    text += "[effects.strand_interaction]\ncoupling = \"lagged\"\n";
  }
  text += moving_body(draw, length);
  return text;
}

/// Some options of a model or a method, each a word of its choices.
std::string options(Draw& draw, std::span<const Parameter> all) {
  std::string text;
  for (const Parameter& p : all) {
    if (p.choices.empty() || !draw.chance(0.2)) continue;
    std::vector<std::string_view> words;
    for (std::size_t from = 0; from <= p.choices.size();) {
      const std::size_t to = std::min(p.choices.find('|', from), p.choices.size());
      words.push_back(p.choices.substr(from, to - from));
      from = to + 1;
    }
    text += fmt::format("{} = \"{}\"\n", p.name, draw.of(words));
  }
  return text;
}

/// How an integrator takes the equations of a model, and its steps.
std::string integrator(Draw& draw, const integrators::IntegratorEntry& entry,
                       bool constrained, double step) {
  std::string text = fmt::format("[integrator]\nid = \"{}\"\n", entry.id);
  if (constrained) {
    text += fmt::format("formulation = \"{}\"\n",
                        name(draw.of(entry.formulations).formulation));
  }
  if (entry.error_controlled && draw.chance(0.4)) {
    return text + fmt::format("position_tol_rel = {:.2g}\nmin_step_s = 1e-6\n",
                              draw.of_size(1e-4, 1e-2));
  }
  if (entry.adaptive) {
    return text +
           fmt::format("rtol = {:.2g}\nmax_steps = 1000\n", draw.of_size(1e-6, 1e-2));
  }
  text += fmt::format("dt_s = {:.6g}\n", step);
  if (entry.tangent && draw.chance(0.2)) text += "refresh = \"when_slow\"\n";
  return text;
}

std::string effects(Draw& draw, double length, int count) {
  std::string text;
  if (draw.chance(0.9)) text += "[effects.gravity]\n";
  if (draw.chance(0.4)) {
    text += fmt::format("[effects.linear_drag]\ndrag_kg_m_s = {:.3g}\n",
                        draw.of_size(1e-6, 1e-3));
  }
  if (draw.chance(0.2)) text += wind(draw);
  text += further(draw, length);
  if (draw.chance(0.15)) text += "[effects.self_contact]\n";
  if (draw.chance(0.25)) {
    text += body(draw) + (draw.chance(0.4) ? "friction_law = \"exact\"\n" : "");
  }
  if (count > 1 && draw.chance(0.2)) {
    text += fmt::format("[effects.strand_interaction]\ncoupling = \"{}\"\n",
                        draw.one_of({"lagged", "lagged", "monolithic"}));
  }
  return text;
}

/// Sections and materials that vary along the strands.
std::string along(Draw& draw) {
  std::string text;
  for (const char* key :
       {"radius_along", "ellipticity_along", "modulus_along", "density_along"}) {
    if (!draw.chance(0.1)) continue;
    text +=
        fmt::format("{} = [[0, 1], [{:.3g}, {:.3g}], [1, {:.3g}]]\n", key,
                    draw.of_size(0.1, 0.9), draw.of_size(0.5, 2), draw.of_size(0.5, 2));
  }
  return text;
}

/// Of any model of strands, integrator, option and effect.
std::string of_anything(Draw& draw) {
  std::vector<const models::ModelEntry*> strand_models;
  for (const models::ModelEntry& entry : models::model_catalogue()) {
    if (entry.on_strand != nullptr) strand_models.push_back(&entry);
  }
  const models::ModelEntry& model = *draw.of(strand_models);
  const integrators::IntegratorEntry& method =
      draw.of(integrators::integrator_catalogue());
  const bool constrained =
      model.id == "inextensible_strand" || model.id == "dynamic_spline";
  const double length = draw.of_size(0.02, 0.4), step = draw.of_size(1e-4, 5e-3);
  const int steps = draw.one_of({4, 8, 16}), count = draw.one_of({1, 2, 3, 6});
  std::string text =
      fmt::format("title = \"pair\"\nduration_s = {:.6g}\nframes_per_s = {:.6g}\n",
                  steps * step, 4 / (steps * step));
  if (draw.chance(0.7)) text += "failed_strands = \"stay\"\n";
  if (draw.chance(0.1)) text += "rest = \"inverse\"\nunstable = \"keep\"\n";
  text +=
      fmt::format("[model]\nid = \"{}\"\n", model.id) + options(draw, model.parameters);
  text += integrator(draw, method, constrained, step);
  text += fmt::format(
      "[material]\nname = \"custom\"\nradius_m = {:.4g}\nyoungs_modulus_pa = {:.4g}\n"
      "poisson_ratio = 0.48\ndensity_kg_m3 = 1300\nellipticity = {}\n"
      "internal_friction_kg_m3_s = {:.4g}\n",
      draw.of_size(2e-5, 2e-4), draw.of_size(1e6, 1e10), draw.one_of({1.0, 1.0, 1.5}),
      draw.chance(0.5) ? 0.0 : draw.of_size(1e-12, 1e-9));
  text += fmt::format(
      "[groom]\ncount = {}\nlength_variation = 0.3\nlength_m = {:.4g}\n"
      "elements = {}\n",
      count, length, draw.one_of({1, 2, 4, 7}));
  if (draw.chance(0.2)) text += "grading = 1.5\n";
  if (draw.chance(0.4)) {
    const double curl = length * draw.of_size(0.08, 2);
    text += fmt::format(
        "shape = \"helix\"\ncurl_radius_m = {:.4g}\ncurl_pitch_m = {:.4g}\n", curl, curl);
  }
  std::string root;
  if (draw.chance(0.6)) {
    root = fmt::format("[root]\nmotion = \"{}\"\n",
                       draw.one_of({"shake", "rotate", "stop", "translate", "free"}));
  }
  const std::string acting = effects(draw, length, count);
  return text + along(draw) + root + acting + driven(draw) + moving_body(draw, length);
}

}  // namespace

std::string random_head(std::uint64_t seed) {
  Draw draw(seed);
  return draw.chance(0.4) ? with_lanes(draw) : of_anything(draw);
}

}  // namespace tress::testing_support
