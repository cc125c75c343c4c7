#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "experiments/work_precision/strand_methods.h"
#include "experiments/work_precision/work_precision.h"
#include "integrators/catalogue.h"

namespace tress::experiments::work_precision {
namespace {

Ladder ladder(const IntegratorEntry& entry, bool implicit, const CommandLine& line) {
  const int more = line.full ? 3 : line.quick ? -1 : 0;
  if (entry.adaptive) {
    return implicit ? Ladder{0.1, 10, 0.5, 5 + 2 * more} : Ladder{0.1, 10, 1, 3 + more};
  }
  // Explicit steps beyond 1.25 ms are unstable at 20 elements.
  const double loosest = implicit ? 1e-2 : 1.25e-3;
  if (entry.order() == 1) return {loosest, 2, 1, (implicit ? 7 : 4) + more};
  return {loosest, 2, 0.5, (implicit ? 8 : 4) + more};
}

/// Models by which strands show an integrator. Constraints that hold lengths come before
/// forces, which explicit and position-based methods resolve badly.
constexpr std::string_view first_models[] = {"super_helix", "inextensible_strand",
                                             "mass_spring", "corde"};

/// Whether step (s) and elements are balanced: both errors are of order 2, so the
/// cheapest way to a total error keeps step times elements between fixed bounds.
bool balanced(double step, int elements) {
  return step * elements >= 0.025 && step * elements <= 0.161;
}

/// Builds the list according to the user's options.
class Grid {
 public:
  Grid(const CommandLine& line, const Settings& settings)
      : line_(line), settings_(settings) {}

  std::vector<StrandCase> cases() {
    if (keeps(settings_, "scene", swing.name)) {
      add_swing_in_time();
      add_others_to_swing();
      add_swing_in_all();
    }
    if (keeps(settings_, "scene", strand_release.name)) {
      add_release();
      add_every_method_to_release();
    }
    return std::move(all_);
  }

 private:
  /// The first strand model that the integrator can drive, in the order of first_models;
  /// null: none.
  const ModelEntry* first_driven(const IntegratorEntry& entry) const {
    std::vector<const ModelEntry*> models = strand_models();
    std::ranges::stable_sort(models, {}, [](const ModelEntry* model) {
      return std::ranges::find(first_models, model->id) - std::begin(first_models);
    });
    for (const ModelEntry* model : models) {
      if (!wanted(line_.models, model->id)) continue;
      const auto system = model->make(
          strand_parameters_of(swing, settings_, *model, controlled_elements));
      if (preferred_formulation(entry, *system)) return model;
    }
    return nullptr;
  }

  /// Integrators without a row of their own, with the defaults of their first model.
  void add_others_to_swing() {
    for (const IntegratorEntry& entry : integrator_catalogue()) {
      const bool listed =
          std::ranges::any_of(methods, [&entry, this](const Variation& m) {
            return m.integrator == entry.id && (line_.full || !m.full_only);
          });
      const ModelEntry* model = listed ? nullptr : first_driven(entry);
      if (model == nullptr) continue;
      const Body body{model->id, has_word(*model, "modes", "bend") ? "bend" : "",
                      first_word(*model, "solver")};
      const Variation m{
          entry.id, entry.tangent ? first_word(*model, "jacobian") : std::string_view()};
      for (const int elements : counts({simulator_elements})) {
        add_swing("time", body, m, elements, 1);
      }
    }
  }

  /// Every integrator on the first model that it can drive, for the order in time.
  void add_every_method_to_release() {
    for (const IntegratorEntry& entry : integrator_catalogue()) {
      const ModelEntry* model = first_driven(entry);
      if (model == nullptr) continue;
      for (const int elements : counts({controlled_elements})) {
        StrandCase c = released(*model, entry.id, "time", elements);
        c.adaptive = entry.adaptive;
        if (!entry.tangent) c.jacobian = "";
        add(c, ladder(entry, entry.tangent, line_));
      }
    }
  }

  void add_swing_in_time() {
    for (const int elements : counts({simulator_elements})) {
      for (const Variation& m : methods) add_swing("time", principal, m, elements, 1);
      for (const Body& body : others) {
        for (const Variation& m : best) add_swing("time", body, m, elements, 1);
      }
      for (const Variation& m : twisting_methods) {
        add_swing("time", twisting, m, elements, 1);
      }
    }
  }

  void add_swing_in_all() {
    const std::span<const Variation> total =
        line_.integrators.empty() ? std::span<const Variation>(best) : methods;
    const std::vector<int> sizes =
        counts(line_.quick ? std::initializer_list<int>{3, 5, 9, 12, 20, 40}
                           : std::initializer_list<int>{3, 5, 7, 9, 12, 16, 20, 28, 40});
    for (const int elements : sizes) {
      for (const Body& body : {principal, chain}) {
        for (const double grading : gradings) {
          for (const Variation& m : total) add_swing("total", body, m, elements, grading);
        }
      }
    }
  }

