#include "integrators/catalogue.h"

#include "models/input_error.h"

namespace tress {

std::span<const IntegratorEntry> integrators() { return {}; }

const IntegratorEntry& find_integrator(std::string_view id) {
  throw InputError("unknown integrator '" + std::string(id) + "'", "--integrators",
                   "--list shows the integrators");
}

std::string refusal(const IntegratorEntry& entry, System& system, Formulation formulation) {
  return entry.objection(system, formulation);
}

std::unique_ptr<Integrator> make_integrator(std::string_view id, System& system,
                                            const Options& options) {
  return find_integrator(id).make(system, options);
}

}  // namespace tress
