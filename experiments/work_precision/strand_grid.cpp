#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/work_precision/work_precision.h"
#include "integrators/catalogue.h"

namespace tress::experiments::work_precision {
namespace {

/// Accuracy and matrix of the solution of a step's equations. Tolerances are over
/// System::scale: 0.3 is a curvature of 0.3 over the length of the strand.
struct Newton {
  Refresh refresh = Refresh::every_iteration;
  double tolerance = 0;  // 0: the method does not iterate, or SUNDIALS does
};
constexpr Newton converged{Refresh::every_iteration, 1e-10};
constexpr Newton loose{Refresh::every_step, 0.3};
constexpr Newton lazy{Refresh::when_slow, 0.1};

struct Variation {
  std::string_view integrator;
  std::string_view tangent = {};
  Newton newton = {};
  int max_order = 0;
  bool full_only = false;
};

constexpr Variation methods[] = {
    {"implicit_midpoint", "stiff", loose},
    {"implicit_midpoint", "stiff", lazy},
    {"implicit_midpoint", "exact", loose},
    {"implicit_midpoint", "exact", converged},
    {"linearly_implicit_midpoint", "stiff"},
    {"linearly_implicit_midpoint", "exact"},
    {"generalized_alpha", "stiff", loose},
    {"generalized_alpha", "exact", converged, 0, true},
    {"newmark", "stiff", loose},
    {"newmark", "exact", converged, 0, true},
    {"bdf2", "stiff", loose},
    {"bdf2", "exact", converged, 0, true},
    {"backward_euler", "stiff", loose},
    {"backward_euler", "exact", converged, 0, true},
    {"semi_implicit_euler", "stiff"},
    {"semi_implicit_euler", "exact"},
    {"ida", "exact", {}, 2},
    {"ida", "exact", {}, 5},
    {"ida", "stiff", {}, 2, true},
    {"cvode_bdf", "exact"},
    {"cvode_bdf", "stiff", {}, 0, true},
    {"arkode_dirk", "exact"},
    {"arkode_dirk", "stiff", {}, 0, true},
    {"symplectic_euler"},
    {"velocity_verlet"},
    {"rk4"},
    {"explicit_euler", {}, {}, 0, true},
    {"cvode_adams"},
    {"arkode_erk"},
    {"gsl_rkf45"},
    {"gsl_rk8pd"},
    {"gsl_msadams", {}, {}, 0, true},
    {"gsl_bsimp", {}, {}, 0, true},
};

/// The methods compared on other strands and for the total error.
constexpr Variation best[] = {
    {"implicit_midpoint", "stiff", loose},
    {"linearly_implicit_midpoint", "stiff"},
};

struct Body {
  std::string_view model, modes, solver;
};
constexpr Body principal{"super_helix", "bend", "recursive"};
constexpr Body chain{"articulated_chain", "bend", "recursive"};
constexpr Body others[] = {
    {"super_helix", "bend", "composite"},
    {"super_helix", "bend", "sparse"},
    chain,
};

// Twist has almost no mass, so Newton's remaining error in it returns undamped and
// amplified: only converged steps or methods that damp fast modes succeed.
constexpr Body twisting{"super_helix", "bend_twist", "recursive"};
constexpr Variation twisting_methods[] = {
    {"implicit_midpoint", "stiff", loose, 0, true},
    {"implicit_midpoint", "exact", converged},
    {"linearly_implicit_midpoint", "stiff"},
    {"bdf2", "stiff", loose},
    {"bdf2", "exact", converged},
};

// Total error: the strand bends most at its root, so shorter elements there are worth
// trying beside equal ones.
constexpr double gradings[] = {1, 3};

/// Steps (s) or relative tolerances from loose to tight: loosest / base^(i exponent).
struct Ladder {
  double loosest, base, exponent;
  int rungs;
};

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

/// Whether step (s) and elements are balanced: both errors are of order 2, so the
/// cheapest way to a total error keeps step times elements between fixed bounds.
bool balanced(double step, int elements) {
  return step * elements >= 0.025 && step * elements <= 0.161;
}

std::string_view name(Refresh refresh) {
  switch (refresh) {
    case Refresh::every_iteration:
      return "every_iteration";
    case Refresh::every_step:
      return "every_step";
    case Refresh::when_slow:
      break;
  }
  return "when_slow";
}

/// Builds the list according to the user's options.
class Grid {
 public:
  Grid(const CommandLine& line, const Settings& settings)
      : line_(line), settings_(settings) {}

  std::vector<StrandCase> cases() {
    if (keeps(settings_, "scene", swing.name)) {
      add_swing_in_time();
      add_swing_in_all();
    }
    if (keeps(settings_, "scene", strand_release.name)) add_release();
    return std::move(all_);
  }

