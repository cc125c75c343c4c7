#pragma once

#include <string>
#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/verdicts.h"

namespace tress::experiments::cost_of_accuracy {

/// The cheapest run of every model by every usual integrator, one row of kind `method`
/// each: complements the search for the overall best (study_scene) with the cost of each
/// model and the errors of that run in lengths, momentum and energy. Counted work
/// decides, so that the table is the same on every machine (cheapest_run).
///
/// For scenes of one strand; options of the scene's own model apply to every model that
/// has them. Models that cannot represent the scene are left out. Throws InputError where
/// the scene has another number of strands.
std::vector<Case> method_cases(const CommandLine& line, const std::string& file);

/// The midpoint rule conserves the angular momentum of a thrown body better than its tip.
void check_method_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::cost_of_accuracy
