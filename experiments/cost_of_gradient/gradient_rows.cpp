#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "experiments/cost_of_gradient/cost_of_gradient.h"
#include "experiments/problems/strand_models.h"
#include "experiments/run/command_line.h"
#include "integrators/catalogue.h"

namespace tress::experiments::cost_of_gradient {
namespace {

using integrators::GradientStart;
using simulation::Scene;

constexpr int usual_order = 2;  // half of the elements where it is higher
constexpr std::string_view finest_method = "esdirk43";
constexpr int steps_in_space = 80;
// Errors are told apart from that of a reference if they are so many times its own.
constexpr double above_reference = 10;
constexpr Way as_run{.start = GradientStart::as_run};
constexpr Way elastic{.start = GradientStart::damped, .elastic = true};

std::string_view name(GradientStart start) {
  return start == GradientStart::damped ? "damped" : "as_run";
}

Row row_of(const Row& own, std::string_view model, std::string_view integrator,
           int elements_of, int steps, const Way& way = {}) {
  Row row = own;
  row.set("model", model).set("integrator", integrator).set("elements", elements_of);
  row.set("steps", steps).set("start", name(way.start));
  row.set("jacobian", way.elastic ? "elastic" : "exact");
  return row;
}

/// A course that errors refer to, and how far it may be off itself.
struct Reference {
  Course course;
  double gap = 0;  // relative, of the derivatives
};

void set_errors(Row& row, const Course& found, const Reference& reference) {
  row.set("linearizations", found.linearizations).set("time_s", found.time_s);
  if (!found.failure.empty() || !reference.course.failure.empty()) {
    const bool own = !found.failure.empty();
    row.failed("solver_error", own ? found.failure : reference.course.failure);
    return;
  }
  const double error = relative_error(found, reference.course);
  if (!std::isfinite(error)) {
    row.failed("diverged", "the derivatives are not finite");
    return;
  }
  row.set("tip_error_rel", tip_distance(found, reference.course) / strand_length);
  row.set("gradient_error_rel", error).set("reference_gap", reference.gap);
  for (std::size_t k = 0; k < std::size(parameters); ++k) {
    row.set(parameters[k].column, relative_error(found, reference.course, k));
  }
  if (error < above_reference * reference.gap) {
    row.failed("below_reference", "the error is below ten times the reference's own");
  }
}

Reference reference_in_time(const Scene& scene, int steps) {
  Reference found{course(scene, steps)};
  if (found.course.failure.empty()) {
    found.gap = relative_error(course(scene, steps / 2), found.course);
  }
  return found;
}

/// The elastic Jacobian is measured where derivatives of the residual do not come from
/// the model's matrices, which would be elastic, too.
bool has_elastic(const Scene& scene) {
  return has_word(*scene.model, "jacobian", "elastic") &&
         system_of(scene)->sparse_form() == nullptr;
}

}  // namespace

std::vector<std::string_view> gradient_methods(const Scene& scene,
                                               const std::vector<std::string>& chosen) {
  const auto system = system_of(scene);
  std::vector<std::string_view> all;
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    if (entry.stages > 0 && wanted(chosen, entry.id) &&
        refusal(entry, *system, scene.options.formulation).empty() &&
        !integrators::no_gradient(entry.id, *system, scene.options)) {
      all.push_back(entry.id);
    }
  }
  return all;
}

Sweep Sweep::quick() { return {{20, 40, 80, 160, 320}, {40}, {5, 10, 20}, {}, 640}; }
Sweep Sweep::full() {
  return {{20, 40, 80, 160, 320, 640}, {20, 40, 80, 160}, {5, 10, 20, 40}, {}, 2560};
}

std::vector<Row> time_rows(const Row& own, const Sweep& sweep) {
  const std::string model(own.text("model"));
  const ModelEntry& entry = models::find_model(model);
  const int count = entry.order > usual_order ? usual_elements / 2 : usual_elements;
  const Scene given = curl();
  const Reference reference =
      reference_in_time(with(given, model, finest_method, count), sweep.reference_steps);
  std::vector<Row> rows;
  for (const std::string_view method :
       gradient_methods(with(given, model, finest_method, count), sweep.integrators)) {
    const Scene scene = with(given, model, method, count);
    const auto add = [&](const std::vector<int>& all, const Way& way) {
      for (const int steps : all) {
        rows.push_back(row_of(own, model, method, count, steps, way));
        set_errors(rows.back(), course(scene, steps, way), reference);
      }
    };
    add(sweep.steps, {});
    add(sweep.other_steps, as_run);
    if (has_elastic(scene)) add(sweep.other_steps, elastic);
  }
  return rows;
}

