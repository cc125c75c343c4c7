#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "contract/constants.h"
#include "contract/system.h"
#include "experiments/problems/strand_models.h"
#include "models/effects/effect.h"
#include "models/strand/strand.h"

namespace tress::experiments::validation {

/// Strands in motion, for validation tests in time. A run that fails throws
/// std::runtime_error with the integrator's message.

Effects weight();  // along -z

/// Height (m) of the lowest of the points at which effects act on the strand, which
/// touches a plane first. Models that integrate over segments have no such point at their
/// very end.
double lowest_point(const ModelVariant& variant, const Strand& strand);

/// Why a test of twist does not apply to a model: a twisted strand has no energy. Empty:
/// it applies.
std::string no_twist(const ModelVariant& variant);

/// Observed values at the start and after every step.
struct Track {
  std::vector<double> t, value;
};

using Look = std::function<double(double t, In q, In v)>;

/// One run from the initial state to t_end by steps of at most dt, or until `enough` is
/// true of the last value. Throws InputError when the integrator cannot drive the model.
Track track(std::string_view integrator, System& system, double dt, double t_end,
            const Look& look, const std::function<bool(double value)>& enough = {});

/// Component `axis` (0, 1, 2: x, y, z) of the position of material point i (from the tip:
/// -1, -2, ...), m. The system must outlive the result.
Look place(System& system, int point, int axis);

/// Kinetic energy, J.
Look kinetic(System& system);

}  // namespace tress::experiments::validation
