#pragma once

#include <string>
#include <vector>

#include "experiments/cost_of_accuracy/scene_study.h"

namespace tress::experiments::cost_of_accuracy {

/// What a practitioner can act on, from the rows of one scene for one target (or one
/// budget): the configuration to take, the next best, and what not to do, each in one
/// line, and one more where the search did not come to its end. Where nothing meets the
/// target, or nothing did so far, the first line says so and the second has the best
/// there is. Where nothing is known the only line says why.
std::vector<std::string> advice(const std::vector<Row>& rows);

/// "super_helix (modes=bend), 9 elements, implicit_midpoint, dt 8.3 ms: 0.82 % of the
/// length in 3.2 ms per simulated second (0.053 ms a frame)"
std::string configuration_and_price(const Row& row);

/// The row that the advice is to take, or the best there is; null where there is none.
const Row* advised(const std::vector<Row>& rows);

/// The scene file as advised, for `simulate`.
std::string advised_text(const Scene& given, const Row& row, double rate);

}  // namespace tress::experiments::cost_of_accuracy
