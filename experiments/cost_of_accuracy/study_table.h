#pragma once

#include <span>

#include "experiments/cost_of_accuracy/trial_scene.h"
#include "simulation/files/row.h"

namespace tress::experiments::cost_of_accuracy {

std::span<const Column> study_columns();

/// Writes a method into its columns.
void set_method(const Method& method, Row& row);

/// The configuration that a row describes, at `rate` frames per second.
struct Configuration {
  Method method;
  int elements = 0, substeps = 0;
};
Configuration configuration(const Row& row, double rate);

}  // namespace tress::experiments::cost_of_accuracy
