#pragma once

#include <string>
#include <vector>

#include "experiments/cost_of_accuracy/scene_study.h"

namespace tress {

/// What a practitioner can act on, from the rows of one scene for one target (or one
/// budget): the configuration to take, the next best, and what not to do, each in one
/// line. Where nothing meets the target the first line says so and is alone.
std::vector<std::string> advice(const std::vector<Row>& rows);

/// The row that the advice is to take; null where there is none.
const Row* advised(const std::vector<Row>& rows);

/// The scene file as advised, for `simulate`.
std::string advised_text(const SceneText& text, const Row& row, double rate);

}  // namespace tress
