#include "experiments/problems/strand_problems.h"

#include <string>
#include <utility>

#include "experiments/problems/reference.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_reference.h"
#include "experiments/problems/strand_scenes.h"

namespace tress {
namespace {

constexpr std::string_view name = "strand_release";
constexpr double t_end = 0.25;  // s
constexpr int samples = 5;
constexpr double length = 0.1;        // m, the scene's
constexpr double coarse_step = 4e-3;  // s

ModelSettings settings(int elements) {
  ModelSettings all = find_strand_scene("release").settings;
  all.emplace_back("elements", std::to_string(elements));
  all.emplace_back("modes", "bend");
  return all;
}

/// Of a tip's x y z: it stays in the plane y = 0.
std::vector<double> in_plane(In tip) { return {tip[0], tip[2]}; }

std::vector<double> tip(System& system, const State& state) {
  return in_plane(In(points(system, state)).last(3));
}

Problem release(const ModelEntry& model, int elements) {
  return {.name = name,
          .model = model.id,
          .settings = known_to(model, settings(elements)),
          .t_end = t_end,
          .coarse_step = coarse_step,
          .scale = {length},
          .reference = checkpoints(t_end, samples),
          .reference_gap = 0,
          .compared = tip,
          .elements = elements,
          .solvers = {first_word(model, "solver")}};
}

Problem of_time(int elements) {
  Problem problem = computed(release(find_model("super_helix"), elements),
                             Formulation::parametric, Formulation::parametric);
  problem.solvers = {"recursive", "composite", "sparse"};
  problem.comparing = {"semi_implicit_euler", "implicit_midpoint", "ida"};
  return problem;
}

std::vector<Problem> of_rod() {
  const MakeStrand make = [](std::string_view model, int elements) {
    ModelSettings all = settings(elements);
    all.emplace_back("tangent", "stiff");
    return make_model(model, all);
  };
  const TipReference rod = converged_rod(make, {t_end, samples, length});
  const double gap = ReferenceGap(rod.tip, rod.other, std::vector<double>{length}).gap();
  std::vector<Problem> all;
  for (const ModelEntry* model : strand_models()) {
    for (const int elements : {3, 5, 7, 10, 14, 20, 28, 40}) {
      Problem problem = release(*model, elements);
      problem.error_kind = "total";
      problem.integrators = {"implicit_midpoint"};
      problem.reference_gap = gap;
      for (std::size_t k = 0; k < problem.reference.size(); ++k) {
        problem.reference[k].values = in_plane(In(rod.tip).subspan(3 * k, 3));
      }
      all.push_back(std::move(problem));
    }
  }
  return all;
}

}  // namespace

std::span<const Problem> strand_problems() {
  static const std::vector<Problem> all = [] {
    std::vector<Problem> list = of_rod();
    list.insert(list.begin(), of_time(10));
    return list;
  }();
  return all;
}

}  // namespace tress
