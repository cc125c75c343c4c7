#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "integrators/catalogue.h"

namespace tress::testing_support {

using namespace integrators;

/// A system's own start state, driven to `t_end` by one integrator.
struct Drive {
  Drive(std::string_view id, System& system, const Options& options)
      : integrator(find_integrator(id).make(system, options)) {
    const auto n = static_cast<std::size_t>(system.layout().coordinates);
    q0.resize(n);
    v0.resize(n);
    system.initial_state(q0, v0);
    status = integrator->start(0, q0, v0);
  }

  Status to(double t_end, const Observer& observer = {}) {
    if (status == Status::ok) status = integrator->advance(t_end, observer);
    return status;
  }

  /// Largest |q - other q|.
  double distance(In q) const {
    double most = 0;
    for (std::size_t i = 0; i < q.size(); ++i) {
      most = std::max(most, std::abs(q[i] - integrator->q()[i]));
    }
    return most;
  }

  std::unique_ptr<Integrator> integrator;
  std::vector<double> q0, v0;
  Status status = Status::fatal;
};

}  // namespace tress::testing_support
