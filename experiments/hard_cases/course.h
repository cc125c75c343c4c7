#pragma once

#include <string_view>
#include <vector>

#include "experiments/hard_cases/survival.h"
#include "simulation/run/simulation.h"

/// The run of a hard case.
namespace tress::experiments::hard_cases {

/// Steps to t_end or a little beyond, which end at the stops; with a tolerance, stops at
/// which the state is read.
struct Course {
  Options options;
  std::vector<double> stops;
  double growth;  // largest ratio of neighbouring steps
};

Course course(const Attempt& attempt);

struct Watched {
  Simulation end;
  std::vector<double> tips;
  bool cut;  // the work ran out
};

/// One run, with the tip sampled up to the horizon, if there is one.
Watched watch(std::string_view integrator, const HardCase& hard, const Subject& subject,
              Situation& s, const Course& c, const WorkLimit& limit,
              const Observer& each_step);

}  // namespace tress::experiments::hard_cases
