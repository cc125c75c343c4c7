#pragma once

#include <span>

#include "experiments/cost_of_accuracy/trial_scene.h"
#include "simulation/files/row.h"

namespace tress::experiments::cost_of_accuracy {

/// The columns of the table.
std::span<const Column> study_columns();

/// Writes a method into its columns.
void set_method(const Method& method, Row& row);

/// What a row says of how the scene is simulated, `rate` frames per second.
struct Configuration {
  Method method;
  int elements = 0, substeps = 0;
};
Configuration configuration(const Row& row, double rate);

}  // namespace tress::experiments::cost_of_accuracy
