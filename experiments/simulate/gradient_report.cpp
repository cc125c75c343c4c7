#include "experiments/simulate/gradient_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/run/message.h"
#include "simulation/errors/halved_step.h"
#include "simulation/files/csv.h"
#include "simulation/files/files.h"
#include "simulation/gradient/scene_gradient.h"
#include "simulation/scene/strand_tables.h"

namespace tress::experiments::scene_runs {
namespace {

constexpr std::size_t most_named = 8;
// Of the table, which is made in memory: a row for each derivative.
constexpr double row_bytes = 100, announced_bytes = 1e8, most_bytes = 2e9;

/// Of both runs of a strand that have this frame.
std::size_t frames(const StrandGradient& one, const StrandGradient& finer) {
  return std::min(one.points.size(), finer.points.size());
}

bool near_contact_change(const StrandGradient& strand, std::size_t frame) {
  return frame < strand.near_contact_change.size() && strand.near_contact_change[frame];
}

/// `ends`: the run ended after this frame, before that of the scene.
const char* status_at(const StrandGradient& strand, std::size_t frame, bool ends) {
  if (ends) return "unfinished";
  if (!strand.not_smooth.empty()) return "not_smooth";
  return near_contact_change(strand, frame) ? "contact_changes" : "ok";
}

std::string table_of(const Scene& scene, const SceneGradient& gradient,
                     const SceneGradient& finer) {
  const GradientOf of = gradient_of(scene.tables->gradient->values().word("of"));
  const double over_change = error_over_change(scene);
  std::string text = csv_line(
      std::vector<std::string>{"strand", "point", "time_s", "component", "by", "unit",
                               "derivative", "relative", "time_error", "status"});
  for (std::size_t k = 0; k < gradient.strands.size(); ++k) {
    const StrandGradient& strand = gradient.strands[k];
    const StrandGradient& other = finer.strands[k];
    const double length = scene.strands[k].length();
    const std::size_t last = frames(strand, other);
    const bool whole = strand.unfinished.empty() && other.unfinished.empty();
    if (last == 0) {
      text += csv_line(std::vector<std::string>{std::to_string(k), "", "", "", "", "", "",
                                                "", "", "unfinished"});
    }
    for (std::size_t f = of == GradientOf::last_tip ? std::max<std::size_t>(last, 1) - 1
                                                    : 0;
         f < last; ++f) {
      const std::size_t numbers = strand.points[f].size();
      const bool ends = !whole && f + 1 == last;
      const char* const status = status_at(strand, f, ends);
      for (std::size_t i = of == GradientOf::points ? 0 : numbers - 3; i < numbers; ++i) {
        for (std::size_t j = 0; j < gradient.parameters.size(); ++j) {
          const SceneParameter& by = gradient.parameters[j];
          const double derivative = strand.by[j][f][i];
          const std::string relative =
              by.value == 0 ? "" : fmt::format("{:.6g}", derivative * by.value / length);
          text += csv_line(std::vector<std::string>{
              std::to_string(k), std::to_string(i / 3),
              fmt::format("{:.9g}", scene.time_of(f)), std::string(1, "xyz"[i % 3]),
              by.name, "m/(" + by.unit + ")", fmt::format("{:.9g}", derivative), relative,
              fmt::format("{:.3g}",
                          over_change * std::abs(derivative - other.by[j][f][i])),
              status});
        }
      }
    }
  }
  return text;
}

double size_of_tip(const std::vector<double>& x) {
  return std::hypot(x[x.size() - 3], x[x.size() - 2], x[x.size() - 1]);
}

/// "1 % of youngs_modulus_pa moves it by 0.12 mm" and its estimated error, of the last
/// tip.
void tell_parameter(const Scene& scene, const SceneGradient& gradient,
                    const SceneGradient& finer, std::size_t j) {
  const SceneParameter& by = gradient.parameters[j];
  const StrandGradient& strand = gradient.strands.front();
  const StrandGradient& other = finer.strands.front();
  const std::size_t f = frames(strand, other) - 1;
  std::vector<double> apart = strand.by[j][f];
  for (std::size_t i = 0; i < apart.size(); ++i) apart[i] -= other.by[j][f][i];
  constexpr double percent = 0.01, mm = 1e3;
  const double size = size_of_tip(strand.by[j][f]);
  if (size == 0) {
    tell("simulate: {}: gradient: {} does not move the tip at {:g} s\n", scene.name,
         by.name, scene.time_of(f));
    return;
  }
  const double change = by.value != 0 ? percent * std::abs(by.value) : 1;
  const std::string of =
      by.value != 0 ? "1 % of " + by.name : fmt::format("1 {} of {}", by.unit, by.name);
  tell(
      "simulate: {}: gradient: {} moves the tip by {:.3g} mm at {:g} s; estimated error "
      "in time {:.2g} %\n",
      scene.name, of, mm * change * size, scene.time_of(f),
      error_over_change(scene) * size_of_tip(apart) / size / percent);
}

/// Derivatives by a number of the material where strands have materials of their own.
void tell_of_materials(const Scene& scene, const SceneGradient& gradient) {
  const auto of_material = [](const SceneParameter& by) {
    return by.positive && by.name.find('.') == std::string::npos;
  };
  const bool own = std::ranges::any_of(
      scene.tables->sources,
      [](const StrandSource& source) { return source.material.has_value(); });
  if (!own || std::ranges::none_of(gradient.parameters, of_material)) return;
  tell(
      "simulate: {}: gradient: strands have materials of their own: derivatives by "
      "numbers of the material are per unit of the number of strand 0, and those of all "
      "strands change in the same proportion\n",
      scene.name);
}

void warn_of_contact(const Scene& scene, const SceneGradient& gradient) {
  std::size_t all = 0, near = 0;
  for (const StrandGradient& strand : gradient.strands) {
    all += strand.near_contact_change.size();
    near +=
        static_cast<std::size_t>(std::ranges::count(strand.near_contact_change, true));
  }
  if (near == 0) return;
  tell(
      "simulate: {}: gradient: warning: a contact opens, closes, comes to rest or begins "
      "to slide within a step of {} of {} frames: status contact_changes\n",
      scene.name, near, all);
}

}  // namespace

void check_gradient_table(const Scene& scene) {
  const double rows = count_of_derivatives(scene);
  refuse_if(
      rows * row_bytes > most_bytes,
      fmt::format("the table of derivatives would have {:.2g} rows, about {:.2g} GB",
                  rows, rows * row_bytes / 1e9),
      gradient_place(scene),
      "set of = \"last_tip\", a lower frames_per_s, or fewer parameters");
}

bool report_gradient(const Scene& scene, const std::string& file) {
  const double rows = count_of_derivatives(scene);
  if (rows * row_bytes > announced_bytes) {
    tell("simulate: {}: gradient: a table of {:.2g} rows, about {:.2g} MB\n", scene.name,
         rows, rows * row_bytes / 1e6);
  }
  const SceneGradient gradient = scene_gradient(scene), finer = scene_gradient(scene, 2);
  replace_file(file, table_of(scene, gradient, finer));
  tell_of_materials(scene, gradient);
  warn_of_contact(scene, gradient);
  bool finished = true;
  for (const SceneGradient* one : {&gradient, &finer}) {
    for (std::size_t k = 0; k < one->strands.size(); ++k) {
      const StrandGradient& strand = one->strands[k];
      if (strand.unfinished.empty()) continue;
      finished = false;
      tell("simulate: {}: gradient of strand {} not finished: {}\n", scene.name, k,
           strand.unfinished);
    }
  }
  if (frames(gradient.strands.front(), finer.strands.front()) > 0) {
    const std::size_t named = std::min(most_named, gradient.parameters.size());
    for (std::size_t j = 0; j < named; ++j) tell_parameter(scene, gradient, finer, j);
  }
  if (scene.options.tolerance > 0) {
    tell(
        "simulate: {}: gradient: of the run with its accepted steps frozen, whose points "
        "are within {:.2g} of the length of the run's\n",
        scene.name, std::ranges::max(gradient.strands, {}, &StrandGradient::moved).moved);
  }
  const bool adjoint = std::ranges::any_of(gradient.strands, &StrandGradient::adjoint);
  tell("simulate: {}: gradient: {} parameters{}{} -> {}\n", scene.name,
       gradient.parameters.size(), gradient.damped ? ", damped start" : "",
       adjoint ? ", adjoint" : "", file);
  return finished;
}

}  // namespace tress::experiments::scene_runs
