#pragma once

#include <span>
#include <string>
#include <vector>

#include "contract/system.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// End of a step of a run that is differentiated.
struct RunStop {
  double t;    // s
  bool asked;  // points are wanted there
};

/// Stops of a run with a fixed step at the times asked for.
std::vector<RunStop> stops_at(std::span<const double> times);

/// A run with a tolerance: its accepted steps, which are cut at the times asked for.
struct AcceptedSteps {
  std::vector<RunStop> stops;               // ends of the steps
  std::vector<std::vector<double>> points;  // points at the times asked for, m
  std::string unfinished;                   // why the run ended; empty: it did not
};

/// Runs one strand of the scene.
AcceptedSteps accepted_steps(const Scene& scene, std::size_t strand,
                             std::span<const double> times);

/// Divides every step into `parts`.
std::vector<RunStop> divided(const std::vector<RunStop>& stops, int parts);

/// Returns the positions of the points of a system, (3 points) m.
std::vector<double> points_at(System& system, double t, In q);

}  // namespace tress::simulation
