#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "integrators/entry.h"

namespace tress::integrators {

std::span<const IntegratorEntry> integrator_catalogue();

/// Throws InputError naming the nearest id when there is no such integrator.
const IntegratorEntry& find_integrator(std::string_view id);

/// Why `entry` cannot drive `system` under `formulation`; empty when it can.
std::string refusal(const IntegratorEntry& entry, System& system,
                    Formulation formulation);

/// `options` as the method takes them: Options::tolerance becomes rtol, and a hundredth
/// of it atol, where those drive the method. Throws InputError if it has a fixed step.
Options with_tolerance(const IntegratorEntry& entry, Options options);

/// Makes the integrator, or throws refusal() as an InputError.
std::unique_ptr<Integrator> make_integrator(std::string_view id, System& system,
                                            const Options& options);

}  // namespace tress::integrators
