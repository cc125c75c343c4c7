#include "integrators/catalogue.h"

#include <algorithm>
#include <vector>

#include "contract/forms/bordered_form.h"
#include "contract/forms/contact_form.h"
#include "contract/forms/sparse_form.h"
#include "contract/open_catalogue.h"
#include "contract/parameters.h"
#include "integrators/integrator_options.h"

/// Every method, in listing order: one line each.
#define TRESS_METHODS(METHOD)        \
  METHOD(explicit_euler)             \
  METHOD(symplectic_euler)           \
  METHOD(velocity_verlet)            \
  METHOD(rk4)                        \
  METHOD(rattle)                     \
  METHOD(predictor_corrector)        \
  METHOD(linearly_implicit_euler)    \
  METHOD(backward_euler)             \
  METHOD(implicit_midpoint)          \
  METHOD(linearly_implicit_midpoint) \
  METHOD(bdf2)                       \
  METHOD(tr_bdf2)                    \
  METHOD(esdirk43)                   \
  METHOD(guarded)                    \
  METHOD(guarded_esdirk43)           \
  METHOD(radau5)                     \
  METHOD(rodas5p)                    \
  METHOD(newmark)                    \
  METHOD(generalized_alpha)          \
  METHOD(xpbd)                       \
  METHOD(xpbd_bdf2)                  \
  METHOD(vbd)                        \
  METHOD(vbd_augmented)              \
  METHOD(stable_cosserat_rods)       \
  METHOD(gsl_rkf45)                  \
  METHOD(gsl_rk8pd)                  \
  METHOD(gsl_msadams)                \
  METHOD(gsl_bsimp)                  \
  METHOD(cvode_adams)                \
  METHOD(cvode_bdf)                  \
  METHOD(arkode_erk)                 \
  METHOD(arkode_dirk)                \
  METHOD(arkode_ark)                 \
  METHOD(arkode_mri)                 \
  METHOD(ida)

namespace tress::integrators {

// Each is defined in its method's file.
#define TRESS_DECLARE(id) IntegratorEntry id##_entry();
TRESS_METHODS(TRESS_DECLARE)
#undef TRESS_DECLARE

namespace {

std::vector<IntegratorEntry> built_in_integrators() {
#define TRESS_ENTRY(id) id##_entry(),
  return {TRESS_METHODS(TRESS_ENTRY)};
#undef TRESS_ENTRY
}

OpenCatalogue<IntegratorEntry>& all_integrators() {
  static OpenCatalogue<IntegratorEntry> all("integrator", built_in_integrators());
  return all;
}

}  // namespace

std::span<const IntegratorEntry> integrator_catalogue() {
  static const std::span<const IntegratorEntry> closed = all_integrators().close();
  return closed;
}

std::span<const IntegratorEntry> added_integrators() { return all_integrators().added(); }

void add_integrator(const IntegratorEntry& method, const std::string& where) {
  const std::string name = "integrator '" + std::string(method.id) + "'";
  refuse_if(method.make == nullptr || method.objection == nullptr,
            name + " cannot be made", where, "set IntegratorEntry::make");
  refuse_if(method.formulations.empty(), name + " has no formulation", where,
            "say in IntegratorEntry::formulations how it takes equations, and its order");
  for (const Parameter& p : method.parameters) {
    const auto declares = [&](std::span<const Parameter> list) {
      return list.data() != method.parameters.data() &&  // a family's
             std::ranges::count(list, p.name, &Parameter::name) > 0;
    };
    refuse_if(declares(common_options()) ||
                  std::ranges::any_of(all_integrators().entries(), declares,
                                      &IntegratorEntry::parameters),
              name + " declares '" + std::string(p.name) + "', an option of others",
              where, "give it another name");
  }
  all_integrators().add(method, where);
}

const IntegratorEntry& find_integrator(std::string_view id) {
  std::vector<std::string_view> ids;
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    if (entry.id == id) return entry;
    ids.push_back(entry.id);
  }
  throw InputError("unknown integrator '" + std::string(id) + "'", "--integrators",
                   suggestion(id, ids, "--list shows the integrators"));
}

namespace {

/// Why a method cannot drive a system with these contacts; empty: it can.
std::string refusal(Contact of_method, const ContactForm& contacts) {
  const Contact needed = contacts.rebounds() ? Contact::exact_rebounding : Contact::exact;
  if (of_method >= needed) return {};
  std::string able;
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    if (entry.contact < needed) continue;
    able += (able.empty() ? "" : ", ") + std::string(entry.id);
  }
  return (contacts.rebounds()
              ? "restitution needs the speed before an impact in the step's one solution"
              : "exact friction holds at the end of a step, for which it does not "
                "solve") +
         std::string(": use ") + able;
}

}  // namespace

std::string refusal(const IntegratorEntry& entry, System& system,
                    Formulation formulation) {
  const bool constrained = system.layout().constraints > 0;
  if (constrained && formulation == Formulation::parametric) {
    return "the model has constraints: choose a formulation of them";
  }
  if (!constrained && formulation != Formulation::parametric) {
    return "the model has no constraints and needs the formulation parametric";
  }
  if (!entry.order(formulation)) return std::string(entry.gap(formulation));
  if (constrained && bordered_form(system) == nullptr &&
      system.sparse_form() == nullptr) {
    return "constraints need the model's sparse form";
  }
  if (ContactForm* contacts = system.contact_form()) {
    std::string reason = refusal(entry.contact, *contacts);
    if (!reason.empty()) return reason;
  }
  return entry.objection(system, formulation);
}

Options with_tolerance(const IntegratorEntry& entry, Options options) {
  if (options.tolerance == 0 || entry.error_controlled) return options;
  if (!entry.adaptive) {
    std::string able;
    for (const IntegratorEntry& other : integrator_catalogue()) {
      if (!other.adaptive && !other.error_controlled) continue;
      able += (able.empty() ? "" : ", ") + std::string(other.id);
    }
    throw InputError(std::string(entry.id) + " has a fixed step and takes no tolerance",
                     "integrator", "give a step, or use one of: " + able);
  }
  // As the defaults of rtol and atol are to each other.
  options.rtol = options.tolerance;
  options.atol = options.tolerance * Options{}.atol / Options{}.rtol;
  options.tolerance = 0;
  return options;
}

std::unique_ptr<Integrator> make_integrator(std::string_view id, System& system,
                                            const Options& options) {
  const IntegratorEntry& entry = find_integrator(id);
  const std::string reason = refusal(entry, system, options.formulation);
  if (!reason.empty()) {
    throw InputError(std::string(id) + " cannot drive this model as " +
                         std::string(name(options.formulation)),
                     reason, "--list shows what can drive what");
  }
  return entry.make(system, with_tolerance(entry, options));
}

}  // namespace tress::integrators
