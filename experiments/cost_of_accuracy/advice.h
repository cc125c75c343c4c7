#pragma once

#include <string>
#include <vector>

#include "experiments/cost_of_accuracy/scene_study.h"

namespace tress::experiments::cost_of_accuracy {

/// Practical advice from the rows of one scene for one target (or one budget): the
/// configuration to take, the next best, and what to avoid, one line each, and one more
/// if the search was stopped early. If nothing meets the target, or nothing did so far,
/// the first line says so and the second has the best run known. If nothing is known the
/// only line says why.
std::vector<std::string> advice(const std::vector<Row>& rows);

/// "super_helix (modes=bend), 9 elements, implicit_midpoint, dt 8.3 ms: 0.82 % of the
/// length in 3.2 ms per simulated second (0.053 ms a frame)"
std::string configuration_and_price(const Row& row);

/// The recommended row, or the best known; null if there is none.
const Row* advised(const std::vector<Row>& rows);

/// The scene file as advised, for `simulate`.
std::string advised_text(const Scene& given, const Row& row, double rate);

}  // namespace tress::experiments::cost_of_accuracy
