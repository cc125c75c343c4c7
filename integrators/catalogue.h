#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "integrators/entry.h"

namespace tress::integrators {

/// Returns the integrators of tress, then those of plug-ins.
std::span<const IntegratorEntry> integrator_catalogue();
std::span<const IntegratorEntry> added_integrators();  // those of plug-ins

/// Before the catalogue is first read. Throws InputError naming `where` if it has been,
/// on an id or an option that another method has, and on an entry that cannot be used.
void add_integrator(const IntegratorEntry& method, const std::string& where);

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