 private:
  void add_swing_in_time() {
    for (const int elements : counts({peer_elements})) {
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
                 .tangent = m.tangent,
                 .integrator = m.integrator,
                 .adaptive = entry.adaptive,
                 .newton = m.newton.tolerance > 0,
                 .options = {},
                 .elements = elements,
                 .grading = grading};
    c.options.max_order = m.max_order;
    c.options.refresh = m.newton.refresh;
    if (c.newton) c.options.newton_tolerance = m.newton.tolerance;
    add(c, ladder(entry, !m.tangent.empty(), line_));
  }

  /// Every model with its defaults. Half of the sizes show the order.
  void add_release() {
    const std::vector<int> sizes =
        counts(line_.quick ? std::initializer_list<int>{3, 5, 10, 20, 40}
                           : std::initializer_list<int>{3, 5, 7, 10, 14, 20, 28, 40});
    for (const ModelEntry* model : strand_models()) {
      for (const int elements : sizes) {
        const StrandCase c{.strand = &strand_release,
                           .error_kind = "total",
                           .model = model,
                           .modes = has_word(*model, "modes", "bend") ? "bend" : "",
                           .solver = first_word(*model, "solver"),
                           .tangent = first_word(*model, "tangent"),
                           .integrator = "implicit_midpoint",
                           .adaptive = false,
                           .newton = false,
                           .options = {},
                           .elements = elements,
                           .grading = 1};
        // The finest steps add nothing to a total error.
        add(c, {4e-3, 2, 1, line_.full ? 8 : line_.quick ? 3 : 5});
      }
    }
  }

  std::vector<int> counts(std::initializer_list<int> usual) const {
    return line_.elements.empty() ? std::vector<int>(usual) : line_.elements;
  }

  /// All rungs of one curve.
  void add(StrandCase c, const Ladder& rungs) {
    if (!keeps(settings_, "error", c.error_kind)) return;
    if (!keeps(settings_, "modes", c.modes)) return;
    if (!keeps(settings_, "solver", c.solver)) return;
    if (!keeps(settings_, "tangent", c.tangent)) return;
    if (!wanted(line_.models, c.model->id)) return;
    if (!wanted(line_.integrators, c.integrator)) return;
    const IntegratorEntry& entry = find_integrator(c.integrator);
    const auto system = c.model->make(c.parameters(settings_));
    const auto usable = usable_formulations(entry, *system);
    if (usable.empty()) return;
    c.options = settings_.options(c.options);
    c.options.formulation = usable.front();
    for (int i = 0; i < rungs.rungs; ++i) {
      const double x = rungs.loosest / std::pow(rungs.base, i * rungs.exponent);
      const bool both = c.strand == &swing && c.error_kind == "total";
      if (both && !c.adaptive && !balanced(x, c.elements)) continue;
      (c.adaptive ? c.options.rtol : c.options.step) = x;
      if (c.adaptive) c.options.atol = x;
      // --set can make two Newton settings equal.
      if (known_.insert(describe(c.identity())).second) all_.push_back(c);
    }
  }

  const CommandLine& line_;
  const Settings& settings_;
  std::vector<StrandCase> all_;
  std::set<std::string> known_;
};

}  // namespace

Row StrandCase::identity() const {
  Row row;
  row.set("scene", strand->name).set("error_kind", error_kind).set("model", model->id);
  row.set("modes", modes).set("solver", solver).set("tangent", tangent);
  row.set("integrator", integrator).set("formulation", tress::name(options.formulation));
  if (options.max_order > 0) row.set("max_order", options.max_order);
  if (newton) {
    row.set("newton_tolerance", options.newton_tolerance);
    row.set("refresh", name(options.refresh));
  }
  row.set("elements", elements).set("grading", grading);
  return adaptive ? row.set("rtol", options.rtol) : row.set("dt_s", options.step);
}

Parameters strand_parameters_of(const FollowedStrand& strand, const Settings& settings,
                                const ModelEntry& model, int elements) {
  Parameters p = settings.parameters(model);
  set_known(p, find_strand_scene(strand.scene).settings);
  set_known(p, {{"modes", "bend"}});
  p.set("elements", std::to_string(elements));
  return p;
}

Parameters StrandCase::parameters(const Settings& settings) const {
  Parameters p = strand_parameters_of(*strand, settings, *model, elements);
  p.set("grading", std::to_string(grading));
  if (!modes.empty()) p.set("modes", modes);
  if (!solver.empty()) p.set("solver", solver);
  if (!tangent.empty()) p.set("tangent", tangent);
  return p;
}

std::vector<StrandCase> strand_cases(const CommandLine& line, const Settings& settings) {
  return Grid(line, settings).cases();
}

}  // namespace tress::experiments::work_precision
