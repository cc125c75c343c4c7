#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "contract/integrator.h"

namespace tress {

/// One line of the list of integrators.
struct IntegratorEntry {
  std::string_view id;
  std::string_view summary;  // order, damping behaviour
  std::string_view source;
  int order;      // nominal; adaptive methods: the highest by default
  bool adaptive;  // driven by rtol/atol instead of step
  std::span<const Formulation> formulations;
  /// Empty when the method can drive `system` under `formulation`, otherwise the reason
  /// (beyond the general rules that `refusal` checks).
  std::string (*objection)(System& system, Formulation formulation);
  std::unique_ptr<Integrator> (*make)(System& system, const Options& options);
};

std::span<const IntegratorEntry> integrators();

/// Throws InputError naming the nearest id when there is no such integrator.
const IntegratorEntry& find_integrator(std::string_view id);

/// Why `entry` cannot drive `system` under `formulation`; empty when it can.
std::string refusal(const IntegratorEntry& entry, System& system,
                    Formulation formulation);

/// refusal() turned into an InputError, else the integrator.
std::unique_ptr<Integrator> make_integrator(std::string_view id, System& system,
                                            const Options& options);

}  // namespace tress
