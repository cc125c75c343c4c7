#pragma once

#include <string>
#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/verdicts.h"

namespace tress::experiments::cost_of_accuracy {

/// The cheapest run of every model by every usual integrator, a row of kind `method`
/// each: beside the search for the best of all (study_scene) what each model costs, and
/// what that run does to lengths, momentum and energy. Counted work decides, so that the
/// table is the same on every machine (cheapest_run).
///
/// Of scenes of one strand; options of the scene's own model hold for every model that
/// has them. Models that cannot do the scene are left out. Throws InputError where the
/// scene has another number of strands.
std::vector<Case> method_cases(const CommandLine& line, const std::string& file);

/// The midpoint rule keeps the angular momentum of what is thrown better than its tip.
void check_method_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::cost_of_accuracy