std::vector<Row> space_rows(const Row& own, const Sweep& sweep,
                            const std::vector<std::string>& models) {
  const Scene given = curl();
  const auto run = [&](std::string_view model, int count) {
    return course(with(given, model, finest_method, count), steps_in_space);
  };
  const int finest = sweep.elements.back();
  const auto limit_of = [&](std::string_view model) {
    return extrapolated(run(model, finest), run(model, 2 * finest));
  };
  Reference reference{limit_of("super_helix")};
  reference.gap = relative_error(limit_of("der"), reference.course);
  std::vector<Row> rows;
  for (const std::string& model : models) {
    for (const int count : sweep.elements) {
      rows.push_back(row_of(own, model, finest_method, count, steps_in_space));
      set_errors(rows.back(), run(model, count), reference);
    }
  }
  return rows;
}

std::span<const ContactLaw> contact_laws() {
  static const std::vector<std::string_view> some{"backward_euler", "tr_bdf2",
                                                  "esdirk43"};
  static const std::array all{
      ContactLaw{"regularised, 0.5 N/m^2",
                 "stiffness_n_m2 = 0.5\nslip_speed_m_s = 0.02\n", some},
      ContactLaw{"regularised, 10 N/m^2", "stiffness_n_m2 = 10\nslip_speed_m_s = 0.001\n",
                 some},
      ContactLaw{"exact, rigid",
                 "friction_law = \"exact\"\nnormal = \"rigid\"\n",
                 {"bdf2", "backward_euler"}},
      ContactLaw{"exact, rigid, no friction",
                 "friction_law = \"exact\"\nnormal = \"rigid\"\nfriction = 0\n",
                 {"bdf2", "backward_euler"}}};
  return all;
}

std::vector<Row> contact_rows(const Row& own, const Sweep& sweep, const ContactLaw& law) {
  const Scene given = fall(law.table);
  const std::string_view model = "super_helix";
  const Reference reference = reference_in_time(
      with(given, model, law.integrators.back(), usual_elements), sweep.reference_steps);
  std::vector<Row> rows;
  for (const std::string_view method : law.integrators) {
    if (!wanted(sweep.integrators, method)) continue;
    for (const int steps : sweep.steps) {
      rows.push_back(row_of(own, model, method, usual_elements, steps));
      set_errors(rows.back(), course(with(given, model, method, usual_elements), steps),
                 reference);
    }
  }
  return rows;
}

namespace {

/// Rows of one method that differ in steps or elements, in order.
using Series = std::vector<Row*>;

void add_orders(const Series& series) {
  for (std::size_t i = 1; i < series.size(); ++i) {
    const Row &coarser = *series[i - 1], &row = *series[i];
    if (!coarser.ok() || !row.ok()) continue;
    const std::string_view by = row.text("part") == "space" ? "elements" : "steps";
    const double finer = std::log(row.number(by) / coarser.number(by));
    const auto order = [&](std::string_view error) {
      return std::log(coarser.number(error) / row.number(error)) / finer;
    };
    series[i]->set("tip_order", order("tip_error_rel"));
    series[i]->set("gradient_order", order("gradient_error_rel"));
  }
}

/// Linearizations for an error, by the power law between rows: of the coarsest one if
/// that meets it. Empty: no row does.
std::optional<double> needed(const Series& series, double target) {
  const Row* before = nullptr;
  for (const Row* row : series) {
    const double error = row->number("gradient_error_rel");
    const double work = row->number("linearizations");
    if (error <= target) {
      if (before == nullptr) return work;
      const double error_before = before->number("gradient_error_rel");
      const double work_before = before->number("linearizations");
      const double part =
          std::log(error_before / target) / std::log(error_before / error);
      return work_before * std::pow(work / work_before, part);
    }
    before = row->has("gradient_error_rel") ? row : nullptr;
  }
  return {};
}

}  // namespace

void compare(std::vector<Row>& rows) {
  std::map<std::string, Series> all;
  for (Row& row : rows) {
    all[joined(row, {"part", "law", "model", "integrator", "start", "jacobian"})]
        .push_back(&row);
  }
  for (const auto& [name_of_series, series] : all) {
    add_orders(series);
    const std::string_view part = series.front()->text("part");
    if (part == "space" || part == "fit") continue;
    for (const Target& target : targets) {
      const auto work = needed(series, target.error);
      for (Row* row : series) {
        if (work) row->set(target.column, *work);
      }
    }
  }
}

}  // namespace tress::experiments::cost_of_gradient