  void add_swing(std::string_view error, const Body& body, const Variation& m,
                 int elements, double grading) {
    if (m.full_only && !line_.full && line_.integrators.empty()) return;
    const IntegratorEntry& entry = find_integrator(m.integrator);
    StrandCase c{.strand = &swing,
                 .error_kind = error,
                 .model = &find_model(body.model),
                 .modes = body.modes,
                 .solver = body.solver,
                 .jacobian = m.jacobian,
                 .integrator = m.integrator,
                 .adaptive = entry.adaptive,
                 .newton = m.newton.tolerance > 0,
                 .options = {},
                 .elements = elements,
                 .grading = grading};
    c.options.max_order = m.max_order;
    c.options.refresh = m.newton.refresh;
    if (c.newton) c.options.newton_tolerance = m.newton.tolerance;
    add(c, ladder(entry, !m.jacobian.empty(), line_));
    if (error == "time") add_tolerances(c);
  }

  static StrandCase released(const ModelEntry& model, std::string_view integrator,
                             std::string_view error, int elements) {
    return {.strand = &strand_release,
            .error_kind = error,
            .model = &model,
            .modes = has_word(model, "modes", "bend") ? "bend" : "",
            .solver = first_word(model, "solver"),
            .jacobian = first_word(model, "jacobian"),
            .integrator = integrator,
            .adaptive = false,
            .newton = false,
            .options = {},
            .elements = elements,
            .grading = 1};
  }

  /// Every model with its defaults. Half of the sizes show the order.
  void add_release() {
    const std::vector<int> sizes =
        counts(line_.quick ? std::initializer_list<int>{3, 5, 10, 20, 40}
                           : std::initializer_list<int>{3, 5, 7, 10, 14, 20, 28, 40});
    for (const ModelEntry* model : strand_models()) {
      for (const int elements : sizes) {
        // The finest steps add nothing to a total error.
        add(released(*model, "implicit_midpoint", "total", elements),
            {4e-3, 2, 1,
             line_.full    ? 8
             : line_.quick ? 3
                           : 5});
      }
      add_release_by_tolerance(*model);
    }
  }

  /// Whether error control keeps its promise depends on the model.
  void add_release_by_tolerance(const ModelEntry& model) {
    for (const int elements : counts({controlled_elements})) {
      for (const IntegratorEntry& entry : integrator_catalogue()) {
        if (!entry.error_controlled) continue;
        add_tolerances(released(model, entry.id, "time", elements));
      }
    }
  }

  std::vector<int> counts(std::initializer_list<int> usual) const {
    return line_.elements.empty() ? std::vector<int>(usual) : line_.elements;
  }

  /// Whether the user and the method want it; then with its options and `tolerance`.
  bool ready(StrandCase& c, double tolerance) const {
    if (!keeps(settings_, "error", c.error_kind)) return false;
    if (!keeps(settings_, "modes", c.modes)) return false;
    if (!keeps(settings_, "solver", c.solver)) return false;
    if (!keeps(settings_, "jacobian", c.jacobian)) return false;
    if (!wanted(line_.models, c.model->id)) return false;
    if (!wanted(line_.integrators, c.integrator)) return false;
    const IntegratorEntry& entry = find_integrator(c.integrator);
    const auto system = c.model->make(c.parameters(settings_));
    const auto formulation = preferred_formulation(entry, *system, tolerance);
    if (!formulation) return false;
    c.options = settings_.options(c.options);
    c.options.formulation = *formulation;
    c.options.tolerance = tolerance;
    return true;
  }

  void put(const StrandCase& c) {
    // --set can make two Newton settings equal.
    if (known_.insert(describe(c.identity())).second) all_.push_back(c);
  }

  /// The curve of a method that controls its error, which settles Newton's tolerance.
  void add_tolerances(StrandCase c) {
    if (!find_integrator(c.integrator).error_controlled) return;
    c.newton = false;
    for (const double tolerance : tolerances(line_)) {
      if (ready(c, tolerance)) put(c);
    }
  }

  /// All rungs of one curve.
  void add(StrandCase c, const Ladder& rungs) {
    if (!ready(c, 0)) return;
    for (int i = 0; i < rungs.rungs; ++i) {
      const double x = rungs.loosest / std::pow(rungs.base, i * rungs.exponent);
      const bool both = c.strand == &swing && c.error_kind == "total";
      if (both && !c.adaptive && !balanced(x, c.elements)) continue;
      (c.adaptive ? c.options.rtol : c.options.step) = x;
      if (c.adaptive) c.options.atol = x;
      put(c);
    }
  }

  const CommandLine& line_;
  const Settings& settings_;
  std::vector<StrandCase> all_;
  std::set<std::string> known_;
};

}  // namespace

std::vector<StrandCase> strand_cases(const CommandLine& line, const Settings& settings) {
  return Grid(line, settings).cases();
}

}  // namespace tress::experiments::work_precision
